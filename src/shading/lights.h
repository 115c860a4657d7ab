// lights.h — everything that emits, ready for next-event estimation
// What       make_light_set() flattens the scene's lights, its environment and the emissive triangles
//            into arrays and a table that selects one emitter in proportion to its power.
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

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"
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
  EnvironmentLight environment;
  float environment_probability = 0;  // of selection; 0 for constant ones
  float sun_probability = 0;
};

LightSet make_light_set(std::span<const Light> lights, const Environment& environment,
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

// Nothing if the emitter drawn sends no light to the point. u_select, u in [0, 1).
std::optional<LightSample> sample_light(const LightSet& lights, Vec3f point, float u_select,
                                        Vec2f u);

// There is something for sample_light() to draw.
inline bool has_emitters(const LightSet& lights) {
  return !lights.emitters.empty();
}

// What a ray that leaves the scene sees; sun included.
Rgb eval_environment(const LightSet& lights, Vec3f wi);
float pdf_environment(const LightSet& lights, Vec3f wi);
// Both for the price of one.
struct EnvironmentValue {
  Rgb radiance;
  float pdf = 0;
};
EnvironmentValue eval_environment_with_pdf(const LightSet& lights, Vec3f wi);
// What the camera sees behind the scene: the studio without its lamps, else the environment.
Rgb eval_backdrop(const LightSet& lights, Vec3f wi);

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

// wi: unit, hits the rectangle at `distance` from the point.
float pdf_area_light(const LightSet& lights, std::uint32_t index, Vec3f point, Vec3f wi,
                     float distance);
// index: that of the EmissiveTriangle given to make_light_set().
float pdf_emissive_triangle(const LightSet& lights, std::uint32_t index, Vec3f wi, float distance);

}  // namespace arris
