#include "render/beam_shading.h"

#include <cmath>
#include <limits>

#include "csg/csg_cells.h"
#include "render/surface_point.h"
#include "shading/lights.h"

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

// Along the ray in the solid's space.
double depth_of(const CsgSolid& solid, const SeenSurface& seen, const Ray& ray) {
  const PlacedLeaf& placed = solid.leaf(seen.leaf);
  const auto& leaf = std::get<ConvexLeaf>(placed.shape);
  if (seen.face < leaf.planes.size()) {
    return plane_depth(solid.surfaces().planes()[leaf.planes[seen.face].plane], ray);
  }
  thread_local LeafCrossings crossings;
  const std::vector<Crossing>& found = crossings.find(placed, solid.surfaces(), ray);
  const bool second = seen.surface.root == Root::farther || seen.surface.root == Root::leaving;
  for (const std::size_t i : {second ? 1U : 0U, second ? 0U : 1U}) {
    if (i < found.size() && found[i].face == seen.face && found[i].t > 0) return found[i].t;
  }
  return quadric_depth(solid.surfaces().quadrics()[*leaf.quadric], ray);
}

SurfaceHit make_hit(const PreparedScene& scene, const SeenSurface& seen, const Ray& world) {
  const CsgObject& object = *scene.geometry().csg.objects[seen.solid];
  const CsgSolid& solid = object.cells->solid();
  const Ray own{transform_point(object.object_from_world, world.origin),
                transform_vector(object.object_from_world, world.direction)};
  const double t = depth_of(solid, seen, own);
  const CsgBoundary boundary{t, seen.leaf, seen.face, seen.entering};
  const Vec3d normal = object.world_from_object_normal * solid.outward_normal(boundary, own);
  SurfaceHit hit;
  hit.t = float(t);
  hit.position = Vec3f(world.origin + world.direction * t);
  hit.geometric_normal = hit.shading_normal = Vec3f(normal * (1 / length(normal)));
  hit.geometry = object.record;
  hit.position_error = scene.geometry().embree.records()[object.record].position_error;
  hit.material = solid.leaf(seen.leaf).material;
  hit.object = object.object;
  hit.side = seen.entering ? Side::outside : Side::inside;
  hit.feature = Feature::csg;
  return hit;
}

bool is_point_like(EmitterKind kind) {
  return kind == EmitterKind::point || kind == EmitterKind::spot ||
         kind == EmitterKind::directional;
}

}  // namespace

std::vector<Emitter> point_like_emitters(const LightSet& lights) {
  std::vector<Emitter> emitters;
  for (const Emitter& e : lights.emitters) {
    if (is_point_like(e.kind)) emitters.push_back(e);
  }
  return emitters;
}

KnownSight make_sight(const PreparedScene& scene, const EyeRays& eye, const PixelSurface& surface,
                      Vec2d at) {
  KnownSight sight;
  const Vec3d direction = normalize(eye.corner + eye.step_x * at.x + eye.step_y * at.y);
  sight.ray.origin = Vec3f(eye.position);
  sight.ray.direction = Vec3f(direction);
  if (surface.seen) sight.hit = make_hit(scene, *surface.seen, {eye.position, direction});
  return sight;
}

Rgb direct_light(const PreparedScene& scene, const std::vector<Emitter>& emitters,
                 const KnownSight& sight, const PixelSurface& surface, PathRays& rays) {
  Rgb sum;
  if (emitters.empty() || !sight.hit) return sum;
  const SurfaceHit& hit = *sight.hit;
  std::optional<SurfaceMaterial> storage;
  const SurfaceMaterial& material = material_at(scene, hit, storage);
  const Frame frame = shading_frame(scene, hit, material);
  const Bsdf bsdf = make_bsdf(material, local_from_world(frame, -sight.ray.direction),
                              hit.side == Side::inside ? MediumSide::inside : MediumSide::outside);
  const LightSet& lights = scene.geometry().lights;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const LightSample light = sample_emitter(lights, emitters[i], hit.position, {});
    if (!(light.pdf > 0)) continue;
    const Vec3f wi = local_from_world(frame, light.wi);
    // Behind the surface as it is, though not as it is shaded, is behind it.
    const bool from_outside = dot(light.wi, hit.geometric_normal) > 0;
    if (from_outside != ((hit.side == Side::outside) == (wi.z > 0))) continue;
    const Rgb value = eval_bsdf_with_pdf(bsdf, wi).value * light.radiance * material.opacity;
    if (!(max_component(value) > 0)) continue;
    if (i < 32 && ((surface.lit_known >> i) & 1U) != 0) {
      if (((surface.lit >> i) & 1U) != 0) sum += value;
      continue;
    }
    TraceRay shadow = leave_surface(hit, light.wi);
    shadow.t_max = light.distance;
    ++rays.total;
    sum += value * scene.transmittance(shadow);
  }
  return sum;
}

}  // namespace arris
