// packed_normal.h — the way a point faces, in sixteen bits
// What       The octahedron |x| + |y| + |z| = 1 unfolded onto a square, eight bits along each side: the lower half
//            folds out over its corners.
// Guarantee  the axes are exact; others are off by at most kNormalError (tests/edgepoint/points_test.cpp)
// Source     Q. Meyer et al., "On Floating-Point Normal Vectors" (2010)
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "arris/math.h"

namespace arris {

using PackedNormal = std::uint16_t;
// Of points that are seen from all sides. No normal is packed into it.
inline constexpr PackedNormal kNoNormal = 0;
// Sine of the angle.
inline constexpr float kNormalError = 0.0167F;
// Steps from the square's middle to its side.
inline constexpr float kNormalSteps = 127;

// kNoNormal for 0. Need not be unit.
inline PackedNormal pack_normal(Vec3f n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) return kNoNormal;
  const float x = n.x / sum, y = n.y / sum;
  const float fold = std::max(-n.z / sum, 0.0F);
  const auto step = [](float v) { return unsigned(std::lround(v * kNormalSteps) + 128); };
  return PackedNormal(step(x + std::copysign(fold, x)) | step(y + std::copysign(fold, y)) << 8U);
}

// Of length kNormalSteps / √3 to kNormalSteps.
inline Vec3f unpack_normal(PackedNormal packed) {
  const float x = float(packed & 255U) - 128, y = float(packed >> 8U) - 128;
  const float z = kNormalSteps - std::abs(x) - std::abs(y);
  const float fold = std::max(-z, 0.0F);
  return {x - std::copysign(fold, x), y - std::copysign(fold, y), z};
}

}  // namespace arris
