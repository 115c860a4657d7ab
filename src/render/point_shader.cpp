#include "render/point_shader.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/sobol.h"
#include "render/film.h"
#include "shading/lights.h"

namespace arris {
namespace {

constexpr int kDirectPaths = 4, kGlossyPaths = 8, kGiPaths = 16;

PathSettings path_settings(const PreparedScene& scene, EdgePointShader kind) {
  PathSettings settings;
  settings.max_depth = scene.scene().image.max_depth;
  if (kind == EdgePointShader::direct) settings.max_depth = std::min(settings.max_depth, 1);
  settings.only_glossy = kind == EdgePointShader::glossy;
  return settings;
}

float sum_of(Rgb c) {
  return c.x + c.y + c.z;
}

}  // namespace

PointShader make_point_shader(const EdgePointSettings& settings) {
  PointShader shader{settings.shader, settings.paths_per_point, settings.seed};
  shader.white_textures = settings.sharp_textures;
  if (shader.paths == 0) {
    shader.paths = settings.shader == EdgePointShader::direct   ? kDirectPaths
                   : settings.shader == EdgePointShader::glossy ? kGlossyPaths
                                                                : kGiPaths;
  }
  return shader;
}

void limit_outliers(std::span<PathSample> paths, float white) {
  constexpr float kTimesOthers = 8, kTimesWhite = 2;
  constexpr std::size_t kFewest = 4;
  if (paths.size() < kFewest) return;
  float all = 0;
  for (const PathSample& path : paths) all += sum_of(path.radiance);
  for (PathSample& path : paths) {
    const float own = sum_of(path.radiance);
    const float others = (all - own) / float(paths.size() - 1);
    const float most = std::max(kTimesOthers * others, 3 * kTimesWhite * white);
    if (!(own > most)) continue;
    path.radiance *= most / own;
    path.painted *= most / own;
  }
}

Rgb shade_pixel(const PreparedScene& scene, const CameraRays& camera, const PixelFilter& filter,
                const PointShader& shader, const PixelRequest& request, PathRays& rays) {
  const PathSettings settings = path_settings(scene, shader.kind);
  Rgb sum;
  for (std::uint32_t i = request.first; i < request.first + request.count; ++i) {
    Sampler sampler(shader.seed, std::uint32_t(request.x), std::uint32_t(request.y), i);
    const Vec2f u = sampler.next_2d();
    const double x = request.x + 0.5 + double(filter.sample_offset(u.x));
    const double y = request.y + 0.5 + double(filter.sample_offset(u.y));
    sum += trace_path(scene, settings, camera_ray(camera, x, y), sampler, rays).radiance;
  }
  return sum;
}

ShadedPoint shade_point(const PreparedScene& scene, const CameraRays& camera,
                        const PointShader& shader, const PointRequest& request, PathRays& rays) {
  PathSettings settings = path_settings(scene, shader.kind);
  settings.white_textures = shader.white_textures;
  const auto first = request.frame * std::uint32_t(shader.paths);
  Sampler place(shader.seed, std::uint32_t(request.x), std::uint32_t(request.y), first);
  const Vec2f u = place.next_2d();
  const TraceRay ray = camera_ray(camera, request.x + double(u.x), request.y + double(u.y));
  std::vector<PathSample> samples;
  samples.reserve(std::size_t(shader.paths));
  for (std::uint32_t i = 0; i < std::uint32_t(shader.paths); ++i) {
    Sampler sampler(shader.seed, std::uint32_t(request.x), std::uint32_t(request.y), first + i);
    sampler.next_2d();
    samples.push_back(trace_path(scene, settings, ray, sampler, rays));
  }
  limit_outliers(samples, 1 / exposure_scale(scene.scene().image));
  Rgb sum, painted;
  for (const PathSample& path : samples) {
    sum += path.radiance;
    painted += path.painted;
  }
  const FirstHit& hit = samples.front().first;
  ShadedPoint point;
  point.radiance = sum * (1 / float(shader.paths));
  const float whole = sum.x + sum.y + sum.z;
  if (whole > 0) point.painted = (painted.x + painted.y + painted.z) / whole;
  point.position = hit.hit ? ray.origin + ray.direction * hit.depth : ray.direction;
  point.normal = hit.geometric_normal;
  point.object = hit.hit ? hit.object - 1 : kFarObject;
  // A lamp that the camera sees has no surface, but its light is seen where it is.
  const LightSet& lights = scene.geometry().lights;
  const float end = hit.hit ? hit.depth : std::numeric_limits<float>::infinity();
  if (const auto lamp = find_area_light(lights, ray.origin, ray.direction, end, RayKind::camera)) {
    point.position = ray.origin + ray.direction * lamp->t;
    point.normal = lights.rectangles[lamp->index].normal;
    point.object = std::uint32_t(scene.scene().objects.size()) + lamp->index;
  }
  return point;
}

}  // namespace arris
