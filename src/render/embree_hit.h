// embree_hit.h — between Embree's rays and hits and ours
// What       makes queries, and fills SurfaceHits from what Embree answers
// Frames     world space; vertex normals come from object space
#pragma once

#include <embree3/rtcore.h>

#include <cmath>

#include "render/prepared_scene.h"
#include "render/scene_geometry.h"

namespace arris {

inline RTCRay make_ray(const TraceRay& ray) {
  RTCRay r;
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.t_min;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = 0;
  r.tfar = ray.t_max;
  r.mask = ~0U;
  r.id = 0;
  r.flags = 0;
  return r;
}

inline std::uint32_t geometry_of(const RTCHit& hit) {
  return hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? hit.geomID : hit.instID[0];
}

// Interpolated, in world space, on the side of the geometric normal.
inline Vec3f interpolated_normal(const GeometryRecord& record, const Triangle& triangle, float u,
                                 float v, Vec3f geometric_normal) {
  const Vec3f sum = (1 - u - v) * record.normals[triangle[0]] + u * record.normals[triangle[1]] +
                    v * record.normals[triangle[2]];
  const Vec3f normal = record.normal_from_object * sum;
  const float squared = length_squared(normal);
  if (!(squared > 0)) {
    return geometric_normal;  // opposite vertex normals cancel
  }
  const Vec3f unit = normal * (1 / std::sqrt(squared));
  return dot(unit, geometric_normal) < 0 ? -unit : unit;
}

// Normals of triangles whose area underflows in float.
inline Vec3f unit_normal(const WorldTriangle& w) {
  const Vec3f n = cross(w.p1 - w.p0, w.p2 - w.p0);
  const float squared = length_squared(n);
  if (squared > 1e-30F && squared < 1e30F) [[likely]] {
    return n * (1 / std::sqrt(squared));
  }
  const Vec3d precise = cross(Vec3d(w.p1) - Vec3d(w.p0), Vec3d(w.p2) - Vec3d(w.p0));
  const double precise_length = length(precise);
  return precise_length > 0 ? Vec3f(precise * (1 / precise_length)) : Vec3f(0, 0, 1);
}

inline Vec2f interpolated_uv(const GeometryRecord& record, const Triangle& indices, float u,
                             float v) {
  if (record.uvs == nullptr) {
    return {};
  }
  const Vec2f a = record.uvs[indices[0]], b = record.uvs[indices[1]], c = record.uvs[indices[2]];
  const float w = 1 - u - v;
  return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y};
}

// What a hit on a mesh tells besides where the surface is; returns its record.
inline const GeometryRecord& fill_owner(const SceneGeometry& geometry, const RTCRayHit& query,
                                        SurfaceHit& hit) {
  hit.geometry = geometry_of(query.hit);
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  hit.position_error = record.position_error;
  hit.triangle = query.hit.primID;
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  if (record.uvs != nullptr) {
    hit.uv = interpolated_uv(record, record.triangles[hit.triangle], hit.u, hit.v);
  }
  hit.material = material_of(record, hit.triangle);
  hit.object = record.object;
  return record;
}

// On a CSG solid: evaluated anew in double, along the same ray.
void fill_csg_hit(const SceneGeometry& geometry, const TraceRay& ray, const RTCRayHit& query,
                  SurfaceHit& hit);

// Written in place: a hit is a hundred bytes, on the hottest path.
inline void fill_hit(const SceneGeometry& geometry, const TraceRay& ray, const RTCRayHit& query,
                     SurfaceHit& hit) {
  if (geometry.embree.records()[geometry_of(query.hit)].triangles == nullptr) [[unlikely]] {
    return fill_csg_hit(geometry, ray, query, hit);
  }
  const GeometryRecord& record = fill_owner(geometry, query, hit);
  hit.t = query.ray.tfar;
  const Triangle& indices = record.triangles[hit.triangle];
  const WorldTriangle world = world_triangle(geometry.scene, record, hit.triangle);
  hit.position = (1 - hit.u - hit.v) * world.p0 + hit.u * world.p1 + hit.v * world.p2;
  hit.geometric_normal = unit_normal(world) * record.orientation;
  hit.shading_normal = record.normals == nullptr ? hit.geometric_normal
                                                 : interpolated_normal(record, indices, hit.u,
                                                                       hit.v, hit.geometric_normal);
  hit.side = dot(ray.direction, hit.geometric_normal) < 0 ? Side::outside : Side::inside;
}

inline SurfaceHit make_surface_hit(const SceneGeometry& geometry, const TraceRay& ray,
                                   const RTCRayHit& query) {
  SurfaceHit hit;
  fill_hit(geometry, ray, query, hit);
  return hit;
}

inline bool is_departure(const RTCHit& hit, const Departure& from) {
  // From a rounded edge inward, a ray may well leave through the triangle it came by.
  return geometry_of(hit) == from.geometry && hit.primID == from.triangle &&
         from.feature == Feature::face;
}

}  // namespace arris
