// scene_bounds.h — where the points of a scene are in the world, and which triangles have an area there
// Limits     meshes, objects and indices must be as validate_scene() asks
// Cost       each function visits every vertex or triangle of the objects, and every primitive of CSG solids
#pragma once

#include <cstdint>
#include <limits>

#include "arris/scene.h"
#include "csg/csg_bounds.h"

namespace arris {

// Of nothing: lower above upper.
struct Bounds {
  Vec3d lower{std::numeric_limits<double>::infinity()};
  Vec3d upper{-std::numeric_limits<double>::infinity()};

  [[nodiscard]] bool is_empty() const { return !(lower.x <= upper.x); }
  [[nodiscard]] double diagonal() const { return is_empty() ? 0 : length(upper - lower); }
  [[nodiscard]] Vec3d center() const { return (lower + upper) * 0.5; }
  void add(Vec3d p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void add(const Bounds& other) {
    lower = min(lower, other.lower);
    upper = max(upper, other.upper);
  }
};

// Points whose hull holds the object: a mesh's vertices, the corners of a CSG solid's box. None of endless solids.
template <class Visit>
void visit_positions(const Scene& scene, const Object& object, const Visit& visit) {
  if (object.csg) {
    const Box3d box = csg_bounds(scene.csg_trees[object.csg->index]);
    if (!is_finite(box.low) || !is_finite(box.high)) return;
    for (const Vec3d& corner : corners_of(box)) {
      visit(transform_point(object.world_from_object, corner));
    }
    return;
  }
  for (const Vec3f& position : scene.meshes[object.mesh.index].positions) {
    visit(transform_point(object.world_from_object, Vec3d(position)));
  }
}

Bounds world_bounds(const Scene& scene, const Object& object);
Bounds world_bounds(const Scene& scene);

// Triangles with an area, of a mesh, when their corners are floats in the world, as the ray kernel sees them.
std::uint64_t count_drawn_triangles(const Scene& scene, const Object& object);

}  // namespace arris
