#include "render/path_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "render/surface_point.h"
#include "shading/lights.h"

namespace arris {
namespace {

// Numbers of the sampler that a vertex uses, in this order: light (2D), light selection, lobe and
// roulette (2D), direction (2D). Passing a translucent surface draws from dimensions of its own.
constexpr std::uint32_t kDimensionsPerVertex = 4;
constexpr std::uint32_t kOpacityDimensions = 1U << 16U;

// Surfaces let straight through in one go; more than that only coincident sheets can cause.
constexpr int kMaxPasses = 512;

// Roulette starts here: the first vertices carry most of the light.
constexpr int kRouletteDepth = 1;

// Shadow rays to emissive triangles end this much before them.
constexpr float kShadowEnd = 1 - 1e-4F;

// The power heuristic for one sample of the strategy with density `pdf`.
float mis_weight(float pdf, float other_pdf) {
  const float a = pdf * pdf, b = other_pdf * other_pdf;
  return a > 0 && std::isfinite(a) ? a / (a + b) : 1.0F;
}

// Light that arrives at the camera if nothing is in the ray's way.
struct Shadow {
  TraceRay ray;
  Rgb arriving;
};

struct Path {
  const PreparedScene& scene;
  const LightSet& lights;
  const PathSettings& settings;
  Sampler sampler;
  PathRays& rays;

  TraceRay ray;
  RayKind kind = RayKind::camera;
  Rgb throughput{1, 1, 1};
  Rgb radiance{};
  // Where and how the last scattering sampled `ray`; light sampling could have found the same emitter
  // unless that was a delta lobe or the camera.
  Vec3f vertex{};
  float bsdf_pdf = 0;
  bool bsdf_is_delta = false;
  bool light_sampled = false;
  std::uint32_t passes = 0;
  float passed_distance = 0;
  const KnownSight* known = nullptr;  // until the first vertex is done
  bool skips_area_lights = false;     // the scattering before knows them
  int first_depth = 0;                // scatterings before the first ray
  bool ends_here = false;             // where the ray arrives, emission counts and no more

  // Weight of an emitter that BSDF sampling found and light sampling finds with density light_pdf.
  template <class LightPdf>
  [[nodiscard]] float found_weight(const LightPdf& light_pdf) const {
    if (!light_sampled) {
      return 1;
    }
    const float pdf = light_pdf();
    switch (settings.strategies) {
      case Strategies::light_sampling:
        return pdf > 0 ? 0.0F : 1.0F;
      case Strategies::bsdf_sampling:
        return 1;
      case Strategies::both:
        break;
    }
    return mis_weight(bsdf_pdf, pdf);
  }

  // Weight of an emitter that light sampling drew.
  [[nodiscard]] float sampled_weight(float light_pdf, float other_pdf) const {
    switch (settings.strategies) {
      case Strategies::light_sampling:
        return 1;
      case Strategies::bsdf_sampling:
        return 0;
      case Strategies::both:
        break;
    }
    return mis_weight(light_pdf, other_pdf);
  }

