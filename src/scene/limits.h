// limits.h — what a scene may hold, for every place that asks
// What       readers refuse early and with their file's line what validate_scene() would refuse later
#pragma once

#include <cstdint>

#include "arris/math.h"

namespace arris {

inline constexpr std::uint32_t kMostSamples = 1U << 24U;  // per pixel; sample numbers too

// Squares and products of four coordinates must stay within float.
inline constexpr double kMaxCoordinate = 1e9;

// The diagonal of all that is drawn. The ray kernel takes a triangle whose area across the ray is below 2.5e-19
// for one without: cubes lose faces at an edge of 1e-9 and are whole at 1e-8, spheres of 320,000 triangles too.
// A tenth more leaves room for thin parts.
inline constexpr double kMinSize = 1e-7;

// False if the transform flattens what it is applied to, whatever its scale.
bool is_invertible(const Mat3d& linear);

}  // namespace arris
