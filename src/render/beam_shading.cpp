#include "render/beam_shading.h"

#include <algorithm>
#include <cmath>

#include "render/surface_point.h"
#include "shading/lights.h"

namespace arris {
namespace {

bool is_point_like(EmitterKind kind) {
  return kind == EmitterKind::point || kind == EmitterKind::spot ||
         kind == EmitterKind::directional;
}

}  // namespace

std::vector<BeamLight> make_beam_lights(const LightSet& lights, int light_beams) {
  std::vector<BeamLight> all;
  for (const Emitter& e : lights.emitters) {
    if (is_point_like(e.kind)) all.push_back({e});
  }
  for (const Emitter& e : lights.emitters) {
    if (e.kind != EmitterKind::rectangle) continue;
    const RectangleEmitter& light = lights.rectangles[e.index];
    const float side = 1.0F / float(std::max(1, light_beams));
    for (int i = 0; i < light_beams * light_beams; ++i) {
      const float u = (float(i % light_beams) + 0.5F) * side;
      const float v = (float(i / light_beams) + 0.5F) * side;
      all.push_back({e, light.corner + light.edge_u * u + light.edge_v * v, side * side});
    }
  }
  return all;
}

LightPlace place_of(const LightSet& lights, const BeamLight& light) {
  LightPlace place;
  const std::uint32_t i = light.emitter.index;
  switch (light.emitter.kind) {
    case EmitterKind::directional:
      place.is_directional = true;
      place.direction = -Vec3d(lights.directionals[i].wi);
      break;
    case EmitterKind::point:
      place.position = Vec3d(lights.points[i].position);
      break;
    case EmitterKind::spot:
      place.position = Vec3d(lights.spots[i].position);
      break;
    default:
      place.position = Vec3d(light.position);
  }
  return place;
}

namespace {

// As of a light without extent: radiance is what arrives on a surface that faces it.
LightSample sample_beam_light(const LightSet& lights, const BeamLight& light, Vec3f point) {
  if (light.emitter.kind != EmitterKind::rectangle) {
    return sample_emitter(lights, light.emitter, point, {});
  }
  const RectangleEmitter& area = lights.rectangles[light.emitter.index];
  const Vec3f to = light.position - point;
  LightSample sample;
  sample.distance = length(to);
  if (!(sample.distance > 0)) return sample;
  sample.wi = to * (1 / sample.distance);
  const float cosine = -dot(sample.wi, area.normal);
  if (!(cosine > 0)) return sample;
  sample.radiance =
      area.radiance * (cosine * area.area * light.share / (sample.distance * sample.distance));
  sample.pdf = 1;
  return sample;
}

}  // namespace

Optics optics_of(const BeamScene& scene, const SeenSurface& seen) {
  const PreparedMaterial& material =
      scene.scene().geometry().materials[scene.material_of(seen).index];
  if (material.textured || material.translucent || material.emissive) return {};
  if (scene.is_smooth_mesh(seen)) return {};
  const MediumSide side = seen.entering ? MediumSide::outside : MediumSide::inside;
  const Bsdf bsdf = make_bsdf(material.factors, Vec3f(0, 0, 1), side);
  if (!is_delta_only(bsdf)) return {};
  if (material.factors.transmission == 0) return {Optics::Kind::reflects, 1};
  if (bsdf.share_specular > 0 || bsdf.share_coat > 0) return {};
  return {Optics::Kind::refracts, 1 / double(bsdf.eta)};
}

namespace {

Bsdf bsdf_at(const SurfaceHit& hit, const SurfaceMaterial& material, const Frame& frame,
             Vec3f direction) {
  return make_bsdf(material, local_from_world(frame, -direction),
                   hit.side == Side::inside ? MediumSide::inside : MediumSide::outside);
}

}  // namespace

namespace {

// Snell's law, of unit vectors; along the surface where rounding says that nothing passes.
Vec3d refracted(Vec3d d, Vec3d n, double relative_ior) {
  const double cosine = dot(n, d);
  const Vec3d against = cosine < 0 ? n : -n;
  const double across = std::abs(cosine) * relative_ior;
  const double squared = 1 - relative_ior * relative_ior * (1 - cosine * cosine);
  return normalize(d * relative_ior + against * (across - std::sqrt(std::max(0.0, squared))));
}

}  // namespace

MirroredSight make_sight(const BeamScene& scene, const PixelSurface& surface, Vec2d at) {
  const Ray through = ray_through(scene.eye(), at);
  Ray ray{through.origin, normalize(through.direction)};
  MirroredSight out;
  int depth = 0;
  for (const MirrorLink& link : surface.mirrors) {
    const SurfaceHit hit = scene.hit_at(link.seen, ray);
    std::optional<SurfaceMaterial> storage;
    const SurfaceMaterial& material = material_at(scene.scene(), hit, storage);
    const Frame frame = shading_frame(scene.scene(), hit, material);
    const Bsdf bsdf = bsdf_at(hit, material, frame, Vec3f(ray.direction));
    const Vec3d n(hit.geometric_normal);
    const Vec3d reflected = ray.direction - n * (2 * dot(n, ray.direction));
    ++depth;
    if (bsdf.share_glass > 0) {
      const Refraction passing = refract_glass(bsdf, bsdf.wo.z);
      const Rgb reflects = bsdf.glass_reflect * passing.reflectance;
      if (link.refracted) {
        out.side_rays.push_back(
            {leave_surface(hit, Vec3f(reflected)), out.throughput * reflects, depth});
        out.throughput = out.throughput * bsdf.glass_transmit * (1 - passing.reflectance);
        ray = {Vec3d(hit.position), refracted(ray.direction, n, link.relative_ior)};
        continue;
      }
      out.throughput = out.throughput * reflects;
    } else {
      const auto sample = sample_bsdf(bsdf, 0.5F, {0.5F, 0.5F});
      out.throughput = sample ? out.throughput * sample->weight : Rgb(0.0F);
    }
    ray = {Vec3d(hit.position), reflected};
  }
  KnownSight& sight = out.sight;
  sight.ray.origin = Vec3f(ray.origin);
  sight.ray.direction = Vec3f(ray.direction);
  sight.mirrors = int(surface.mirrors.size());
  if (surface.seen) sight.hit = scene.hit_at(*surface.seen, ray);
  return out;
}

namespace {

// The share of a surface that a light reaches, and that of which it is not known.
struct Shading {
  float lit = 0, open = 1;
};

Shading known_shading(const PixelSurface& surface, std::size_t light) {
  constexpr double kLeastOpen = 1.0 / 512;
  if (surface.lit_shares.empty()) {
    if (light >= 32 || ((surface.lit_known >> light) & 1U) == 0) return {};
    return {((surface.lit >> light) & 1U) != 0 ? 1.0F : 0.0F, 0};
  }
  const LitShare& share = surface.lit_shares[light];
  if (!(surface.estimate > 0)) return {};
  const double open = share.open / surface.estimate;
  return {float(std::clamp(share.estimate / surface.estimate, 0.0, 1.0)),
          open > kLeastOpen ? float(std::min(open, 1.0)) : 0.0F};
}

}  // namespace

Rgb direct_light(const PreparedScene& scene, const std::vector<BeamLight>& beam_lights,
                 const KnownSight& sight, const PixelSurface& surface, PathRays& rays) {
  Rgb sum;
  if (beam_lights.empty() || !sight.hit) return sum;
  const SurfaceHit& hit = *sight.hit;
  std::optional<SurfaceMaterial> storage;
  const SurfaceMaterial& material = material_at(scene, hit, storage);
  const Frame frame = shading_frame(scene, hit, material);
  const Bsdf bsdf = bsdf_at(hit, material, frame, sight.ray.direction);
  const LightSet& lights = scene.geometry().lights;
  for (std::size_t i = 0; i < beam_lights.size(); ++i) {
    const LightSample light = sample_beam_light(lights, beam_lights[i], hit.position);
    if (!(light.pdf > 0)) continue;
    const Vec3f wi = local_from_world(frame, light.wi);
    // Behind the surface as it is, though not as it is shaded, is behind it.
    const bool from_outside = dot(light.wi, hit.geometric_normal) > 0;
    if (from_outside != ((hit.side == Side::outside) == (wi.z > 0))) continue;
    const Rgb value = eval_bsdf_with_pdf(bsdf, wi).value * light.radiance * material.opacity;
    if (!(max_component(value) > 0)) continue;
    const Shading shading = known_shading(surface, i);
    sum += value * shading.lit;
    if (!(shading.open > 0)) continue;
    TraceRay shadow = leave_surface(hit, light.wi);
    shadow.t_max = light.distance;
    ++rays.total;
    sum += value * (shading.open * scene.transmittance(shadow));
  }
  return sum;
}

}  // namespace arris