  void add_area_lights(float t_end);
  void add_background();
  void add_emission(const SurfaceHit& hit, Rgb emission);
  [[nodiscard]] std::optional<Shadow> sample_shadow(const SurfaceHit& hit, const Frame& frame,
                                                    const Bsdf& bsdf);
  [[nodiscard]] bool scatter(const SurfaceHit& hit, const Frame& frame, const Bsdf& bsdf,
                             float u_lobe);
  [[nodiscard]] bool survives_roulette(float u);
  [[nodiscard]] bool passes_through(const SurfaceHit& hit, float opacity);
};

void Path::add_area_lights(float t_end) {
  if (skips_area_lights) return;
  for (std::uint32_t i = 0; i < lights.rectangles.size(); ++i) {
    const RectangleEmitter& light = lights.rectangles[i];
    if (kind == RayKind::camera && !light.visible_to_camera) {
      continue;
    }
    if (const std::optional<float> t =
            intersect_rectangle(light, ray.origin, ray.direction, t_end)) {
      const float weight = found_weight(
          [&] { return pdf_area_light(lights, i, vertex, ray.direction, *t + passed_distance); });
      radiance += throughput * light.radiance * weight;
    }
  }
}

void Path::add_background() {
  if (kind == RayKind::camera) {
    radiance += throughput * eval_backdrop(lights, ray.direction);
    return;
  }
  const EnvironmentValue value = eval_environment_with_pdf(lights, ray.direction);
  radiance += throughput * value.radiance * found_weight([&] { return value.pdf; });
}

void Path::add_emission(const SurfaceHit& hit, Rgb emission) {
  if (max_component(emission) <= 0) {
    return;
  }
  const EmitterIndex& index = scene.geometry().emitter_index;
  const std::uint32_t first = index.first[hit.geometry];
  const std::uint32_t emitter =
      first == kNoEmitter ? kNoEmitter : index.emitter_of_triangle[first + hit.triangle];
  // Light sampling knows the mesh's triangles: what rounding moved it never finds.
  const bool can_be_sampled = emitter != kNoEmitter && hit.feature == Feature::face;
  const float weight = can_be_sampled ? found_weight([&] {
    return pdf_emissive_triangle(lights, emitter, ray.direction, hit.t + passed_distance);
  })
                                      : 1.0F;
  radiance += throughput * emission * weight;
}

bool same_side(Vec3f direction, const SurfaceHit& hit, bool transmitted) {
  const float cos_theta = dot(direction, hit.geometric_normal);
  const bool leaves_outside = cos_theta > 0;
  return leaves_outside == ((hit.side == Side::outside) != transmitted);
}

std::optional<Shadow> Path::sample_shadow(const SurfaceHit& hit, const Frame& frame,
                                          const Bsdf& bsdf) {
  if (!has_emitters(lights) || is_delta_only(bsdf)) {
    return std::nullopt;
  }
  const Vec2f u = sampler.next_2d();
  const float u_select = lights.emitters.size() > 1 ? sampler.next_1d() : 0.0F;
  const std::optional<LightSample> light = sample_light(lights, hit.position, u_select, u);
  if (!light) return std::nullopt;
  const bool is_known = light->is_delta || (light->kind == EmitterKind::rectangle &&
                                            known != nullptr && known->knows_area_lights);
  if (known != nullptr && is_known) return std::nullopt;
  const Vec3f wi = local_from_world(frame, light->wi);
  if (!same_side(light->wi, hit, wi.z < 0)) {
    return std::nullopt;
  }
  const BsdfValue f = eval_bsdf_with_pdf(bsdf, wi);
  if (max_component(f.value) <= 0) {
    return std::nullopt;
  }
  const float weight = light->is_delta ? 1.0F : sampled_weight(light->pdf, f.pdf);
  if (weight <= 0) {
    return std::nullopt;
  }
  Rgb emitted = light->radiance;
  TraceRay shadow_ray = leave_surface(hit, light->wi);
  shadow_ray.t_max = light->distance;
  if (light->kind == EmitterKind::triangle) {
    shadow_ray.t_max *= kShadowEnd;
    emitted = sampled_emission(scene.geometry(), *light);
  }
  const Rgb arriving = throughput * f.value * emitted * (weight / light->pdf);
  if (!(max_component(arriving) > 0)) {
    return std::nullopt;
  }
  return Shadow{shadow_ray, arriving};
}

bool Path::scatter(const SurfaceHit& hit, const Frame& frame, const Bsdf& bsdf, float u_lobe) {
  const std::optional<BsdfSample> sample = sample_bsdf(bsdf, u_lobe, sampler.next_2d());
  if (!sample) {
    return false;
  }
  const Vec3f direction = normalize(world_from_local(frame, sample->wi));
  if (!same_side(direction, hit, sample->is_transmission)) {
    return false;
  }
  throughput *= sample->weight;
  bsdf_pdf = sample->pdf;
  bsdf_is_delta = sample->is_delta;
  light_sampled = !sample->is_delta && has_emitters(lights);
  vertex = hit.position;
  kind = RayKind::scattered;
  passed_distance = 0;
  ray = leave_surface(hit, direction);
  return true;
}

bool Path::survives_roulette(float u) {
  const float survival = std::sqrt(max_component(throughput));
  if (survival >= 1) {
    return true;
  }
  if (u >= survival) {
    return false;
  }
  throughput *= 1 / survival;
  return true;
}

bool Path::passes_through(const SurfaceHit& hit, float opacity) {
  if (opacity >= 1) [[likely]] {
    return false;
  }
  sampler.set_dimension(kOpacityDimensions + passes);
  if (sampler.next_1d() < opacity) {
    return false;
  }
  ++passes;
  passed_distance += hit.t;
  ray = leave_surface(hit, ray.direction);
  return true;
}

void fill_first_hit(FirstHit& first, const SurfaceHit& hit, const SurfaceMaterial& material,
                    const Frame& frame, float distance) {
  first.hit = true;
  first.rounded = hit.rounding_seen;
  first.bevel_fac = hit.bevel_fac;
  first.albedo = material.base_color;
  first.normal = frame.normal;
  first.geometric_normal = hit.side == Side::inside ? -hit.geometric_normal : hit.geometric_normal;
  first.depth = distance;
  first.object = hit.object.index + 1;
}

// Of light that a surface reflects, the part that goes with its base colour: a BSDF is a sum of what it would be with
// a black one and of a multiple of the base colour.
class PaintedShare {
 public:
  PaintedShare(SurfaceMaterial material, const Bsdf& bsdf, MediumSide side) : whole_(bsdf) {
    material.base_color = Rgb(0);
    rest_ = make_bsdf(material, bsdf.wo, side);
  }

  [[nodiscard]] Rgb towards(Vec3f wi) const {
    return share(eval_bsdf(whole_, wi), eval_bsdf(rest_, wi));
  }
  // u_lobe: with which the lobe was drawn.
  [[nodiscard]] Rgb of_delta(float u_lobe) const {
    const bool is_coat = u_lobe >= whole_.share_diffuse + whole_.share_specular;
    return is_coat ? Rgb(0) : share(whole_.specular_f0, rest_.specular_f0);
  }

