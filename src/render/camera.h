// camera.h — rays through the picture, and framing
// Legend     x, y: picture coordinates in pixels, (0, 0) the upper left corner of the upper left pixel
#pragma once

#include "arris/scene.h"
#include "render/prepared_scene.h"

namespace arris {

// A pinhole camera for one picture size.
struct CameraRays {
  Vec3f position;
  Vec3d corner, step_x, step_y;  // direction = corner + x step_x + y step_y
};

CameraRays make_camera_rays(const Camera& camera, const ImageSettings& image);

inline TraceRay camera_ray(const CameraRays& camera, double x, double y) {
  TraceRay ray;
  ray.origin = camera.position;
  ray.direction = normalize(Vec3f(camera.corner + camera.step_x * x + camera.step_y * y));
  return ray;
}

// A three-quarter view from the front, the right and above, as near as the whole model allows with a
// margin. Precondition: a valid scene.
Camera frame_scene(const Scene& scene, double fov_deg = Camera{}.fov_deg);
// The same seen from elsewhere. to_camera: not along `up`, neither need be unit.
Camera frame_scene_from(const Scene& scene, Vec3d to_camera, Vec3d up, double fov_deg);

}  // namespace arris
