// csg_objects.cpp — Embree's callbacks for boxes of CSG solids, and what hits on them are
#include "render/csg_objects.h"

#include <cmath>
#include <limits>

#include "base/check.h"
#include "csg/csg_cells.h"
#include "render/csg_edges.h"
#include "render/embree_hit.h"

namespace arris {
namespace {

Ray object_ray(const CsgObject& object, const Ray& world) {
  return {transform_point(object.object_from_world, world.origin),
          transform_vector(object.object_from_world, world.direction)};
}

Ray ray_of(const RTCRay& ray) {
  return {Vec3d(double(ray.org_x), double(ray.org_y), double(ray.org_z)),
          Vec3d(double(ray.dir_x), double(ray.dir_y), double(ray.dir_z))};
}

BoundarySearch& thread_search() {
  thread_local BoundarySearch search;
  return search;
}

Vec3d world_normal(const CsgObject& object, const CsgBoundary& boundary, const Ray& ray) {
  const Vec3d n =
      object.world_from_object_normal * object.cells->solid().outward_normal(boundary, ray);
  return n * (1 / length(n));
}

// Filters see the hit as they would a triangle's; of the normal only the side counts.
RTCHit make_hit(const CsgBoundary& boundary, const Ray& world, const RTCIntersectContext& context,
                unsigned geometry, unsigned cell) {
  RTCHit hit;
  const double side = boundary.entering ? -1 : 1;
  hit.Ng_x = float(side * world.direction.x);
  hit.Ng_y = float(side * world.direction.y);
  hit.Ng_z = float(side * world.direction.z);
  hit.u = hit.v = 0;
  hit.primID = cell;
  hit.geomID = geometry;
  hit.instID[0] = context.instID[0];
  return hit;
}

// Tries the boundaries of one cell from the near end; accept(hit, t) ends it.
template <class Accept>
void visit_cell(const CsgObject& object, const RTCRay& ray, RTCIntersectContext& context,
                unsigned geometry, unsigned cell, const Accept& accept) {
  const Ray world = ray_of(ray);
  object.cells->visit_boundaries(
      cell, object_ray(object, world), double(ray.tnear), double(ray.tfar), thread_search(),
      [&](const CsgBoundary& boundary) {
        const auto t = float(boundary.t);
        if (!(t < ray.tfar)) return true;
        const RTCHit hit = make_hit(boundary, world, context, geometry, cell);
        return accept(hit, t);
      });
}

// Embree's filters read the hit's distance from the ray.
template <class Filter>
bool passes_filter(RTCRay& ray, const RTCHit& hit, float t, const Filter& filter) {
  const float tfar = ray.tfar;
  ray.tfar = t;
  RTCHit seen = hit;
  int valid = -1;
  RTCFilterFunctionNArguments args{};
  args.valid = &valid;
  args.ray = reinterpret_cast<RTCRayN*>(&ray);
  args.hit = reinterpret_cast<RTCHitN*>(&seen);
  args.N = 1;
  filter(args);
  if (valid == 0) ray.tfar = tfar;
  return valid != 0;
}

const CsgObject& object_of(const void* geometry_user) {
  return *static_cast<const CsgObject*>(static_cast<const BoxGeometry*>(geometry_user)->user);
}

void intersect_cell(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const CsgObject& object = object_of(args->geometryUserPtr);
  auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  visit_cell(object, query.ray, *args->context, args->geomID, args->primID,
             [&](const RTCHit& hit, float t) {
               if (args->context->filter == nullptr) {
                 query.ray.tfar = t;
               } else if (!passes_filter(query.ray, hit, t, [&](RTCFilterFunctionNArguments& f) {
                            f.geometryUserPtr = args->geometryUserPtr;
                            f.context = args->context;
                            args->context->filter(&f);
                          })) {
                 return false;
               }
               query.hit = hit;
               return true;
             });
}

void occluded_cell(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const CsgObject& object = object_of(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  visit_cell(object, ray, *args->context, args->geomID, args->primID,
             [&](const RTCHit& hit, float t) {
               if (args->context->filter != nullptr &&
                   !passes_filter(ray, hit, t, [&](RTCFilterFunctionNArguments& f) {
                     f.geometryUserPtr = args->geometryUserPtr;
                     f.context = args->context;
                     args->context->filter(&f);
                   })) {
                 return false;
               }
               ray.tfar = -std::numeric_limits<float>::infinity();
               return true;
             });
}

// Of a cell in the world, rounded outward.
Box3f world_box(const Affine3d& m, const Box3d& box) {
  const Vec3d c = box.low * 0.5 + box.high * 0.5, h = (box.high - box.low) * 0.5;
  const Vec3d center = transform_point(m, c);
  Box3f out;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = std::abs(m.linear.x[axis]) * h.x + std::abs(m.linear.y[axis]) * h.y +
                         std::abs(m.linear.z[axis]) * h.z;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    out.lower[axis] = std::nextafter(float(center[axis] - reach), -kInfinity);
    out.upper[axis] = std::nextafter(float(center[axis] + reach), kInfinity);
  }
  return out;
}

struct CsgParts {
  std::shared_ptr<const CsgCells> cells;
  std::shared_ptr<SharedCsgEdges> edges;
};

std::shared_ptr<CsgObject> place_csg(CsgParts parts, const Scene& scene, ObjectId id) {
  const Affine3d object_from_world = inverse(scene.objects[id.index].world_from_object);
  return std::make_shared<CsgObject>(CsgObject{std::move(parts.cells), std::move(parts.edges), id,
                                               object_from_world,
                                               transpose(object_from_world.linear), 0});
}

BoxGeometry make_boxes(const Scene& scene, const CsgObject& object) {
  BoxGeometry geometry;
  geometry.object = object.object;
  geometry.user = &object;
  geometry.intersect = intersect_cell;
  geometry.occluded = occluded_cell;
  for (const CsgCell& cell : object.cells->cells()) {
    geometry.boxes.push_back(
        world_box(scene.objects[object.object.index].world_from_object, cell.bounds));
  }
  return geometry;
}

// By trees; those that no object was made of are empty.
std::vector<CsgParts> parts_of(const Scene& scene, const CsgSource* before) {
  std::vector<CsgParts> parts(scene.csg_trees.size());
  if (before == nullptr || !before->scene.csg_trees.is_same_as(scene.csg_trees)) return parts;
  for (const std::shared_ptr<CsgObject>& object : before->objects.objects) {
    parts[before->scene.objects[object->object.index].csg->index] = {object->cells, object->edges};
  }
  return parts;
}

}  // namespace

CsgObjects make_csg_objects(const Scene& scene, int threads, const std::atomic<bool>* stop,
                            const CsgSource* before) {
  CsgObjects out;
  std::vector<CsgParts> all = parts_of(scene, before);
  std::vector<bool> is_counted(all.size());
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!object.csg) continue;
    const std::uint32_t tree = object.csg->index;
    CsgParts& parts = all[tree];
    if (!parts.cells) {
      parts.cells = std::make_shared<const CsgCells>(
          std::make_shared<const CsgSolid>(scene.csg_trees[tree]), "object \"" + object.name + "\"",
          CellOptions{.threads = threads, .stop = stop});
      parts.edges = std::make_shared<SharedCsgEdges>();
    }
    if (!is_counted[tree]) out.bytes += parts.cells->bytes();
    is_counted[tree] = true;
    out.objects.push_back(place_csg(parts, scene, ObjectId{i}));
  }
  return out;
}

