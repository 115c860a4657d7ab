#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/ground_frame.h"
#include "scene/scene_bounds.h"

namespace arris {
namespace {

constexpr double kAzimuth = radians(35);    // from the front to the right
constexpr double kElevation = radians(25);  // above the horizon
constexpr double kMargin = 0.08;  // of the picture's width and height, left free on each side

struct Axes {
  Vec3d right, up, forward;  // orthonormal
};

Axes camera_axes(Vec3d forward, Vec3d up) {
  const Vec3d f = normalize(forward);
  const Vec3d right = normalize(cross(f, up));
  return {right, cross(right, f), f};
}

// Largest of the values that the four sides of the view pyramid and the depth bound.
struct Extent {
  double right, left, top, bottom, near, far;
};

Extent extent_of(const Scene& scene, const Axes& axes, double tan_x, double tan_y) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  Extent extent{kNone, kNone, kNone, kNone, kNone, kNone};
  for (const Object& object : scene.objects) {
    visit_positions(scene, object, [&](Vec3d p) {
      const double x = dot(p, axes.right), y = dot(p, axes.up), z = dot(p, axes.forward);
      extent.right = std::max(extent.right, x - tan_x * z);
      extent.left = std::max(extent.left, -x - tan_x * z);
      extent.top = std::max(extent.top, y - tan_y * z);
      extent.bottom = std::max(extent.bottom, -y - tan_y * z);
      extent.near = std::max(extent.near, -z);
      extent.far = std::max(extent.far, z);
    });
  }
  return extent;
}

}  // namespace

CameraRays make_camera_rays(const Camera& camera, const ImageSettings& image) {
  const Axes axes = camera_axes(camera.target - camera.position, camera.up);
  const double half_height = std::tan(radians(camera.fov_deg) / 2);
  const double pixel = 2 * half_height / image.height_px;
  CameraRays rays;
  rays.position = Vec3f(camera.position);
  rays.step_x = axes.right * pixel;
  rays.step_y = axes.up * -pixel;
  rays.corner =
      axes.forward - rays.step_x * (image.width_px / 2.0) - rays.step_y * (image.height_px / 2.0);
  return rays;
}

// With the view direction fixed, each side of the view pyramid bounds the camera's place by the point that
// is farthest out on that side: x - z tan_x <= camera_x - camera_z tan_x for all points, and so on.
Camera frame_scene_from(const Scene& scene, Vec3d to_camera, Vec3d up, double fov_deg) {
  Camera camera;
  camera.fov_deg = fov_deg;
  const Axes axes = camera_axes(-to_camera, up);
  const double tan_y = std::tan(radians(camera.fov_deg) / 2) * (1 - 2 * kMargin);
  const double tan_x = tan_y * scene.image.width_px / scene.image.height_px;
  const Extent e = extent_of(scene, axes, tan_x, tan_y);
  camera.up = up;
  const Bounds bounds = world_bounds(scene);
  if (bounds.is_empty()) {  // nothing to see
    camera.position = normalize(to_camera) * 5.0;
    camera.target = {};
    return camera;
  }
  const double size = bounds.diagonal();
  const double nearest =
      -e.near - (size > 0 ? 1e-3 * size : 1.0);  // a flat or single point still is in front
  const double z =
      std::min({-(e.right + e.left) / (2 * tan_x), -(e.top + e.bottom) / (2 * tan_y), nearest});
  const double x = (e.right - e.left) / 2;
  const double y = (e.top - e.bottom) / 2;
  const double target_z = (e.far - e.near) / 2;
  camera.position = axes.right * x + axes.up * y + axes.forward * z;
  camera.target = axes.right * x + axes.up * y + axes.forward * target_z;
  return camera;
}

Camera frame_scene(const Scene& scene, double fov_deg) {
  const GroundFrame ground = make_ground_frame(scene.up);
  const Vec3d to_camera = std::cos(kElevation) * (std::sin(kAzimuth) * ground.east -
                                                  std::cos(kAzimuth) * ground.north) +
                          std::sin(kElevation) * ground.up;
  return frame_scene_from(scene, to_camera, ground.up, fov_deg);
}

}  // namespace arris
