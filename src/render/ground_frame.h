// ground_frame.h — axes of the ground that a model stands on
#pragma once

#include <cmath>

#include "arris/math.h"

namespace arris {

// `up` and two more, orthonormal, right-handed.
struct GroundFrame {
  Vec3d east, north, up;
};

// scene_up need not be unit.
inline GroundFrame make_ground_frame(Vec3d scene_up) {
  const Vec3d up = normalize(scene_up);
  const Vec3d aside = std::abs(up.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d north = normalize(cross(up, aside));
  return {cross(north, up), north, up};
}

}  // namespace arris
