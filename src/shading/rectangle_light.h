// rectangle_light.h — a one-sided rectangle (or parallelogram) that emits
// What       sampled uniformly by solid angle from near, by area from further away: there the two
//            densities are nearly the same, and an area sample costs a fifth. Parallelograms whose
//            edges aren't orthogonal are sampled by area always.
// In / Out   world frame; pdfs per solid angle at the point
// Source     C. Ureña et al., "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013
#pragma once

#include <cmath>
#include <optional>

#include "arris/math.h"
#include "arris/scene.h"

namespace arris {

struct RectangleEmitter {
  Vec3f corner, edge_u, edge_v;
  Vec3f normal;          // unit, front side
  Vec3f axis_u, axis_v;  // unit edges
  Vec3f dual_u, dual_v;  // dot(p - corner, dual) is the coordinate along the edge, 0…1 inside
  Rgb radiance;
  float length_u = 1, length_v = 1;
  float area = 1;
  bool orthogonal = true;
  bool visible_to_camera = true;
};

RectangleEmitter make_rectangle_emitter(const AreaLight& light);

struct RectangleSample {
  Vec3f wi;
  float distance = 0;
  float pdf = 0;
};

// By solid angle; nothing, and 0, if that is too small for float.
std::optional<RectangleSample> sample_near_rectangle(const RectangleEmitter& light, Vec3f point,
                                                     Vec2f u);
float pdf_near_rectangle(const RectangleEmitter& light, Vec3f point);

// Squared distance of the centre over the area, beyond which area samples serve: their density varies
// by a sixth there.
inline constexpr float kFarRatio = 4.0F;

inline bool is_near(const RectangleEmitter& light, Vec3f point) {
  const Vec3f to_center = light.corner + (light.edge_u + light.edge_v) * 0.5F - point;
  return light.orthogonal && length_squared(to_center) < kFarRatio * light.area;
}

// Nothing if the point is behind the rectangle or in its plane.
inline std::optional<RectangleSample> sample_rectangle(const RectangleEmitter& light, Vec3f point,
                                                       Vec2f u) {
  const float height = -dot(light.corner - point, light.normal);
  if (!(height > 0.0F)) {
    return std::nullopt;
  }
  if (is_near(light, point)) {
    return sample_near_rectangle(light, point, u);
  }
  const Vec3f d = light.corner + light.edge_u * u.x + light.edge_v * u.y - point;
  const float squared = length_squared(d);
  const float distance = std::sqrt(squared);
  return RectangleSample{d * (1.0F / distance), distance,
                         squared * distance / (height * light.area)};
}

// wi: unit, hits the rectangle's front at `distance` from the point.
inline float pdf_rectangle(const RectangleEmitter& light, Vec3f point, Vec3f wi, float distance) {
  return is_near(light, point) ? pdf_near_rectangle(light, point)
                               : distance * distance / (-dot(wi, light.normal) * light.area);
}

// Distance along dir (in units of its length) to the front of the rectangle, if within (0, t_max).
inline std::optional<float> intersect_rectangle(const RectangleEmitter& light, Vec3f origin,
                                                Vec3f dir, float t_max) {
  const float cos_l = dot(dir, light.normal);
  if (cos_l >= 0.0F) {
    return std::nullopt;
  }
  const Vec3f to_corner = light.corner - origin;
  const float t = dot(to_corner, light.normal) / cos_l;
  if (!(t > 0.0F && t < t_max)) {
    return std::nullopt;
  }
  const Vec3f p = dir * t - to_corner;
  const float u = dot(p, light.dual_u);
  const float v = dot(p, light.dual_v);
  const bool inside = u >= 0.0F && u <= 1.0F && v >= 0.0F && v <= 1.0F;
  return inside ? std::optional<float>(t) : std::nullopt;
}

}  // namespace arris
