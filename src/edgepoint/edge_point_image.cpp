#include "edgepoint/edge_point_image.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace arris {

float PointKey::depth() const {
  return std::bit_cast<float>(std::uint32_t(bits_ >> 32U));
}

std::size_t EdgePointImage::bytes() const {
  std::size_t sum = crossings.upper.bytes() + crossings.left.bytes() + crossings.mid_row.bytes() +
                    crossings.mid_column.bytes() + codes.size() * sizeof(PixelCode) +
                    points.size() * sizeof(PointKey) + samples.bytes() + occupied.bytes();
  for (const BitPlane& plane : corners.primary) sum += plane.bytes();
  for (const BitPlane& plane : corners.secondary) sum += plane.bytes();
  for (const BitPlane& plane : reach.planes) sum += plane.bytes();
  return sum;
}

}  // namespace arris
