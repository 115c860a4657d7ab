// antialias.h — the colour of a pixel that one edge crosses
// What       the mean of the colours of its two regions, weighted by their areas. The secondary region takes the
//            colour of a neighbour on its side: the one with which it shares most of a side whose primary region it
//            touches.
// Source     Bala, Walter, Greenberg (2003), §5.3 "Anti-aliasing". The paper's table knows the edge alone; here the
//            neighbour must also be reached from the secondary region without crossing an edge.
#pragma once

#include <cstddef>
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

// Where a pixel is.
struct PixelPlace {
  int x, y;
};

// Across a side, and the corners at its two ends in this pixel and in the neighbour.
struct PixelSide {
  int dx, dy;
  std::size_t corner0, corner1, beyond0, beyond1;
};
inline constexpr PixelSide kPixelSides[4] = {
    {0, -1, 0, 1, 3, 2}, {1, 0, 1, 2, 0, 3}, {0, 1, 3, 2, 0, 1}, {-1, 0, 0, 3, 1, 2}};

// Precondition: the pixel is simple. The neighbour whose colour its secondary region takes, of those whose colour
// is_known(x, y).
template <class IsKnown>
std::optional<PixelPlace> find_secondary_neighbor(const EdgePointImage& image, int x, int y,
                                                  const IsKnown& is_known) {
  const PixelCode code = image.codes[image.offset(x, y)];
  const EdgeTables& tables = edge_tables();
  const EdgeTables::Sides sides =
      (code.primary_is_a() ? tables.sides_b : tables.sides_a)[code.edge()];
  const CornerPlanes& corners = image.corners;
  for (unsigned i = 0; i < sides.count; ++i) {
    const PixelSide& side = kPixelSides[sides.order >> (2 * i) & 3U];
    const int nx = x + side.dx, ny = y + side.dy;
    if (nx < 0 || ny < 0 || nx >= image.width_px || ny >= image.height_px) continue;
    if (!is_known(nx, ny)) continue;
    // The secondary region touches the neighbour's primary one across the side.
    const auto touches = [&](std::size_t corner, std::size_t beyond) {
      return corners.secondary[corner].at(x, y) && corners.primary[beyond].at(nx, ny);
    };
    if (touches(side.corner0, side.beyond0) || touches(side.corner1, side.beyond1)) {
      return PixelPlace{nx, ny};
    }
  }
  return std::nullopt;
}

// The part of a simple pixel that is its primary region.
inline float primary_area(PixelCode code) {
  const float area_a = edge_tables().area_a[code.edge()];
  return code.primary_is_a() ? area_a : 1 - area_a;
}

// Precondition: the pixel is simple. Of the neighbour; nothing if none on its side is known.
std::optional<Rgb> find_secondary_color(const EdgePointImage& image, int x, int y,
                                        const PrimaryNeighborhood& rows);
Rgb antialias_simple_pixel(const EdgePointImage& image, int x, int y,
                           const PrimaryNeighborhood& rows);

}  // namespace arris
