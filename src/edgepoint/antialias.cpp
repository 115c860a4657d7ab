#include "edgepoint/antialias.h"

#include <cstdint>

namespace arris {
namespace {

// A side: the neighbour beyond it, the corners at its two ends in this pixel and in that one.
struct Side {
  int dx, dy;
  std::size_t corner0, corner1, beyond0, beyond1;
};
constexpr Side kSides[4] = {
    {0, -1, 0, 1, 3, 2}, {1, 0, 1, 2, 0, 3}, {0, 1, 3, 2, 0, 1}, {-1, 0, 0, 3, 1, 2}};

// The secondary region touches the neighbour's primary one across the side.
bool touches(const CornerPlanes& corners, const Side& side, int x, int y) {
  const int nx = x + side.dx, ny = y + side.dy;
  return (corners.secondary[side.corner0].at(x, y) && corners.primary[side.beyond0].at(nx, ny)) ||
         (corners.secondary[side.corner1].at(x, y) && corners.primary[side.beyond1].at(nx, ny));
}

}  // namespace

std::optional<Rgb> find_secondary_color(const EdgePointImage& image, int x, int y,
                                        const PrimaryNeighborhood& rows) {
  const PixelCode code = image.codes[image.offset(x, y)];
  const EdgeTables& tables = edge_tables();
  const EdgeTables::Sides sides =
      (code.primary_is_a() ? tables.sides_b : tables.sides_a)[code.edge()];
  for (unsigned i = 0; i < sides.count; ++i) {
    const Side& side = kSides[sides.order >> (2 * i) & 3U];
    const int nx = x + side.dx, ny = y + side.dy;
    if (nx < 0 || ny < 0 || nx >= image.width_px || ny >= image.height_px) continue;
    const PrimaryRows& row = side.dy < 0 ? rows.above : side.dy > 0 ? rows.below : rows.here;
    if (!(row.weight[nx] > 0) || !touches(image.corners, side, x, y)) continue;
    return color_at(row.color, nx);
  }
  return std::nullopt;
}

Rgb antialias_simple_pixel(const EdgePointImage& image, int x, int y,
                           const PrimaryNeighborhood& rows) {
  const Rgb primary = color_at(rows.here.color, x);
  const std::optional<Rgb> secondary = find_secondary_color(image, x, y, rows);
  if (!secondary) return primary;
  if (!(rows.here.weight[x] > 0)) return *secondary;
  const PixelCode code = image.codes[image.offset(x, y)];
  const float area_a = edge_tables().area_a[code.edge()];
  const float area = code.primary_is_a() ? area_a : 1 - area_a;
  return primary * area + *secondary * (1 - area);
}

}  // namespace arris
