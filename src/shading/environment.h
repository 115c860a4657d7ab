// environment.h — light from infinitely far: constant, sky, HDR map, studio
// What       all but the constant one are brought into one form: an equirectangular map of radiance
//            with a piecewise constant density, and for the sky a sun disc as an emitter of its own
// In / Out   world directions, unit, towards the environment; pdfs per solid angle
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"
#include "base/trigonometry.h"
#include "shading/environment_map.h"

namespace arris {

struct SunDisc {
  Vec3f direction;  // towards it
  Vec3f tangent, bitangent;
  Rgb radiance;
  float cos_radius = 1;
  float solid_angle = 0;
};

enum class EnvironmentKind : std::uint8_t { constant, map };

struct EnvironmentLight {
  EnvironmentKind kind = EnvironmentKind::constant;
  Rgb constant;
  EnvironmentMap map;
  std::vector<Rgb> backdrop;  // map that the camera sees instead, same size, or empty
  std::vector<SunDisc> suns;  // none or one
};

EnvironmentLight make_environment_light(const Environment& environment);

inline Vec3f sample_sun(const SunDisc& sun, Vec2f u) {
  const float below_one = u.x * (1.0F - sun.cos_radius);
  const float cosine = 1.0F - below_one;
  const float sine = std::sqrt(below_one * (1.0F + cosine));
  const Vec2f circle = unit_circle(u.y);
  return (sun.tangent * circle.x + sun.bitangent * circle.y) * sine + sun.direction * cosine;
}

inline bool is_in_sun(const SunDisc& sun, Vec3f wi) {
  return dot(wi, sun.direction) >= sun.cos_radius;
}

}  // namespace arris
