// point_shader.h — the shader behind the edge-and-point renderer: colours of points that the camera sees
// What       a ray through a place of a pixel, and the mean of some paths that go on from where it ends. The
//            edge-and-point renderer knows nothing else of shading.
// Guarantee  depends on pixel, frame and seed alone
// Source     Bala, Walter, Greenberg (2003), §3, §7: direct illumination, glossy reflections, global illumination.
//            Theirs is an irradiance cache; ours are paths, whose noise falls with their number.
#pragma once

#include <cstdint>
#include <span>

#include "arris/edge_point.h"
#include "edgepoint/point_cache.h"
#include "render/camera.h"
#include "render/path_integrator.h"
#include "render/pixel_filter.h"
#include "render/prepared_scene.h"

namespace arris {

struct PointShader {
  EdgePointShader kind = EdgePointShader::gi;
  int paths = 1;
  std::uint32_t seed = 0;
  bool white_textures = false;  // of points: their light without what they are painted with
};

// What the settings ask for.
PointShader make_point_shader(const EdgePointSettings& settings);

struct PointRequest {
  int x = 0, y = 0;         // pixel
  std::uint32_t frame = 0;  // which place of the pixel, and which paths
};

// The sum of paths of the path tracer's sample sequence through a pixel: `first` and those after it.
struct PixelRequest {
  int x = 0, y = 0;
  std::uint32_t first = 0, count = 0;
};
Rgb shade_pixel(const PreparedScene& scene, const CameraRays& camera, const PixelFilter& filter,
                const PointShader& shader, const PixelRequest& request, PathRays& rays);

// A point's colour is seen around it until it is replaced: a path that is far brighter than the others, such as one
// that a mirror has sent into a lamp, would be a blob. Of four paths or more none counts for more than eight times the
// mean of the others, or twice white. That loses light; a view that stands still gets it back by its own paths.
void limit_outliers(std::span<PathSample> paths, float white);

ShadedPoint shade_point(const PreparedScene& scene, const CameraRays& camera,
                        const PointShader& shader, const PointRequest& request, PathRays& rays);

}  // namespace arris
