#include "beam/light_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "csg/leaf_crossings.h"

namespace arris {
namespace {

// Of a facet, or outward from a leaf; in the solid's space.
Vec3d own_normal(const BeamShape& shape, const SeenSurface& seen, Vec3d p) {
  if (const Facet* facet = shape.facet(seen.leaf)) return shape.planes()[facet->plane.plane].normal;
  const CsgSolid& csg = shape.csg();
  return normal_at(csg.leaf(seen.leaf), csg.surfaces(), seen.face, p);
}

Vec3d world_normal(const BeamSolid& solid, const SeenSurface& seen, Vec3d world) {
  const Affine3d& m = solid.object_from_world;
  return transpose(m.linear) * own_normal(*solid.shape, seen, transform_point(m, world));
}

PyramidBase base_at(Vec3d p, Vec3d normal, Vec3d toward) {
  const Vec3d a{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const Vec3d axis = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0}
                     : a.y <= a.z             ? Vec3d{0, 1, 0}
                                              : Vec3d{0, 0, 1};
  const Vec3d u = cross(normal, axis);
  return {p, {u, cross(normal, u)}, toward};
}

std::optional<PyramidBase> convex_base(const HitPatch& patch, const LightPlace& light) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = patch.corners[(i + 1) % 4], b = patch.corners[(i + 2) % 4];
    const Vec3d c = patch.corners[(i + 3) % 4], fourth = patch.corners[i];
    const Vec3d n = cross(b - a, c - a), toward = to_light(light, a);
    if (dot(n, fourth - a) * dot(n, toward) >= 0) return PyramidBase{a, {b - a, c - a}, toward};
  }
  return std::nullopt;
}

// Where the light's ray through the points' middle meets the face, nearest to that middle.
std::optional<Vec3d> find_middle(const BeamSolid& solid, const HitPatch& patch,
                                 const LightPlace& light) {
  const Vec3d middle =
      (patch.corners[0] + patch.corners[1] + patch.corners[2] + patch.corners[3]) * 0.25;
  const Ray world{middle, to_light(light, middle)};
  const Ray ray{transform_point(solid.object_from_world, world.origin),
                transform_vector(solid.object_from_world, world.direction)};
  const CsgSolid& csg = solid.shape->csg();
  thread_local LeafCrossings crossings;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Crossing& c : crossings.find(csg.leaf(patch.seen.leaf), csg.surfaces(), ray)) {
    if (c.face == patch.seen.face && std::abs(c.t) < std::abs(nearest)) nearest = c.t;
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return world.origin + world.direction * nearest;
}

std::optional<PyramidBase> find_base(const BeamSolid& solid, const HitPatch& patch,
                                     const LightPlace& light) {
  if (patch.form == PatchForm::convex) return convex_base(patch, light);
  if (patch.form == PatchForm::flat) {
    return base_at(patch.corners[0], patch.normals[0], to_light(light, patch.corners[0]));
  }
  const std::optional<Vec3d> e = find_middle(solid, patch, light);
  if (!e) return std::nullopt;
  return base_at(*e, world_normal(solid, patch.seen, *e), to_light(light, *e));
}

}  // namespace

HitPatch make_patch(const BeamSolid& solid, const SeenSurface& seen,
                    const std::array<Vec3d, 4>& corners, Vec3d eye) {
  HitPatch patch{seen, PatchForm::flat, corners, {}};
  const bool is_flat = solid.shape->is_flat(seen.leaf, seen.face);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d n = world_normal(solid, seen, corners[i]);
    const bool from_outside = dot(n, eye - corners[i]) > 0;
    patch.normals[i] = from_outside ? n : -n;
    if (!is_flat) patch.form = from_outside ? PatchForm::convex : PatchForm::concave;
  }
  return patch;
}

Vec3d to_light(const LightPlace& light, Vec3d from) {
  return light.is_directional ? -light.direction : light.position - from;
}

std::optional<Pyramid> make_light_pyramid(const BeamSolid& solid, const HitPatch& patch,
                                          const LightPlace& light) {
  Pyramid beam;
  beam.base = find_base(solid, patch, light);
  if (!beam.base) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d corner = patch.corners[i];
    beam.edges[i] = light.is_directional ? Ray{corner, -light.direction}
                                         : Ray{light.position, corner - light.position};
  }
  return beam;
}

bool is_behind(const BeamSolid& solid, std::uint32_t leaf, const HitPatch& patch) {
  const BeamShape& shape = *solid.shape;
  const SeenSurface& seen = patch.seen;
  if (patch.form != PatchForm::flat) {
    return patch.form == PatchForm::convex && leaf == seen.leaf;
  }
  const Facet* seen_facet = shape.facet(seen.leaf);
  const std::uint32_t plane = seen_facet != nullptr
                                  ? seen_facet->plane.plane
                                  : shape.convex(seen.leaf)->planes[seen.face].plane;
  if (const Facet* facet = shape.facet(leaf)) return facet->plane.plane == plane;
  const ConvexLeaf* convex = shape.convex(leaf);
  if (convex == nullptr) return false;
  const Mat3d world_from_normal = transpose(solid.object_from_world.linear);
  return std::ranges::any_of(convex->planes, [&](PlaneRef ref) {
    const Vec3d outward = world_from_normal * shape.csg().surfaces().normal_of(ref);
    return ref.plane == plane && dot(outward, patch.normals[0]) > 0;
  });
}

}  // namespace arris
