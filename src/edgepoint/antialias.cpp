#include "edgepoint/antialias.h"

namespace arris {

std::optional<Rgb> find_secondary_color(const EdgePointImage& image, int x, int y,
                                        const PrimaryNeighborhood& rows) {
  const auto row_of = [&](int ny) -> const PrimaryRows& {
    return ny < y ? rows.above : ny > y ? rows.below : rows.here;
  };
  const std::optional<PixelPlace> neighbor = find_secondary_neighbor(
      image, x, y, [&](int nx, int ny) { return row_of(ny).weight[nx] > 0; });
  if (!neighbor) return std::nullopt;
  return color_at(row_of(neighbor->y).color, neighbor->x);
}

Rgb antialias_simple_pixel(const EdgePointImage& image, int x, int y,
                           const PrimaryNeighborhood& rows) {
  const Rgb primary = color_at(rows.here.color, x);
  const std::optional<Rgb> secondary = find_secondary_color(image, x, y, rows);
  if (!secondary) return primary;
  if (!(rows.here.weight[x] > 0)) return *secondary;
  const float area = primary_area(image.codes[image.offset(x, y)]);
  return primary * area + *secondary * (1 - area);
}

}  // namespace arris
