// csg_objects.h — the CSG solids of a scene among its other geometry
// What       Each tree is prepared and cut into cells once; every object that is made of it brings the cells' boxes
//            into Embree's structure. A ray that meets a box is taken into the tree's space in double and evaluates
//            the few leaves that matter there.
// Surfaces   A surface shows the material of the leaf that it belongs to, also where that leaf was subtracted: a
//            hole has the color of what drilled it, as in OpenSCAD's preview. Of coincident faces the first leaf
//            that makes the difference counts. Glass and opacity belong to the solid: inside a union there are no
//            surfaces.
// Guarantee  hits are those of the tree along the float ray, in double: no cracks between cells or at coincident
//            faces, and a ray that leaves a hit by its position_error doesn't meet it again (tests/render/csg_test.cpp)
// Limits     always sharp; emission is found by the rays that meet it, not sampled; no texture coordinates
// Cost       as Embree's for the boxes, and about two leaves for each box met
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "arris/rounding.h"
#include "geometry/embree_scene.h"

namespace arris {

class CsgCells;
class SharedCsgEdges;

struct CsgObject {
  std::shared_ptr<const CsgCells> cells;
  std::shared_ptr<SharedCsgEdges> edges;  // of the same cells
  ObjectId object;
  Affine3d object_from_world;
  Mat3d world_from_object_normal;
  std::uint32_t record = 0;  // of EmbreeScene::records()
};

struct CsgObjects {
  std::vector<std::shared_ptr<CsgObject>> objects;  // where they are Embree's callbacks know
  std::vector<const CsgObject*> by_record;          // null: a mesh; empty: no CSG at all
  std::uint64_t bytes = 0;
};

// `before`: of a scene that may have the same trees, whose cells and edges are then shared; null: of none.
// Errors: Error{input} naming the object, for endless solids; Error{failed} once `stop` is set.
struct CsgSource {
  const Scene& scene;
  const CsgObjects& objects;
};
CsgObjects make_csg_objects(const Scene& scene, int threads,
                            const std::atomic<bool>* stop = nullptr,
                            const CsgSource* before = nullptr);
// The same with objects in other places: those that have not moved are shared.
CsgObjects move_csg_objects(const CsgObjects& before, const Scene& scene_before,
                            const Scene& moved);
// Once for each object, in their order.
std::vector<BoxGeometry> make_csg_boxes(const Scene& scene, const CsgObjects& objects);
// Without value where the object is that of `before`.
std::vector<std::optional<BoxGeometry>> make_moved_csg_boxes(const Scene& scene,
                                                             const CsgObjects& objects,
                                                             const CsgObjects& before);
void set_csg_records(CsgObjects& objects, const EmbreeScene& embree);

// A point of a solid's surface; world space, double.
struct CsgPoint {
  double t = 0;
  Vec3d position, normal;  // unit, outward
  std::uint32_t leaf = 0;
  bool entering = true;
};

// The boundary in a cell that is nearest to t along a world ray, whoever owns it.
std::optional<CsgPoint> find_csg_point(const CsgObject& object, std::uint32_t cell, const Ray& ray,
                                       double t);

}  // namespace arris
