// interpolate.h — the colours of primary regions from the samples that reach them
// What       for each pixel of a row the mean of the samples of its 5 × 5 neighbourhood that no edge parts from it,
//            weighted by kernel.h and renormalised. Complex pixels take all samples (§5.4). Stale samples are taken
//            where no fresh one is within reach (fresh_samples.h).
// In         the picture's codes and reachability, rows y − 2 to y + 2 of the samples' colours
// Out        the colours and the sum of weights; where that is 0 nothing is known
// Cost       25 steps of four multiplications for each vector of pixels
// Source     Bala, Walter, Greenberg (2003), §5.3
#pragma once

#include <cstdint>

#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"

namespace arris {

struct InterpolatedRow {
  ColorRow color;
  float* weight;
  // A bit for each pixel that no fresh sample reaches, of as many words as the planes have, and kVectorWords more;
  // written where some samples are stale.
  std::uint64_t* lacking;
};
void interpolate_row(const EdgePointImage& image, int y, ColorRows& samples,
                     const InterpolatedRow& out);

// A row of planes as one of pixels, and back.
void interleave_row(ColorRow row, int width, float* out);
void part_row(const float* pixels, int width, ColorRow row);

// Pixels without a colour, and those whose colour others may take.
struct HolePlanes {
  BitPlane holes, usable;
};

// Gives the holes of row y the means of what is usable of rows y − 2 to y + 2 within reach. filled: a bit for each hole
// that has got one, of as many words as the planes have, and kVectorWords more. Returns whether there are any.
bool fill_reached_row(const EdgePointImage& image, const HolePlanes& planes, int y,
                      ColorRows& colors, std::uint64_t* filled);

}  // namespace arris
