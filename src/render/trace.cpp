// trace.cpp — the ray functions: the only calls that trace rays
#include <embree3/rtcore.h>

#include <cmath>

#include "render/bevel_shader.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"

namespace arris {
namespace {

RTCRay make_ray(const TraceRay& ray) {
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

std::uint32_t geometry_of(const RTCHit& hit) {
  return hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? hit.geomID : hit.instID[0];
}

// Interpolated, in world space, on the side of the geometric normal.
Vec3f interpolated_normal(const GeometryRecord& record, const Triangle& triangle, float u, float v,
                          Vec3f geometric_normal) {
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
Vec3f unit_normal(const WorldTriangle& w) {
  const Vec3f n = cross(w.p1 - w.p0, w.p2 - w.p0);
  const float squared = length_squared(n);
  if (squared > 1e-30F && squared < 1e30F) [[likely]] {
    return n * (1 / std::sqrt(squared));
  }
  const Vec3d precise = cross(Vec3d(w.p1) - Vec3d(w.p0), Vec3d(w.p2) - Vec3d(w.p0));
  const double precise_length = length(precise);
  return precise_length > 0 ? Vec3f(precise * (1 / precise_length)) : Vec3f(0, 0, 1);
}

Vec2f interpolated_uv(const GeometryRecord& record, const Triangle& indices, float u, float v) {
  if (record.uvs == nullptr) {
    return {};
  }
  const Vec2f a = record.uvs[indices[0]], b = record.uvs[indices[1]], c = record.uvs[indices[2]];
  const float w = 1 - u - v;
  return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y};
}

// Written in place: a hit is a hundred bytes, on the hottest path.
void fill_hit(const SceneGeometry& geometry, const TraceRay& ray, const RTCRayHit& query,
              SurfaceHit& hit) {
  hit.geometry = geometry_of(query.hit);
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  hit.t = query.ray.tfar;
  hit.position_error = record.position_error;
  hit.triangle = query.hit.primID;
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  const Triangle& indices = record.triangles[hit.triangle];
  const WorldTriangle world = world_triangle(geometry.scene, record, hit.triangle);
  hit.position = (1 - hit.u - hit.v) * world.p0 + hit.u * world.p1 + hit.v * world.p2;
  hit.geometric_normal = unit_normal(world) * record.orientation;
  hit.shading_normal = record.normals == nullptr ? hit.geometric_normal
                                                 : interpolated_normal(record, indices, hit.u,
                                                                       hit.v, hit.geometric_normal);
  if (record.uvs != nullptr) {
    hit.uv = interpolated_uv(record, indices, hit.u, hit.v);
  }
  hit.material = material_of(record, hit.triangle);
  hit.object = record.object;
  hit.side = dot(ray.direction, hit.geometric_normal) < 0 ? Side::outside : Side::inside;
}

SurfaceHit make_surface_hit(const SceneGeometry& geometry, const TraceRay& ray,
                            const RTCRayHit& query) {
  SurfaceHit hit;
  fill_hit(geometry, ray, query, hit);
  return hit;
}

bool is_departure(const RTCHit& hit, const Departure& from) {
  // From a rounded edge inward, a ray may well leave through the triangle it came by.
  return geometry_of(hit) == from.geometry && hit.primID == from.triangle &&
         from.feature == Feature::face;
}

// ---------------------------------------------------------------------------------------------------------------------
// Rounding. A hit on a rounded object stands, moves onto an edge or corner, or the ray passes between the sharp and the
// rounded surface (rounding.h). Closest hits are traced without a filter, as most hits are kept; only a ray that
// passes is traced again, with a filter that drops the hits it passes. A ray then sees what touches the object from
// outside at the very distance where it leaves (the main picture of the paper, its Fig. 9).

struct Candidate {
  std::uint32_t geometry = kNoGeometry;
  std::uint32_t triangle = 0;
  float u = 0, v = 0, t = 0;
};

struct Verdict {
  Resolution::Outcome outcome = Resolution::Outcome::kept;
  RoundedHit hit;         // if moved: t of the ray, normal in world space
  bool entering = false;  // of a resolved hit
};

Ray local_ray(const RoundedGeometry& g, const TraceRay& ray) {
  const Ray world{Vec3d(ray.origin), Vec3d(ray.direction)};
  if (g.in_world_space) [[likely]] {
    return world;
  }
  return {transform_point(g.rounding_from_world, world.origin),
          transform_vector(g.rounding_from_world, world.direction)};
}

RayStart start_of(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c) {
  if (ray.from.geometry != c.geometry ||
      g.rounding->solid_of(ray.from.triangle) != g.rounding->solid_of(c.triangle)) {
    return RayStart::unknown;
  }
  return ray.from.side == Side::outside ? RayStart::outside : RayStart::inside;
}

// A ray that left this solid outward meets it from inside: it leaves the void in which it started.
bool leaves_own_void(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c) {
  const Solid& solid = g.rounding->data().solids[g.rounding->solid_of(c.triangle)];
  if (solid.closed) return true;
  return ray.from.feature != Feature::face && !g.is_kept(c.triangle, c.u, c.v);
}

Verdict judge(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c) {
  Verdict verdict;
  const std::uint32_t solid = g.rounding->solid_of(c.triangle);
  if (solid == kNone) return verdict;
  const Ray local = local_ray(g, ray);
  verdict.entering = dot(g.rounding->face_normal(c.triangle), local.direction) < 0;
  const bool kept = g.is_kept(c.triangle, c.u, c.v);
  RayStart start = RayStart::unknown;
  if (!verdict.entering) {
    start = start_of(g, ray, c);
    if (start == RayStart::outside && leaves_own_void(g, ray, c)) {
      verdict.outcome = Resolution::Outcome::passed;
      return verdict;
    }
    if (start == RayStart::outside) start = RayStart::unknown;
  }
  // From inside, a kept hit may still be that of a ray that starts in the void.
  if (kept && (verdict.entering || start == RayStart::inside || !g.rounding->is_exact(solid))) {
    return verdict;
  }
  const Resolution r = g.rounding->resolve(local, {c.triangle, c.u, c.v, c.t}, start);
  verdict.outcome = r.outcome;
  verdict.hit = r.hit;
  if (r.outcome != Resolution::Outcome::moved) return verdict;
  if (r.hit.t < ray.t_min && !verdict.entering) {
    // Behind the start: a ray from the void is outside; a ray from inside grazes its own surface.
    verdict.hit.t = ray.t_min;
    if (start != RayStart::inside) verdict.outcome = Resolution::Outcome::passed;
  }
  if (!g.in_world_space) {
    verdict.hit.normal = normalize(g.world_from_rounding_normal * r.hit.normal);
  }
  return verdict;
}

// Embree's context with what its filters need.
struct FilterContext {
  RTCIntersectContext base;  // first, so that a pointer to it is a pointer to this
  const SceneGeometry* geometry;
  const SceneRounding* rounding;
  const TraceRay* ray;
  float transmittance = 1;  // of a shadow ray so far
};

Candidate candidate_of(const RTCHit& hit, float t) {
  return {geometry_of(hit), hit.primID, hit.u, hit.v, t};
}

// The ray passes the sharp hit, or meets what it moved to only beyond its end.
bool is_rounded_away(const FilterContext& context, const RTCHit& hit, float t) {
  const RoundedGeometry& g = context.rounding->geometries[geometry_of(hit)];
  if (g.rounding == nullptr) return false;
  const Verdict verdict = judge(g, *context.ray, candidate_of(hit, t));
  if (verdict.outcome == Resolution::Outcome::kept) return false;
  return verdict.outcome == Resolution::Outcome::passed ||
         verdict.hit.t >= double(context.ray->t_max);
}

// Drops hits that the ray passes.
void filter_passed(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto* context = reinterpret_cast<FilterContext*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* query = reinterpret_cast<const RTCRay*>(args->ray);
  if (is_rounded_away(*context, *hit, query->tfar)) args->valid[0] = 0;
}

// Called for the surfaces that a shadow ray meets, in any order: it ends at the first that is there and
// opaque. Of translucent ones it remembers what they let through.
void filter_shadow(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  auto* context = reinterpret_cast<FilterContext*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* query = reinterpret_cast<const RTCRay*>(args->ray);
  if (is_departure(*hit, context->ray->from) ||
      (context->rounding->any && is_rounded_away(*context, *hit, query->tfar))) {
    args->valid[0] = 0;
    return;
  }
  const SceneGeometry& geometry = *context->geometry;
  const GeometryRecord& record = geometry.embree.records()[geometry_of(*hit)];
  const MaterialId id = material_of(record, hit->primID);
  if (!geometry.materials[id.index].translucent) return;
  const Vec2f uv = interpolated_uv(record, record.triangles[hit->primID], hit->u, hit->v);
  context->transmittance *=
      1 - eval_opacity(geometry.scene.materials[id.index], geometry.scene.textures, uv);
  if (context->transmittance > 0) args->valid[0] = 0;
}

// Vertex normals of one side of a rounded edge, at the point where its cylinder touches the face; in world space.
Vec3f side_normal(const SceneGeometry& geometry, const GeometryRecord& record,
                  const EdgeBlend::Side& side, Vec3f world_point, Vec3f world_normal) {
  const WorldTriangle w = world_triangle(geometry.scene, record, side.triangle);
  const Vec3d e1 = Vec3d(w.p1) - Vec3d(w.p0);
  const Vec3d e2 = Vec3d(w.p2) - Vec3d(w.p0);
  const Vec3d p = Vec3d(world_point) - Vec3d(w.p0);
  const Vec3d n = cross(e1, e2);
  const double doubled_area = length_squared(n);
  if (!(doubled_area > 0)) return world_normal;
  const auto u = float(dot(cross(p, e2), n) / doubled_area);
  const auto v = float(dot(cross(e1, p), n) / doubled_area);
  return interpolated_normal(record, record.triangles[side.triangle], u, v, world_normal);
}

// What smooth shading makes of the normal on a rounded edge.
Vec3f blended_normal(const SceneGeometry& geometry, const RoundedGeometry& g, const SurfaceHit& hit,
                     const RoundedHit& rounded) {
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  // World space only: instances of a mesh with vertex normals keep the cylinder's own.
  if (record.normals == nullptr || !g.in_world_space) return hit.geometric_normal;
  const std::optional<EdgeBlend> blend = g.rounding->blend_of(rounded, Vec3d(hit.position));
  if (!blend) return hit.geometric_normal;
  Vec3f sum;
  for (const EdgeBlend::Side& side : {blend->a, blend->b}) {
    sum += side_normal(geometry, record, side, Vec3f(side.point), Vec3f(side.face_normal)) *
           float(side.weight);
  }
  // Vertex normals that disagree with the faces must not turn the surface around.
  return dot(sum, hit.geometric_normal) > 0.5F * length(sum) ? normalize(sum)
                                                             : hit.geometric_normal;
}

void move_hit(SurfaceHit& hit, const TraceRay& ray, const Verdict& verdict) {
  hit.t = float(verdict.hit.t);
  hit.position = Vec3f(Vec3d(ray.origin) + Vec3d(ray.direction) * verdict.hit.t);
  hit.geometric_normal = Vec3f(verdict.hit.normal);
  hit.side = verdict.entering ? Side::outside : Side::inside;
  hit.feature = verdict.hit.feature;
  hit.rounding_seen = true;
}

class RoundedTrace {
 public:
  RoundedTrace(const SceneGeometry& geometry, const SceneRounding& rounding, const TraceRay& ray)
      : geometry_(geometry), rounding_(rounding), ray_(ray) {}

  // The first hit of the mesh is not simply kept: what does the ray meet?
  std::optional<SurfaceHit> settle(const RTCRayHit& first) {
    const RoundedGeometry& g = rounding_.geometries[geometry_of(first.hit)];
    const Candidate c = candidate_of(first.hit, first.ray.tfar);
    const Verdict verdict = judge(g, ray_, c);
    switch (verdict.outcome) {
      case Resolution::Outcome::kept:
        return make_surface_hit(geometry_, ray_, first);
      case Resolution::Outcome::moved:
        return moved(first, verdict, g.crowded);
      case Resolution::Outcome::passed:
        break;
    }
    return passed(first, verdict);
  }

 private:
  // Something else may reach into the void that the ray crosses first.
  std::optional<SurfaceHit> moved(const RTCRayHit& query, const Verdict& verdict, bool crowded) {
    if (crowded && verdict.entering && verdict.hit.t > double(query.ray.tfar)) {
      TraceRay across = ray_;
      across.t_min = query.ray.tfar;
      across.t_max = std::min(ray_.t_max, float(verdict.hit.t));
      if (const auto other = trace_filtered(across, query.hit)) return finish(*other);
    }
    if (verdict.hit.t >= double(ray_.t_max)) return std::nullopt;
    SurfaceHit hit = make_surface_hit(geometry_, ray_, query);
    shade_moved(hit, verdict);
    return hit;
  }

  std::optional<SurfaceHit> passed(const RTCRayHit& query, const Verdict& verdict) {
    TraceRay rest = ray_;
    rest.t_min = query.ray.tfar;
    const std::optional<RTCRayHit> next = trace_filtered(rest, query.hit);
    if (next && verdict.entering && leaves_kept(query, *next)) {
      // The rounding has no surface where the ray crosses the solid: its face stands instead of a hole.
      return make_surface_hit(geometry_, ray_, query);
    }
    if (!next) return std::nullopt;
    return finish(*next);
  }

  // The next hit is the way out of the same solid, through what is kept of it.
  [[nodiscard]] bool leaves_kept(const RTCRayHit& entry, const RTCRayHit& exit) const {
    if (geometry_of(entry.hit) != geometry_of(exit.hit)) return false;
    const RoundedGeometry& g = rounding_.geometries[geometry_of(entry.hit)];
    const std::uint32_t solid = g.rounding->solid_of(entry.hit.primID);
    if (solid != g.rounding->solid_of(exit.hit.primID) || g.rounding->is_exact(solid)) return false;
    const Ray local = local_ray(g, ray_);
    return dot(g.rounding->face_normal(exit.hit.primID), local.direction) > 0;
  }

  // The filter has dropped what is passed; what is left is kept or moved.
  SurfaceHit finish(const RTCRayHit& query) {
    SurfaceHit hit = make_surface_hit(geometry_, ray_, query);
    hit.rounding_seen = true;
    const RoundedGeometry& g = rounding_.geometries[hit.geometry];
    if (g.rounding == nullptr) return hit;
    const Verdict verdict = judge(g, ray_, candidate_of(query.hit, query.ray.tfar));
    if (verdict.outcome == Resolution::Outcome::moved) shade_moved(hit, verdict);
    return hit;
  }

  void shade_moved(SurfaceHit& hit, const Verdict& verdict) const {
    move_hit(hit, ray_, verdict);
    hit.shading_normal =
        blended_normal(geometry_, rounding_.geometries[hit.geometry], hit, verdict.hit);
  }

  // Next hit at or behind range.t_min that the ray does not pass, other than `without`.
  std::optional<RTCRayHit> trace_filtered(const TraceRay& range, const RTCHit& without) {
    FilterContext context{{}, &geometry_, &rounding_, &ray_};
    rtcInitIntersectContext(&context.base);
    context.base.filter = filter_passed;
    RTCRayHit query;
    query.ray = make_ray(range);
    for (;;) {
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(geometry_.embree.handle(), &context.base, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
      const bool same =
          geometry_of(query.hit) == geometry_of(without) && query.hit.primID == without.primID;
      if (!same && !is_departure(query.hit, ray_.from)) return query;
      query.ray.tnear = std::nextafter(query.ray.tfar, std::numeric_limits<float>::infinity());
      query.ray.tfar = range.t_max;
    }
  }

  const SceneGeometry& geometry_;
  const SceneRounding& rounding_;
  const TraceRay& ray_;
};

// Most hits: from outside, on what is kept. From inside, the ray may be leaving its void: judge() looks.
bool is_plainly_kept(const SceneRounding& rounding, const TraceRay& ray, const RTCRayHit& query) {
  const RoundedGeometry& g = rounding.geometries[geometry_of(query.hit)];
  if (g.rounding == nullptr) return true;
  if (!g.is_kept(query.hit.primID, query.hit.u, query.hit.v)) return false;
  if (g.winding_is_outward) [[likely]] {
    const Vec3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    return dot(normal, ray.direction) < 0;
  }
  return dot(g.rounding->face_normal(query.hit.primID), local_ray(g, ray).direction) < 0;
}

// Embree's context with the one geometry to be met.
struct ObjectContext {
  RTCIntersectContext base;  // first, so that a pointer to it is a pointer to this
  std::uint32_t geometry;
};

void filter_other_objects(const RTCFilterFunctionNArguments* args) {
  const auto* context = reinterpret_cast<const ObjectContext*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  if (geometry_of(*hit) != context->geometry) args->valid[0] = 0;
}

}  // namespace

std::optional<ObjectHit> PreparedScene::intersect_object(const TraceRay& ray,
                                                         std::uint32_t geometry) const {
  ObjectContext context{};
  rtcInitIntersectContext(&context.base);
  context.base.filter = &filter_other_objects;
  context.geometry = geometry;
  RTCRayHit query;
  query.ray = make_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(geometry_->embree.handle(), &context.base, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  SurfaceHit hit;
  fill_hit(*geometry_, ray, query, hit);
  return ObjectHit{hit.t, hit.triangle, hit.geometric_normal, hit.shading_normal};
}

std::optional<SurfaceHit> PreparedScene::intersect(const TraceRay& ray) const {
  std::optional<SurfaceHit> hit;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  query.ray = make_ray(ray);
  for (;;) {
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(geometry_->embree.handle(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      return hit;
    }
    if (!is_departure(query.hit, ray.from)) [[likely]] {
      break;
    }
    // A plane is met once: slivers can be met again by rounding.
    query.ray.tnear = std::nextafter(query.ray.tfar, std::numeric_limits<float>::infinity());
    query.ray.tfar = ray.t_max;
  }
  if (!rounding_.any || is_plainly_kept(rounding_, ray, query)) [[likely]] {
    fill_hit(*geometry_, ray, query, hit.emplace());
  } else {
    hit = RoundedTrace(*geometry_, rounding_, ray).settle(query);
  }
  if (!rounding_.shaders.empty() && hit) [[unlikely]] {
    const BevelShader& shader = rounding_.shaders[hit->geometry];
    if (shader.delta > 0) bend_normal(*this, shader, ray.direction, *hit);
  }
  return hit;
}

float PreparedScene::transmittance(const TraceRay& ray) const {
  FilterContext context{{}, geometry_.get(), &rounding_, &ray};
  rtcInitIntersectContext(&context.base);
  if (rounding_.any || geometry_->any_translucent) {
    context.base.filter = filter_shadow;
  }
  RTCRay query = make_ray(ray);
  rtcOccluded1(geometry_->embree.handle(), &context.base, &query);
  return query.tfar < 0 ? 0.0F : context.transmittance;
}

}  // namespace arris
