#include "scene/scene_bounds.h"

#include <algorithm>

namespace arris {

Bounds world_bounds(const Scene& scene, const Object& object) {
  Bounds bounds;
  visit_positions(scene, object, [&](Vec3d p) { bounds.add(p); });
  return bounds;
}

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) bounds.add(world_bounds(scene, object));
  return bounds;
}

std::uint64_t count_drawn_triangles(const Scene& scene, const Object& object) {
  const Mesh& mesh = scene.meshes[object.mesh.index];
  const auto corner = [&](std::uint32_t vertex) {
    return Vec3d(Vec3f(transform_point(object.world_from_object, Vec3d(mesh.positions[vertex]))));
  };
  return std::uint64_t(std::ranges::count_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3d a = corner(t[0]);
    return length_squared(cross(corner(t[1]) - a, corner(t[2]) - a)) > 0;
  }));
}

}  // namespace arris
