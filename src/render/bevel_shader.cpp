#include "render/bevel_shader.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/frame.h"
#include "base/hash.h"
#include "base/sobol.h"
#include "render/scene_geometry.h"
#include "render/scene_rounding.h"

namespace arris {
namespace {

// Two surfaces this near to parallel, met where the shaded face's plane is expected, are one face.
constexpr float kSameFaceCosine = 1 - 1e-4F;
constexpr float kSameFaceDistance = 1e-3F;
// The least cosine between a face's normal and the mirror direction about the bent normal.
constexpr float kLeastReflection = 0.01F;
constexpr int kBendSteps = 12;
// Bends of less than this count as none (1 − cosine).
constexpr float kBent = 1e-6F;

std::uint32_t hash_point(Vec3f p) {
  return hash_combine(
      hash_combine(std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y)),
      std::bit_cast<std::uint32_t>(p.z));
}

// The outward normal where a ray from inside leaves the object, if that counts.
std::optional<Vec3f> find_normal(const PreparedScene& scene, const SurfaceHit& hit, Vec3f origin,
                                 Vec3f direction, float delta) {
  const float reach = kBevelReach * delta;
  const float approach = dot(direction, hit.geometric_normal);
  const float to_plane =
      approach > 0 ? dot(hit.position - origin, hit.geometric_normal) / approach : 0;
  TraceRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.t_max = std::max(reach, to_plane * (1 + kSameFaceDistance));
  const std::optional<ObjectHit> met = scene.intersect_object(ray, hit.geometry);
  if (!met) return std::nullopt;
  const bool on_face = dot(met->geometric_normal, hit.geometric_normal) > kSameFaceCosine &&
                       std::abs(met->t - to_plane) <= kSameFaceDistance * to_plane;
  if (met->t > reach && !on_face) return std::nullopt;
  // The original subtracts the normal that faces the ray: away from it is outward from within.
  return dot(met->geometric_normal, direction) < 0 ? -met->shading_normal : met->shading_normal;
}

// Where the mirror direction about the bent normal would go into the surface, the nearest normal towards the face's
// for which it doesn't: as Cycles treats all bent normals, so that edges against the light don't turn black.
Vec3f keep_reflection_outside(Vec3f bent, Vec3f face, Vec3f back) {
  const float least = std::min(kLeastReflection, 0.9F * dot(face, back));
  const auto is_outside = [&](Vec3f n) {
    const float facing = dot(n, back);
    return facing > 0 && 2 * facing * dot(n, face) - dot(back, face) >= least;
  };
  if (is_outside(bent)) return bent;
  float valid = 1, invalid = 0;
  for (int i = 0; i < kBendSteps; ++i) {
    const float middle = (valid + invalid) / 2;
    (is_outside(normalize(bent + (face - bent) * middle)) ? valid : invalid) = middle;
  }
  return normalize(bent + (face - bent) * valid);
}

}  // namespace

BevelShading eval_bevel_shader(const PreparedScene& scene, const BevelShader& shader,
                               const SurfaceHit& hit) {
  const Vec3f n = hit.shading_normal;
  const Frame frame = make_frame(n);
  const Vec3f origin = hit.position - shader.delta * n;
  const std::uint32_t seed = hash_point(hit.position);
  const int rays = shader.divisions * shader.divisions * shader.divisions;
  Vec3f sum = n;
  int count = 1;
  for (int i = 0; i < rays; ++i) {
    Sampler sampler(seed, 0, 0, std::uint32_t(i));
    const Vec2f xy = sampler.next_2d();
    const Vec3f d(2 * xy.x - 1, 2 * xy.y - 1, 2 * sampler.next_1d() - 1);
    const Vec3f direction = n + shader.perturb * world_from_local(frame, d);
    const float squared = length_squared(direction);
    if (!(squared > 0)) continue;
    const std::optional<Vec3f> found =
        find_normal(scene, hit, origin, direction * (1 / std::sqrt(squared)), shader.delta);
    if (!found) continue;
    sum += *found;
    ++count;
  }
  const float squared = length_squared(sum);
  return {float(count) / float(1 + rays), squared > 0 ? sum * (1 / std::sqrt(squared)) : n};
}

std::vector<BevelShader> make_bevel_shaders(const SceneGeometry& geometry,
                                            const std::optional<RoundingSettings>& scene_default,
                                            const SceneRounding* before) {
  if (before != nullptr && before->shaders.empty()) return {};
  const std::vector<GeometryRecord>& records = geometry.embree.records();
  std::vector<BevelShader> shaders(records.size());
  bool any = false;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].triangles == nullptr) continue;
    const Object& object = geometry.scene.objects[records[i].object.index];
    const std::optional<RoundingSettings>& s = object.rounding ? object.rounding : scene_default;
    if (!s || s->method != RoundMethod::shader) continue;
    const bool stays =
        before != nullptr && (std::holds_alternative<AutoRadius>(s->radius) ||
                              before->sources[i].place.linear == object.world_from_object.linear);
    if (stays && !s->shader.delta) {
      shaders[i] = before->shaders[i];
      any = any || shaders[i].delta > 0;
      continue;
    }
    const double delta =
        s->shader.delta ? *s->shader.delta : resolve_radius(geometry.scene, object, *s);
    shaders[i] = {float(delta), float(s->shader.perturb.value_or(1)), s->shader.divisions};
    any = any || delta > 0;
  }
  if (!any) shaders.clear();
  return shaders;
}

void bend_normal(const PreparedScene& scene, const BevelShader& shader, Vec3f ray_direction,
                 SurfaceHit& hit) {
  const BevelShading shading = eval_bevel_shader(scene, shader, hit);
  hit.bevel_fac = shading.fac;
  const Vec3f bent = shading.normal;
  if (dot(bent, hit.shading_normal) > 1 - kBent) return;
  const Vec3f back = -ray_direction;
  const Vec3f face = hit.geometric_normal;
  hit.shading_normal = keep_reflection_outside(hit.side == Side::outside ? bent : -bent,
                                               hit.side == Side::outside ? face : -face, back);
  if (hit.side == Side::inside) hit.shading_normal = -hit.shading_normal;
  hit.rounding_seen = true;
}

}  // namespace arris