 private:
  static Rgb share(Rgb whole, Rgb rest) {
    const auto of = [](float a, float b) { return a > b ? 1 - b / a : 0.0F; };
    return {of(whole.x, rest.x), of(whole.y, rest.y), of(whole.z, rest.z)};
  }

  Bsdf whole_, rest_;
};

PathSample trace(Path& path) {
  const PreparedScene& scene = path.scene;
  const PathSettings& settings = path.settings;
  PathRays& rays = path.rays;
  PathSample result;
  std::optional<PaintedShare> painted;
  Rgb painted_later, radiance_before;  // of what comes from the first scattering on
  for (int depth = path.first_depth; path.passes < kMaxPasses;) {
    const bool is_known = path.known != nullptr && path.passes == 0;
    const std::optional<SurfaceHit> hit = is_known ? path.known->hit : scene.intersect(path.ray);
    rays.total += is_known ? 0 : 1;
    path.add_area_lights(hit ? hit->t : std::numeric_limits<float>::infinity());
    if (!hit) {
      path.add_background();
      break;
    }
    rays.rounded += hit->rounding_seen ? 1 : 0;
    std::optional<SurfaceMaterial> storage;
    const SurfaceMaterial& material = material_at(scene, *hit, storage);
    const bool is_painted =
        settings.white_textures && path.kind == RayKind::camera && storage &&
        is_tinted(scene.geometry().scene.materials[hit->material.index], *storage);
    if (is_painted) {
      storage->base_color = scene.geometry().scene.materials[hit->material.index].base_color;
    }
    if (path.passes_through(*hit, material.opacity)) {
      continue;
    }
    path.add_emission(*hit, material.emission);
    const Frame frame = shading_frame(scene, *hit, material);
    if (path.kind == RayKind::camera) {
      fill_first_hit(result.first, *hit, material, frame, hit->t + path.passed_distance);
    }
    if (depth == settings.max_depth || path.ends_here) {
      break;
    }
    const Vec3f wo = local_from_world(frame, -path.ray.direction);
    const MediumSide side = hit->side == Side::inside ? MediumSide::inside : MediumSide::outside;
    const Bsdf bsdf = make_bsdf(material, wo, side);
    if (is_painted) painted.emplace(material, bsdf, side);
    path.sampler.set_dimension(kCameraDimensions + std::uint32_t(depth) * kDimensionsPerVertex);
    if (path.passes > 0) path.known = nullptr;  // what is behind it nobody else lights
    const std::optional<Shadow> shadow = path.sample_shadow(*hit, frame, bsdf);
    const bool knows_area_lights = path.known != nullptr && path.known->knows_area_lights;
    path.known = nullptr;
    path.sampler.set_dimension(kCameraDimensions + std::uint32_t(depth) * kDimensionsPerVertex + 2);
    const Vec2f u = path.sampler.next_2d();
    const bool goes_on = path.scatter(*hit, frame, bsdf, u.x) &&
                         (depth < kRouletteDepth || path.survives_roulette(u.y));
    path.skips_area_lights = knows_area_lights && path.light_sampled;
    path.ends_here = settings.only_glossy && u.x < bsdf.share_diffuse;
    // Traced last: the processor overlaps the arithmetic of both samples, and then both rays.
    if (shadow) {
      ++rays.total;
      const Rgb arrived = shadow->arriving * scene.transmittance(shadow->ray);
      path.radiance += arrived;
      if (is_painted) {
        result.painted +=
            arrived * painted->towards(local_from_world(frame, shadow->ray.direction));
      }
    }
    if (is_painted && goes_on) {
      painted_later = path.bsdf_is_delta
                          ? painted->of_delta(u.x)
                          : painted->towards(local_from_world(frame, path.ray.direction));
      radiance_before = path.radiance;
    }
    if (!goes_on) {
      break;
    }
    ++depth;
  }
  result.radiance = path.radiance;
  result.painted += (path.radiance - radiance_before) * painted_later;
  return result;
}

}  // namespace

PathSample trace_path(const PreparedScene& scene, const PathSettings& settings, TraceRay camera_ray,
                      Sampler sampler, PathRays& rays) {
  Path path{scene, scene.geometry().lights, settings, sampler, rays, camera_ray};
  return trace(path);
}

PathSample trace_known_sight(const PreparedScene& scene, const PathSettings& settings,
                             const KnownSight& sight, Sampler sampler, PathRays& rays) {
  if (sight.mirrors > settings.max_depth) return {};
  Path path{scene, scene.geometry().lights, settings, sampler, rays, sight.ray};
  path.known = &sight;
  path.first_depth = sight.mirrors;
  if (sight.mirrors > 0) path.kind = RayKind::scattered;
  return trace(path);
}

Rgb trace_side_ray(const PreparedScene& scene, const PathSettings& settings, const TraceRay& ray,
                   int depth, Sampler sampler, PathRays& rays) {
  if (depth > settings.max_depth) return {};
  Path path{scene, scene.geometry().lights, settings, sampler, rays, ray};
  path.first_depth = depth;
  path.kind = RayKind::scattered;
  return trace(path).radiance;
}

}  // namespace arris