CsgObjects move_csg_objects(const CsgObjects& before, const Scene& scene_before,
                            const Scene& moved) {
  CsgObjects out;
  out.bytes = before.bytes;
  for (const std::shared_ptr<CsgObject>& object : before.objects) {
    const std::uint32_t i = object->object.index;
    const bool stays =
        scene_before.objects[i].world_from_object == moved.objects[i].world_from_object;
    if (stays) {
      out.objects.push_back(object);
      continue;
    }
    out.objects.push_back(place_csg({object->cells, object->edges}, moved, object->object));
    out.objects.back()->record = object->record;
  }
  out.by_record = before.by_record;
  for (const std::shared_ptr<CsgObject>& object : out.objects) {
    out.by_record[object->record] = object.get();
  }
  return out;
}

std::vector<BoxGeometry> make_csg_boxes(const Scene& scene, const CsgObjects& objects) {
  std::vector<BoxGeometry> boxes;
  for (const auto& object : objects.objects) boxes.push_back(make_boxes(scene, *object));
  return boxes;
}

std::vector<std::optional<BoxGeometry>> make_moved_csg_boxes(const Scene& scene,
                                                             const CsgObjects& objects,
                                                             const CsgObjects& before) {
  std::vector<std::optional<BoxGeometry>> boxes(objects.objects.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (objects.objects[i] == before.objects[i]) continue;
    boxes[i] = make_boxes(scene, *objects.objects[i]);
  }
  return boxes;
}

void set_csg_records(CsgObjects& objects, const EmbreeScene& embree) {
  if (objects.objects.empty()) return;
  objects.by_record.assign(embree.records().size(), nullptr);
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    objects.objects[i]->record = embree.box_records()[i];
    objects.by_record[embree.box_records()[i]] = objects.objects[i].get();
  }
}

std::optional<CsgPoint> find_csg_point(const CsgObject& object, std::uint32_t cell, const Ray& ray,
                                       double t) {
  const CsgCells& cells = *object.cells;
  const Ray own = object_ray(object, ray);
  const CsgBoundary* best = nullptr;
  for (const CsgBoundary& boundary :
       thread_search().find(cells.solid(), cells.expression_of(cells.cells()[cell]), own)) {
    if (best == nullptr || std::abs(boundary.t - t) < std::abs(best->t - t)) best = &boundary;
  }
  if (best == nullptr) return std::nullopt;
  return CsgPoint{best->t, ray.origin + ray.direction * best->t, world_normal(object, *best, own),
                  best->leaf, best->entering};
}

void fill_csg_hit(const SceneGeometry& geometry, const TraceRay& ray, const RTCRayHit& query,
                  SurfaceHit& hit) {
  hit.geometry = geometry_of(query.hit);
  hit.t = query.ray.tfar;
  hit.position_error = geometry.embree.records()[hit.geometry].position_error;
  hit.triangle = query.hit.primID;
  const CsgObject& object = *geometry.csg.by_record[hit.geometry];
  hit.object = object.object;
  hit.feature = Feature::csg;
  const Ray world{Vec3d(ray.origin), Vec3d(ray.direction)};
  const std::optional<CsgPoint> point =
      find_csg_point(object, hit.triangle, world, double(query.ray.tfar));
  ARRIS_CHECK(point.has_value(), double(hit.triangle), double(query.ray.tfar));
  hit.position = Vec3f(point->position);
  hit.geometric_normal = Vec3f(point->normal);
  hit.shading_normal = hit.geometric_normal;
  hit.material = object.cells->solid().leaf(point->leaf).material;
  hit.side = point->entering ? Side::outside : Side::inside;
}

}  // namespace arris
