#include "render/beam_scene.h"

#include <algorithm>
#include <cmath>

#include "csg/csg_cells.h"
#include "csg/leaf_crossings.h"
#include "render/embree_hit.h"

namespace arris {
namespace {

using Root = BeamSurface::Root;

double plane_depth(const CsgPlane& plane, const Ray& ray) {
  return (plane.d - dot(plane.normal, ray.origin)) / dot(plane.normal, ray.direction);
}

// Where the ray is nearest to the quadric's middle: at its outline, where rounding may leave no crossing.
double quadric_depth(const CsgQuadric& quadric, const Ray& ray) {
  const Vec3d o = transform_point(quadric.unit_from_object, ray.origin);
  const Vec3d d = transform_vector(quadric.unit_from_object, ray.direction);
  const Vec3d w = weights_of(quadric.form);
  return -dot(o * w, d) / dot(d * w, d);
}

struct Meeting {
  double depth = 0;
  std::uint32_t face = 0;
};

// Where the ray meets the leaf's surface first in that sense; if rounding leaves none, its box's middle stands for it.
Meeting whole_depth(const CsgSolid& solid, const SeenSurface& seen, const Ray& ray) {
  thread_local BoundarySearch search;
  const PlacedLeaf& leaf = solid.leaf(seen.leaf);
  for (const CsgBoundary& b : search.find(solid, view_of(solid.root()), ray)) {
    if (b.t > 0 && b.leaf == seen.leaf && b.entering == seen.entering) return {b.t, b.face};
  }
  const Vec3d middle = (leaf.bounds.low + leaf.bounds.high) * 0.5;
  return {dot(middle - ray.origin, ray.direction) / dot(ray.direction, ray.direction), 0};
}

// Along the ray in the solid's space.
Meeting depth_of(const CsgSolid& solid, const SeenSurface& seen, const Ray& ray) {
  if (seen.face == kAnyFace) return whole_depth(solid, seen, ray);
  const PlacedLeaf& placed = solid.leaf(seen.leaf);
  const auto& leaf = std::get<ConvexLeaf>(placed.shape);
  if (seen.face < leaf.planes.size()) {
    return {plane_depth(solid.surfaces().planes()[leaf.planes[seen.face].plane], ray), seen.face};
  }
  thread_local LeafCrossings crossings;
  const std::vector<Crossing>& found = crossings.find(placed, solid.surfaces(), ray);
  const bool second = seen.surface.root == Root::farther || seen.surface.root == Root::leaving;
  for (const std::size_t i : {second ? 1U : 0U, second ? 0U : 1U}) {
    if (i < found.size() && found[i].face == seen.face && found[i].t > 0) {
      return {found[i].t, seen.face};
    }
  }
  return {quadric_depth(solid.surfaces().quadrics()[*leaf.quadric], ray), seen.face};
}

}  // namespace

BeamScene::BeamScene(const PreparedScene& scene, const EyeRays& eye) : scene_(scene), eye_(eye) {
  add_csg();
  add_meshes();
}

void BeamScene::add_csg() {
  const Scene& described = scene_.scene();
  trees_.resize(described.csg_trees.size());
  for (const auto& object : scene_.geometry().csg.objects) {
    const std::uint32_t tree = described.objects[object->object.index].csg->index;
    if (!trees_[tree]) trees_[tree] = std::make_unique<BeamShape>(described.csg_trees[tree]);
    solids_.push_back({trees_[tree].get(), object->object_from_world});
    objects_.push_back(object.get());
    records_.push_back(object->record);
  }
}

void BeamScene::add_meshes() {
  const std::vector<GeometryRecord>& records = scene_.geometry().embree.records();
  for (std::uint32_t r = 0; r < records.size(); ++r) {
    const GeometryRecord& record = records[r];
    if (record.triangles == nullptr) continue;
    std::vector<MeshTriangle> triangles;
    triangles.reserve(record.triangle_count);
    for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
      const WorldTriangle w = world_triangle(scene_.scene(), record, t);
      triangles.push_back({{Vec3d(w.p0), Vec3d(w.p1), Vec3d(w.p2)}, t});
    }
    meshes_.push_back(std::make_unique<BeamShape>(triangles));
    if (meshes_.back()->facet_count() == 0) continue;
    solids_.push_back({meshes_.back().get(), {}});
    objects_.push_back(nullptr);
    records_.push_back(r);
  }
}

