// antialias.h — the colour of a pixel that one edge crosses
// What       the mean of the colours of its two regions, weighted by their areas. The secondary region takes the
//            colour
//            of a neighbour on its side: the one with which it shares most of a side whose primary region it touches.
// Source     Bala, Walter, Greenberg (2003), §5.3 "Anti-aliasing". The paper's table knows the edge alone; here the
//            neighbour must also be reached from the secondary region without crossing an edge.
#pragma once

#include <optional>

#include "arris/math.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"

namespace arris {

// Rows y − 1 to y + 1 of the colours of primary regions, and of their weights (0: unknown).
struct PrimaryRows {
  ColorRow color;
  const float* weight;
};
struct PrimaryNeighborhood {
  PrimaryRows above, here, below;
};

// Precondition: the pixel is simple. Of the neighbour; nothing if none on its side is known.
std::optional<Rgb> find_secondary_color(const EdgePointImage& image, int x, int y,
                                        const PrimaryNeighborhood& rows);
Rgb antialias_simple_pixel(const EdgePointImage& image, int x, int y,
                           const PrimaryNeighborhood& rows);

}  // namespace arris
