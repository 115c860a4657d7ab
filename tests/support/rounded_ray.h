// rounded_ray.h — the smallest host of the rounding kernel
// What       meets a ray with every triangle in double precision, then asks the kernel hit by hit, as a
//            renderer does, until a hit stands or the mesh has no more; fillets that come before it are asked for, too
// Guarantee  a ray through a shared edge or vertex never slips between the triangles: the side of an edge
//            is computed from its end points in one fixed order
// Cost       linear in the triangles
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"

namespace arris::oracle {

// On which side of the line a→b the ray passes: the sign of the volume they span, the exact negative for b→a.
inline double side_of(const Ray& ray, Vec3d a, Vec3d b) {
  if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) return -side_of(ray, b, a);
  return dot(ray.direction, cross(a - ray.origin, b - ray.origin));
}

// The front or back hit at t > 0, if any.
inline std::optional<MeshHit> intersect_triangle(const Ray& ray, const MeshView& mesh,
                                                 std::uint32_t index) {
  const Triangle& t = mesh.triangles[index];
  const Vec3d p0(mesh.positions[t[0]]), p1(mesh.positions[t[1]]), p2(mesh.positions[t[2]]);
  const double w0 = side_of(ray, p1, p2), w1 = side_of(ray, p2, p0), w2 = side_of(ray, p0, p1);
  if ((w0 < 0 || w1 < 0 || w2 < 0) && (w0 > 0 || w1 > 0 || w2 > 0)) return std::nullopt;
  const double sum = w0 + w1 + w2;
  if (sum == 0) return std::nullopt;  // in the triangle's plane
  const Vec3d n = cross(p1 - p0, p2 - p0);
  const double across = dot(n, ray.direction);
  if (across == 0) return std::nullopt;
  const double at = dot(n, p0 - ray.origin) / across;
  if (!(at > 0)) return std::nullopt;
  return MeshHit{index, w1 / sum, w2 / sum, at};
}

// All hits of the mesh, nearest first.
inline std::vector<MeshHit> intersect_mesh(const Ray& ray, const MeshView& mesh) {
  std::vector<MeshHit> hits;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (const auto hit = intersect_triangle(ray, mesh, i)) hits.push_back(*hit);
  std::sort(hits.begin(), hits.end(), [](const MeshHit& a, const MeshHit& b) {
    return std::tie(a.t, a.triangle) < std::tie(b.t, b.triangle);
  });
  return hits;
}

struct RoundedMesh {
  MeshView mesh;
  const Rounding* rounding = nullptr;
};

// The first point of one rounded mesh on the ray, but for ends of fillets. A ray whose first hit is from inside may
// have started in the void between the sharp and the rounded surface, and enter the rounded solid before it leaves:
// that hit is resolved even where the surface is kept. A ray that passes a solid that isn't exact, and next leaves it
// by what is kept, went through material: there the first hit stands.
inline std::optional<RoundedHit> trace_hits(const Ray& ray, const RoundedMesh& object,
                                            RayStart start) {
  std::set<std::uint32_t> passed;  // exact solids that the ray has missed for good
  std::optional<MeshHit> entry;    // the last that was passed, into a solid that isn't exact
  const auto stands = [&](const MeshHit& hit) {
    return RoundedHit{hit.t, object.rounding->face_normal(hit.triangle), Feature::face};
  };
  for (const MeshHit& hit : intersect_mesh(ray, object.mesh)) {
    const std::uint32_t solid = object.rounding->solid_of(hit.triangle);
    if (passed.contains(solid)) continue;
    const bool from_inside = dot(object.rounding->face_normal(hit.triangle), ray.direction) > 0;
    if (!from_inside && object.rounding->is_kept(hit.triangle, hit.u, hit.v)) return stands(hit);
    const Resolution resolution = object.rounding->resolve(ray, hit, start);
    const bool leaves = from_inside && entry && object.rounding->solid_of(entry->triangle) == solid;
    if (leaves && resolution.outcome != Resolution::Outcome::passed) return stands(*entry);
    switch (resolution.outcome) {
      case Resolution::Outcome::kept:
        return stands(hit);
      case Resolution::Outcome::moved:
        return resolution.hit;
      case Resolution::Outcome::passed:
        if (object.rounding->is_exact(solid))
          passed.insert(solid);
        else if (!from_inside && resolution.hit.feature != Feature::fillet)
          entry = hit;
        break;
    }
  }
  return std::nullopt;
}

// The first point of one rounded mesh on the ray.
inline std::optional<RoundedHit> trace(const Ray& ray, const RoundedMesh& object,
                                       RayStart start = RayStart::unknown) {
  std::optional<RoundedHit> first = trace_hits(ray, object, start);
  const auto boxes = object.rounding->fillet_boxes();
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const double end = first ? first->t : std::numeric_limits<double>::infinity();
    if (const auto met = object.rounding->meet_fillet(i, ray, 0, end, start)) first = met;
  }
  return first;
}

// The first point of several rounded meshes on the ray.
inline std::optional<RoundedHit> trace(const Ray& ray, std::span<const RoundedMesh> objects) {
  std::optional<RoundedHit> nearest;
  for (const RoundedMesh& object : objects) {
    const auto hit = trace(ray, object);
    if (hit && (!nearest || hit->t < nearest->t)) nearest = hit;
  }
  return nearest;
}

}  // namespace arris::oracle
