// lights.h — everything that emits, ready for next-event estimation
// What       make_light_set() flattens the scene's lights, its environment and the emissive triangles
//            into arrays and a table that selects one emitter in proportion to its power; where there are far
//            ones (directional, environment, sun) and near ones, either half as often.
//            sample_light() draws a direction towards an emitter; pdf_…() say with which density it
//            would have drawn a direction that the BSDF found, for multiple importance sampling.
// In / Out   world frame; wi unit, away from the point; radiance in W/(m² sr); pdfs per solid angle at
//            the point, the emitter's selection included
// Guarantee  same scene, same numbers: same sample. A constant environment is never drawn: BSDF
//            sampling alone finds it at least as well, and a vertex keeps to one shadow ray.
//            pdf_environment() is then 0, so that multiple importance sampling gives the BSDF sample
//            its whole weight.
// Limits     rectangles emit from the side of cross(edge_u, edge_v) and block nothing
// Cost       selection O(1), nothing with a single emitter; about 10 ns for a point or far rectangle,
//            40 to 60 ns for a near rectangle or a map (bench/shading)
// Errors     none: the scene is validated before
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"
#include "base/scalar.h"
#include "shading/alias_table.h"
#include "shading/environment.h"
#include "shading/rectangle_light.h"

namespace arris {

struct EmissiveTriangle {
  Vec3f a, b, c;  // world; the front is the side from which they turn counter-clockwise
  Rgb radiance;   // mean over the triangle, if a texture modulates it
  bool both_sides = false;
};

struct SceneBounds {
  Vec3f center;
  float radius = 1;
};

enum class EmitterKind : std::uint8_t {
  point,
  spot,
  directional,
  rectangle,
  triangle,
  environment,
  sun
};

struct Emitter {
  EmitterKind kind;
  std::uint32_t index;  // within its kind
};

struct PointEmitter {
  Vec3f position;
  Rgb intensity;
};
struct SpotEmitter {
  Vec3f position, axis;
  Rgb intensity;
  float cos_scale, cos_offset;  // falloff = clamp(cos·scale + offset)²: glTF's KHR_lights_punctual
};
struct DirectionalEmitter {
  Vec3f wi;
  Rgb irradiance;
};
struct TriangleEmitter {
  Vec3f a, edge_b, edge_c;  // edges from a
  Vec3f normal;             // unit
  Rgb radiance;
  float inverse_area;
  bool both_sides;
};

struct LightSet {
  std::vector<Emitter> emitters;
  AliasTable selection;  // over emitters
  std::vector<PointEmitter> points;
  std::vector<SpotEmitter> spots;
  std::vector<DirectionalEmitter> directionals;
  std::vector<RectangleEmitter> rectangles;
  std::vector<TriangleEmitter> triangles;
  std::vector<float> rectangle_probability, triangle_probability;  // of selection
  std::shared_ptr<const EnvironmentLight> environment;
  float environment_probability = 0;  // of selection; 0 for constant ones
  float sun_probability = 0;
};

LightSet make_light_set(std::span<const Light> lights, const Environment& environment,
                        std::span<const EmissiveTriangle> triangles, const SceneBounds& bounds);
// With the environment of another set.
LightSet make_light_set(std::span<const Light> lights,
                        std::shared_ptr<const EnvironmentLight> environment,
                        std::span<const EmissiveTriangle> triangles, const SceneBounds& bounds);

struct LightSample {
  Vec3f wi;
  float distance = std::numeric_limits<float>::infinity();
  // Not yet multiplied with visibility. If is_delta: irradiance on a surface that faces the light,
  // and pdf is the selection probability. Either way the estimate is f·|cos|·radiance / pdf.
  Rgb radiance;
  float pdf = 0;
  bool is_delta = false;
  EmitterKind kind = EmitterKind::point;
  std::uint32_t index = 0;  // within its kind: that of the EmissiveTriangle, or of the AreaLight
  Vec2f barycentric{};      // of b and c, if kind is triangle: where to look up an emission texture
};

struct EnvironmentValue {
  Rgb radiance;
  float pdf = 0;
};

// There is something for sample_light() to draw.
inline bool has_emitters(const LightSet& lights) {
  return !lights.emitters.empty();
}

struct AreaLightHit {
  std::uint32_t index = 0;  // among the area lights, in the scene's order
  float t = 0;              // in units of the direction's length
  Rgb radiance;
};
enum class RayKind { camera, scattered };
// The nearest rectangle before t_max that the ray sees from its front; those invisible to the
// camera are skipped for camera rays. dir need not be unit.
std::optional<AreaLightHit> find_area_light(const LightSet& lights, Vec3f origin, Vec3f dir,
                                            float t_max, RayKind kind);
inline bool has_area_lights(const LightSet& lights) {
  return !lights.rectangles.empty();
}

// Falls with the square of the distance, which never is zero.
struct Falloff {
  Vec3f wi;
  float distance;
  float inverse_square;
};
inline Falloff falloff_towards(Vec3f position, Vec3f point) {
  const Vec3f d = position - point;
  const float squared = max_of(length_squared(d), 1e-30F);
  const float distance = std::sqrt(squared);
  return {d * (1.0F / distance), distance, 1.0F / squared};
}

inline LightSample sample_point(const PointEmitter& light, Vec3f point) {
  const Falloff f = falloff_towards(light.position, point);
  return {.wi = f.wi,
          .distance = f.distance,
          .radiance = light.intensity * f.inverse_square,
          .pdf = 1.0F,
          .is_delta = true};
}

inline LightSample sample_spot(const SpotEmitter& light, Vec3f point) {
  const Falloff f = falloff_towards(light.position, point);
  const float linear = -dot(f.wi, light.axis) * light.cos_scale + light.cos_offset;
  if (linear <= 0.0F) {
    return {};
  }
  const float clamped = min_of(linear, 1.0F);
  return LightSample{.wi = f.wi,
                     .distance = f.distance,
                     .radiance = light.intensity * (f.inverse_square * clamped * clamped),
                     .pdf = 1.0F,
                     .is_delta = true};
}

inline float pdf_triangle(const TriangleEmitter& light, Vec3f wi, float distance) {
  const float cos_l = -dot(wi, light.normal);
  const float facing = light.both_sides ? std::fabs(cos_l) : cos_l;
  return facing > 0.0F ? distance * distance * light.inverse_area / facing : 0.0F;
}

inline LightSample sample_triangle(const TriangleEmitter& light, Vec3f point, Vec2f u) {
  const float r = std::sqrt(u.x);
  const Vec2f barycentric{r * (1.0F - u.y), r * u.y};
  const Vec3f p = light.a + light.edge_b * barycentric.x + light.edge_c * barycentric.y;
  const Falloff f = falloff_towards(p, point);
  const float pdf = pdf_triangle(light, f.wi, f.distance);
  return LightSample{.wi = f.wi,
                     .distance = f.distance,
                     .radiance = light.radiance,
                     .pdf = pdf,
                     .barycentric = barycentric};
}

// Map and sun are one integrand, drawn by a mixture: both count wherever they overlap.
inline EnvironmentValue eval_map_and_sun(const LightSet& lights, Vec3f wi, MapPoint at) {
  const EnvironmentMap& map = lights.environment->map;
  EnvironmentValue value{eval_environment_map(map, map.radiance, at),
                         lights.environment_probability * pdf_environment_map(map, at)};
  for (const SunDisc& sun : lights.environment->suns) {
    if (is_in_sun(sun, wi)) {
      value.radiance += sun.radiance;
      value.pdf += lights.sun_probability / sun.solid_angle;
    }
  }
  return value;
}

inline LightSample sample_far(const LightSet& lights, Vec3f wi, MapPoint at) {
  const EnvironmentValue value = eval_map_and_sun(lights, wi, at);
  return LightSample{.wi = wi, .radiance = value.radiance, .pdf = value.pdf};
}

// pdf 0: no light from there.
inline LightSample sample_emitter(const LightSet& lights, Emitter emitter, Vec3f point, Vec2f u) {
  switch (emitter.kind) {
    case EmitterKind::point:
      return sample_point(lights.points[emitter.index], point);
    case EmitterKind::spot:
      return sample_spot(lights.spots[emitter.index], point);
    case EmitterKind::directional: {
      const DirectionalEmitter& light = lights.directionals[emitter.index];
      return LightSample{
          .wi = light.wi, .radiance = light.irradiance, .pdf = 1.0F, .is_delta = true};
    }
    case EmitterKind::rectangle: {
      const RectangleEmitter& light = lights.rectangles[emitter.index];
      const auto sample = sample_rectangle(light, point, u);
      if (!sample) {
        return {};
      }
      return LightSample{.wi = sample->wi,
                         .distance = sample->distance,
                         .radiance = light.radiance,
                         .pdf = sample->pdf};
    }
    case EmitterKind::triangle:
      return sample_triangle(lights.triangles[emitter.index], point, u);
    case EmitterKind::environment: {
      const EnvironmentMapSample sample = sample_environment_map(lights.environment->map, u);
      return sample_far(lights, sample.wi, sample.at);
    }
    case EmitterKind::sun: {
      const Vec3f wi = sample_sun(lights.environment->suns.front(), u);
      return sample_far(lights, wi, map_point(lights.environment->map, wi));
    }
  }
  return {};
}

// Nothing if the emitter drawn sends no light to the point. u_select, u in [0, 1).
inline std::optional<LightSample> sample_light(const LightSet& lights, Vec3f point, float u_select,
                                               Vec2f u) {
  if (lights.emitters.empty()) {
    return std::nullopt;
  }
  const std::uint32_t drawn = sample_alias_table(lights.selection, u_select);
  const Emitter emitter = lights.emitters[drawn];
  LightSample sample = sample_emitter(lights, emitter, point, u);
  if (!(sample.pdf > 0.0F)) {
    return std::nullopt;
  }
  // Environments have their selection in the mixture's density.
  const bool is_far = emitter.kind == EmitterKind::environment || emitter.kind == EmitterKind::sun;
  sample.pdf *= is_far ? 1.0F : lights.selection.probability[drawn];
  sample.kind = emitter.kind;
  sample.index = emitter.index;
  return sample;
}

// What a ray that leaves the scene sees, sun included, and with which density it would have been drawn.
inline EnvironmentValue eval_environment_with_pdf(const LightSet& lights, Vec3f wi) {
  const EnvironmentLight& environment = *lights.environment;
  return environment.kind == EnvironmentKind::constant
             ? EnvironmentValue{environment.constant, 0}
             : eval_map_and_sun(lights, wi, map_point(environment.map, wi));
}

inline Rgb eval_environment(const LightSet& lights, Vec3f wi) {
  return eval_environment_with_pdf(lights, wi).radiance;
}

inline float pdf_environment(const LightSet& lights, Vec3f wi) {
  return eval_environment_with_pdf(lights, wi).pdf;
}

// What the camera sees behind the scene: the studio without its lamps, else the environment.
inline Rgb eval_backdrop(const LightSet& lights, Vec3f wi) {
  const EnvironmentLight& environment = *lights.environment;
  return environment.backdrop.empty() ? eval_environment(lights, wi)
                                      : eval_environment_map(environment.map, environment.backdrop,
                                                             map_point(environment.map, wi));
}

// wi: unit, hits the rectangle at `distance` from the point.
inline float pdf_area_light(const LightSet& lights, std::uint32_t index, Vec3f point, Vec3f wi,
                            float distance) {
  return lights.rectangle_probability[index] *
         pdf_rectangle(lights.rectangles[index], point, wi, distance);
}

// index: that of the EmissiveTriangle given to make_light_set().
inline float pdf_emissive_triangle(const LightSet& lights, std::uint32_t index, Vec3f wi,
                                   float distance) {
  return lights.triangle_probability[index] * pdf_triangle(lights.triangles[index], wi, distance);
}

}  // namespace arris
