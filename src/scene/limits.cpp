#include "scene/limits.h"

#include <algorithm>
#include <cmath>

namespace arris {

bool is_invertible(const Mat3d& linear) {
  constexpr double kFlat =
      1e-15;  // a few roundings of the determinant, relative to the scale cubed
  const double scale = std::max({length(linear.x), length(linear.y), length(linear.z)});
  return std::abs(determinant(linear)) > kFlat * scale * scale * scale;
}

}  // namespace arris
