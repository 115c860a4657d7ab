// frame.h — right-handed orthonormal frames
// Source     T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3
#pragma once

#include <cmath>

#include "arris/math.h"

namespace arris {

// Local coordinates: x along tangent, y along bitangent, z along normal. All unit, orthogonal.
struct Frame {
  Vec3f tangent{1, 0, 0};
  Vec3f bitangent{0, 1, 0};
  Vec3f normal{0, 0, 1};
};

// normal: unit. The tangent is arbitrary, and jumps where the normal's z changes sign only.
inline Frame make_frame(Vec3f normal) {
  const float sign = std::copysign(1.0F, normal.z);
  const float a = -1.0F / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  return {{1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y},
          normal};
}

// The frame about `normal` whose tangent is nearest to `tangent`. Precondition: not parallel.
inline Frame make_frame(Vec3f normal, Vec3f tangent) {
  const Vec3f t = normalize(tangent - normal * dot(normal, tangent));
  return {t, cross(normal, t), normal};
}

constexpr Vec3f local_from_world(const Frame& frame, Vec3f v) {
  return {dot(frame.tangent, v), dot(frame.bitangent, v), dot(frame.normal, v)};
}

constexpr Vec3f world_from_local(const Frame& frame, Vec3f v) {
  return frame.tangent * v.x + frame.bitangent * v.y + frame.normal * v.z;
}

}  // namespace arris
