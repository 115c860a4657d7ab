#include "render/point_shader.h"

#include <algorithm>

#include "base/sobol.h"

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
  Rgb sum, painted;
  FirstHit hit;
  for (std::uint32_t i = 0; i < std::uint32_t(shader.paths); ++i) {
    Sampler sampler(shader.seed, std::uint32_t(request.x), std::uint32_t(request.y), first + i);
    sampler.next_2d();
    const PathSample path = trace_path(scene, settings, ray, sampler, rays);
    sum += path.radiance;
    painted += path.painted;
    if (i == 0) hit = path.first;
  }
  ShadedPoint point;
  point.radiance = sum * (1 / float(shader.paths));
  const float whole = sum.x + sum.y + sum.z;
  if (whole > 0) point.painted = (painted.x + painted.y + painted.z) / whole;
  point.position = hit.hit ? ray.origin + ray.direction * hit.depth : ray.direction;
  point.normal = hit.geometric_normal;
  point.object = hit.hit ? hit.object - 1 : kFarObject;
  return point;
}

}  // namespace arris
