#include "render/shoot.h"

#include <algorithm>
#include <cmath>

#include "render/scene_geometry.h"
#include "scene/scene_bounds.h"

namespace arris {
namespace {

struct HitPlane {
  Vec3d point, normal;  // unit
};

// Of the described triangle, not of its rounded copy in the acceleration structure. Nothing if it has no area.
std::optional<HitPlane> plane_of(const PreparedScene& scene, const SurfaceHit& hit) {
  const GeometryRecord& record = scene.geometry().embree.records()[hit.geometry];
  const Mesh& mesh = scene.scene().meshes[record.mesh.index];
  const Affine3d& world_from_object = scene.scene().objects[record.object.index].world_from_object;
  const Triangle& triangle = record.triangles[hit.triangle];
  const auto vertex = [&](std::size_t i) {
    return transform_point(world_from_object, Vec3d(mesh.positions[triangle[i]]));
  };
  const Vec3d a = vertex(0);
  const Vec3d normal = cross(vertex(1) - a, vertex(2) - a) * double(record.orientation);
  const double area = length(normal);
  if (!(area > 0)) return std::nullopt;
  return HitPlane{a, normal * (1 / area)};
}

}  // namespace

Shooter::Shooter(const PreparedScene& scene) : scene_(scene) {
  const Bounds bounds = world_bounds(scene.scene());
  if (bounds.is_empty()) return;
  center_ = bounds.center();
  radius_ = bounds.diagonal() / 2;
}

std::optional<Shot> Shooter::shoot(const Ray& ray) const {
  const double scale = length(ray.direction);
  const Vec3d direction = ray.direction * (1 / scale);
  // Rays from far away start near the scene, where floats are dense.
  const double to_center = dot(center_ - ray.origin, direction);
  const double skipped = std::max(0.0, to_center - 2 * radius_);
  TraceRay traced;
  traced.origin = Vec3f(ray.origin + direction * skipped);
  traced.direction = Vec3f(direction);
  const std::optional<SurfaceHit> hit = scene_.intersect(traced);
  if (!hit) return std::nullopt;

  Shot shot;
  shot.t = (skipped + double(hit->t)) / scale;
  shot.normal = normalize(Vec3d(hit->geometric_normal));
  shot.object = hit->object;
  shot.feature = hit->feature;
  shot.inside = hit->side == Side::inside;
  if (hit->feature == Feature::csg) {
    const CsgObject& object = *scene_.geometry().csg.by_record[hit->geometry];
    if (const auto point = find_csg_point(object, hit->triangle, ray, shot.t)) {
      shot.normal = point->normal;
      shot.t = std::max(0.0, point->t);
    }
  } else if (hit->feature == Feature::face) {
    if (const auto plane = plane_of(scene_, *hit)) {
      const double slope = dot(plane->normal, ray.direction);
      shot.normal = plane->normal;
      if (slope != 0) {
        shot.t = std::max(0.0, dot(plane->normal, plane->point - ray.origin) / slope);
      }
    }
  }
  shot.position = ray.origin + ray.direction * shot.t;
  return shot;
}

}  // namespace arris