SurfaceHit BeamScene::hit_at(const SeenSurface& seen, const Ray& world) const {
  return objects_[seen.solid] == nullptr ? mesh_hit(seen, world) : csg_hit(seen, world);
}

MaterialId BeamScene::material_of(const SeenSurface& seen) const {
  const BeamShape& shape = *solids_[seen.solid].shape;
  const Facet* facet = shape.facet(seen.leaf);
  if (objects_[seen.solid] != nullptr) {
    return shape.csg().leaf(facet != nullptr ? facet->source : seen.leaf).material;
  }
  const GeometryRecord& record = scene_.geometry().embree.records()[records_[seen.solid]];
  return arris::material_of(record, facet->triangle);
}

bool BeamScene::is_smooth_mesh(const SeenSurface& seen) const {
  return objects_[seen.solid] == nullptr &&
         scene_.geometry().embree.records()[records_[seen.solid]].normals != nullptr;
}

bool BeamScene::is_curved(const SeenSurface& seen) const {
  return is_smooth_mesh(seen) ||
         (objects_[seen.solid] != nullptr &&
          (seen.face == kAnyFace || !solids_[seen.solid].shape->is_flat(seen.leaf, seen.face)));
}

SurfaceHit BeamScene::csg_hit(const SeenSurface& seen, const Ray& world) const {
  const CsgObject& object = *objects_[seen.solid];
  const BeamShape& shape = *solids_[seen.solid].shape;
  const CsgSolid& solid = shape.csg();
  const Ray own{transform_point(object.object_from_world, world.origin),
                transform_vector(object.object_from_world, world.direction)};
  const Facet* facet = shape.facet(seen.leaf);
  const std::uint32_t leaf = facet != nullptr ? facet->source : seen.leaf;
  const Meeting met =
      facet != nullptr
          ? Meeting{plane_depth(shape.planes()[facet->plane.plane], own), facet->triangle}
          : depth_of(solid, seen, own);
  const CsgBoundary boundary{met.depth, leaf, met.face, seen.entering};
  const Vec3d normal = object.world_from_object_normal * solid.outward_normal(boundary, own);
  SurfaceHit hit;
  hit.t = float(met.depth);
  hit.position = Vec3f(world.origin + world.direction * met.depth);
  hit.geometric_normal = hit.shading_normal = Vec3f(normal * (1 / length(normal)));
  hit.geometry = object.record;
  hit.position_error = scene_.geometry().embree.records()[object.record].position_error;
  hit.material = solid.leaf(leaf).material;
  hit.object = object.object;
  hit.side = seen.entering ? Side::outside : Side::inside;
  hit.feature = Feature::csg;
  return hit;
}

SurfaceHit BeamScene::mesh_hit(const SeenSurface& seen, const Ray& world) const {
  const BeamShape& shape = *solids_[seen.solid].shape;
  const Facet& facet = *shape.facet(seen.leaf);
  const std::uint32_t triangle = facet.triangle;
  const std::uint32_t record = records_[seen.solid];
  const WorldTriangle w =
      world_triangle(scene_.scene(), scene_.geometry().embree.records()[record], triangle);
  const double t = plane_depth(shape.planes()[facet.plane.plane], world);
  const Vec3d p = world.origin + world.direction * t;
  const Vec3d a = Vec3d(w.p1) - Vec3d(w.p0), b = Vec3d(w.p2) - Vec3d(w.p0), q = p - Vec3d(w.p0);
  const Vec3d n = cross(a, b);
  const double area = dot(n, n);
  RTCRayHit query{};
  query.ray.tfar = float(t);
  query.hit.geomID = record;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  query.hit.primID = triangle;
  query.hit.u = float(std::clamp(dot(cross(q, b), n) / area, 0.0, 1.0));
  query.hit.v = float(std::clamp(dot(cross(a, q), n) / area, 0.0, 1.0));
  TraceRay ray;
  ray.origin = Vec3f(world.origin);
  ray.direction = Vec3f(world.direction);
  return make_surface_hit(scene_.geometry(), ray, query);
}

}  // namespace arris
