// tree_area.h — how much of a rectangle shows each end of a tree of signs
// What       The rectangle is cut until the tree's polynomials are linear in each piece to within the tolerance; there
//            both linear bounds of each are clipped against the piece, so that outlines close with the square of its
//            side. Sharp corners, thin lines and specks need no smaller pieces than smooth outlines do.
// Guarantee  areas lie within [lo, hi] but for the rounding of their sums (tests/beam/tree_area_test.cpp)
// Limits     pieces end at `least_side`: outlines that touch there stay as open as they are
#pragma once

#include <cstdint>
#include <vector>

#include "beam/region_look.h"

namespace arris {

// A point of the picture, and how much it stands for.
struct AreaSample {
  Vec2d at;
  double weight = 0;
};

struct EndArea {
  std::uint32_t node = 0;  // of the tree: a surface, nothing or unknown
  double lo = 0, hi = 0;
  double estimate = 0;  // estimates of all ends add up to the rectangle
  Vec2d sample;  // in the rectangle, on this end's side of all signs where there is such a piece
  // Those of a regular grid that are on this end's side, of one weight; of a coarser one if all is.
  std::vector<AreaSample> samples;
};

inline constexpr int kSampleGrid = 8;  // points a pixel and side

struct AreaOptions {
  double tolerance = 1.0 / 4096;  // of hi - lo, per unit of a piece's side
  double least_side = 1.0 / 256;
  bool with_samples = true;  // as dear as the areas; curved surfaces need them
};

std::vector<EndArea> areas_of(const LookTree& tree, const Rect& rect,
                              const AreaOptions& options = {});

}  // namespace arris
