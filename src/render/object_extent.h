// object_extent.h — points in the world whose hull holds an object
// What       a mesh's vertices, the corners of a CSG solid's box: what framing, ground and bounds are made from
#pragma once

#include <cmath>

#include "arris/scene.h"
#include "csg/csg_bounds.h"

namespace arris {

template <class Visit>
void visit_extent(const Scene& scene, const Object& object, const Visit& visit) {
  if (!object.csg) {
    for (const Vec3f& position : scene.meshes[object.mesh.index].positions) {
      visit(transform_point(object.world_from_object, Vec3d(position)));
    }
    return;
  }
  const Box3d box = csg_bounds(scene.csg_trees[object.csg->index]);
  if (!is_finite(box.low) || !is_finite(box.high)) return;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                       (i & 4) != 0 ? box.high.z : box.low.z};
    visit(transform_point(object.world_from_object, corner));
  }
}

}  // namespace arris
