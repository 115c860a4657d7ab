#include "render/rounded_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

RayStart start_of(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c,
                  std::uint32_t solid) {
  if (ray.from.geometry != c.geometry || g.rounding->solid_of(ray.from.triangle) != solid) {
    return RayStart::unknown;
  }
  return ray.from.side == Side::outside ? RayStart::outside : RayStart::inside;
}

// A ray that left this solid outward meets it from inside: it leaves the void in which it started.
bool leaves_own_void(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c,
                     const Solid& solid) {
  if (solid.filled != kNone) return false;  // a fillet may lie where it leaves
  if (solid.closed) return true;
  return ray.from.feature != Feature::face && !g.is_kept(c.triangle, c.u, c.v);
}

// A place in the void of an exact solid.
struct VoidPlace {
  std::uint32_t geometry, solid;
  std::uint32_t crossed;  // RoundedHit's
  double t;               // of the ray
};

// Where a ray may begin again beyond the mesh that it leaves: past the rounding errors of that mesh, and before
// anything that is kVoidMargin away. Nothing if another solid could be met on the way there, or if the ray leaves at so
// small an angle that there is no such place.
std::optional<float> find_way_out(const SceneGeometry& geometry, const RoundedGeometry& g,
                                  const VoidPlace& place, const Ray& local) {
  std::optional<Rounding::Exit> exit;
  if (place.crossed != kNone && g.neighbors_of(place.solid, place.crossed) == VoidNeighbors::none) {
    exit = g.rounding->find_exit_beside(place.crossed, local, place.t);
  }
  if (!exit && g.neighbors_of(place.solid, kNone) == VoidNeighbors::none) {
    exit = g.rounding->find_exit(place.solid, local);
  }
  if (!exit) return std::nullopt;
  const double step = kVoidMargin / 2 * g.rounding->data().solids[place.solid].size;
  const double error = 4 * double(geometry.embree.records()[place.geometry].position_error);
  if (!(exit->cosine * step > error)) return std::nullopt;
  return float(exit->t + step);
}

bool is_left_out(const FilterContext& context, std::uint32_t geometry, std::uint32_t triangle) {
  if (context.only_geometry == kNoGeometry) return false;
  return geometry != context.only_geometry ||
         context.rounding->geometries[geometry].rounding->solid_of(triangle) != context.only_solid;
}

// Drops hits that the ray passes.
void filter_passed(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  auto* context = reinterpret_cast<FilterContext*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* query = reinterpret_cast<const RTCRay*>(args->ray);
  const std::uint32_t geometry = geometry_of(*hit);
  const bool skipped = hit->primID == context->skip_triangle && geometry == context->skip_geometry;
  if (skipped || is_left_out(*context, geometry, hit->primID) ||
      is_departure(*hit, context->ray->from) || is_rounded_away(*context, *hit, query->tfar)) {
    args->valid[0] = 0;
  }
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
  if (record.normals == nullptr || g.frame != nullptr) return hit.geometric_normal;
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

}  // namespace

Verdict judge(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c) {
  Verdict verdict;
  const Rounding::Data& data = g.rounding->data();
  const std::uint32_t face_index = data.face[c.triangle];
  if (face_index == kNone) return verdict;
  const Face& face = data.faces[face_index];
  const Solid& solid = data.solids[face.solid];
  const Ray local = g.local_ray(ray.origin, ray.direction);
  verdict.entering = dot(Vec3d(face.normal), local.direction) < 0;
  RayStart start = RayStart::unknown;
  if (verdict.entering) {
    if (solid.filled != kNone) start = start_of(g, ray, c, face.solid);
  } else {
    start = start_of(g, ray, c, face.solid);
    if (start == RayStart::outside && leaves_own_void(g, ray, c, solid)) {
      verdict.outcome = Resolution::Outcome::passed;
      return verdict;
    }
    if (start == RayStart::outside && solid.filled == kNone) start = RayStart::unknown;
  }
  // From inside, a kept hit may still be that of a ray that starts in the void: of an exact solid, or beside a fillet's
  // end, whose side stands on the sharp face. From outside, it is not judged.
  const bool may_start_in_void =
      solid.exact || (start == RayStart::outside && solid.filled != kNone);
  const bool settled = !verdict.entering && (start == RayStart::inside || !may_start_in_void);
  if (settled && g.is_kept(c.triangle, c.u, c.v)) return verdict;
  Resolution r = g.rounding->resolve(local, {c.triangle, c.u, c.v, c.t}, start);
  const bool into_fillet = r.hit.feature == Feature::fillet;
  if (r.outcome == Resolution::Outcome::passed && !verdict.entering && start == RayStart::inside &&
      !into_fillet) {
    // A ray that starts inside can't pass: borders of what stays are known roughly, and the solid ends where it starts.
    r = {Resolution::Outcome::moved, {0, Vec3d(face.normal), Feature::edge}};
  }
  verdict.outcome = r.outcome;
  verdict.hit = r.hit;
  if (r.outcome != Resolution::Outcome::moved) return verdict;
  if (r.hit.t < ray.t_min && !verdict.entering) {
    // Behind the start: a ray from the void is outside; a ray from inside grazes its own surface.
    verdict.hit.t = ray.t_min;
    if (start != RayStart::inside) verdict.outcome = Resolution::Outcome::passed;
  }
  verdict.entering = dot(local.direction, r.hit.normal) < 0;
  if (g.frame != nullptr) {
    verdict.hit.normal = normalize(g.frame->world_from_rounding_normal * r.hit.normal);
  }
  return verdict;
}

std::optional<TraceRay> skip_void(const SceneGeometry& geometry, const SceneRounding& rounding,
                                  const TraceRay& ray) {
  const std::uint32_t index = ray.from.geometry;
  const RoundedGeometry& g = rounding.geometries[index];
  if (g.rounding == nullptr || g.frame != nullptr) return std::nullopt;
  const std::uint32_t solid_index = g.rounding->solid_of(ray.from.triangle);
  if (!g.rounding->data().solids[solid_index].exact) return std::nullopt;
  const Ray local = g.local_ray(ray.origin, ray.direction);
  const std::optional<float> t =
      find_way_out(geometry, g, {index, solid_index, ray.from.crossed, 0}, local);
  if (!t) return std::nullopt;
  TraceRay beyond = ray;
  beyond.t_min = std::max(ray.t_min, *t);
  beyond.from = {};
  return beyond;
}

SurfaceHit make_fillet_hit(const SceneGeometry& geometry, const TraceRay& ray,
                           const SceneFillets::Met& met) {
  RTCRayHit query{};
  query.hit.geomID = met.geometry;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  query.hit.primID = met.triangle;
  SurfaceHit hit;
  fill_owner(geometry, query, hit);
  hit.t = float(met.hit.t);
  hit.position = Vec3f(Vec3d(ray.origin) + Vec3d(ray.direction) * met.hit.t);
  hit.geometric_normal = hit.shading_normal = Vec3f(met.hit.normal);
  hit.side = dot(Vec3d(ray.direction), met.hit.normal) < 0 ? Side::outside : Side::inside;
  hit.feature = met.hit.feature;
  hit.rounding_seen = true;
  return hit;
}

std::optional<SurfaceHit> RoundedTrace::settle(RTCRayHit first) const {
  for (bool passed_any = false;; passed_any = true) {
    const std::uint32_t geometry = geometry_of(first.hit);
    const RoundedGeometry& g = rounding_.geometries[geometry];
    const Candidate candidate = candidate_of(first.hit, first.ray.tfar);
    const Verdict verdict = g.rounding != nullptr ? judge(g, ray_, candidate) : Verdict{};
    if (verdict.outcome == Resolution::Outcome::moved) return moved(first, verdict);
    if (verdict.outcome == Resolution::Outcome::kept) {
      SurfaceHit hit = make_surface_hit(geometry_, ray_, first);
      hit.rounding_seen = passed_any;
      return hit;
    }
    const std::optional<float> beyond = way_past(g, candidate, verdict);
    if (!beyond) return passed(first, verdict);
    TraceRay rest = ray_;
    rest.t_min = std::max(*beyond, first.ray.tfar);
    const std::optional<RTCRayHit> next = trace_mesh(geometry_, rest);
    if (!next) return std::nullopt;
    first = *next;
  }
}

// Where a ray that passes a hit has left the mesh again, if no other solid can be in between.
std::optional<float> RoundedTrace::way_past(const RoundedGeometry& g, const Candidate& c,
                                            const Verdict& verdict) const {
  const std::uint32_t solid = g.rounding->solid_of(c.triangle);
  if (!g.rounding->data().solids[solid].exact || g.frame != nullptr) return std::nullopt;
  return find_way_out(geometry_, g, {c.geometry, solid, verdict.hit.crossed, double(c.t)},
                      g.local_ray(ray_.origin, ray_.direction));
}

std::optional<SurfaceHit> RoundedTrace::trace_from_void() const {
  const std::optional<Found> found = trace_filtered(ray_, nullptr);
  if (!found) return std::nullopt;
  std::optional<SurfaceHit> hit = next_hit(*found);
  if (hit) hit->rounding_seen = is_rounded(hit->feature);  // as if traced from beyond the void
  return hit;
}

std::optional<SurfaceHit> RoundedTrace::trace_from_inside() const {
  const std::optional<Found> own = trace_own_solid();
  if (!own) {
    const std::optional<RTCRayHit> first = trace_mesh(geometry_, ray_);
    return first ? settle(*first) : std::nullopt;
  }
  TraceRay before = ray_;
  before.t_max = own->t();
  const std::optional<Found> other = trace_filtered(before, &own->query.hit);
  SurfaceHit hit = finish(other && other->t() < own->t() ? *other : *own);
  hit.rounding_seen = is_rounded(hit.feature);
  return hit;
}

std::optional<SurfaceHit> RoundedTrace::moved(const RTCRayHit& query,
                                              const Verdict& verdict) const {
  const RoundedGeometry& g = rounding_.geometries[geometry_of(query.hit)];
  const bool crosses = verdict.entering && verdict.hit.t > double(query.ray.tfar);
  if (crosses && g.neighbors_of(g.rounding->solid_of(query.hit.primID), verdict.hit.crossed) ==
                     VoidNeighbors::inside) {
    // Something else may reach into the void that the ray crosses first.
    TraceRay across = ray_;
    across.t_min = query.ray.tfar;
    across.t_max = std::min(ray_.t_max, float(verdict.hit.t));
    if (const auto other = trace_filtered(across, &query.hit)) return finish(*other);
  }
  if (verdict.hit.t >= double(ray_.t_max)) return std::nullopt;
  return move_hit(query, verdict);
}

std::optional<SurfaceHit> RoundedTrace::passed(const RTCRayHit& query,
                                               const Verdict& verdict) const {
  TraceRay rest = ray_;
  rest.t_min = query.ray.tfar;
  const std::optional<Found> next = trace_filtered(rest, &query.hit);
  if (!next) return std::nullopt;
  // Where the rounding has no surface though the ray crosses the solid, its face stands instead of a hole.
  const bool is_surface = verdict.hit.feature != Feature::fillet;
  if (verdict.entering && is_surface && leaves_kept(query, next->query)) {
    return make_surface_hit(geometry_, ray_, query);
  }
  return next_hit(*next);
}

std::optional<SurfaceHit> RoundedTrace::next_hit(const Found& found) const {
  if (found.verdict.outcome != Resolution::Outcome::moved) return finish(found);
  return moved(found.query, found.verdict);
}

// The next hit is the way out of the same solid, through what is kept of it.
bool RoundedTrace::leaves_kept(const RTCRayHit& entry, const RTCRayHit& exit) const {
  if (geometry_of(entry.hit) != geometry_of(exit.hit)) return false;
  const RoundedGeometry& g = rounding_.geometries[geometry_of(entry.hit)];
  const std::uint32_t solid = g.rounding->solid_of(entry.hit.primID);
  if (solid != g.rounding->solid_of(exit.hit.primID) || g.rounding->is_exact(solid)) return false;
  const Ray local = g.local_ray(ray_.origin, ray_.direction);
  return dot(g.rounding->face_normal(exit.hit.primID), local.direction) > 0;
}

SurfaceHit RoundedTrace::finish(const Found& found) const {
  if (found.verdict.outcome == Resolution::Outcome::moved) {
    return move_hit(found.query, found.verdict);
  }
  SurfaceHit hit = make_surface_hit(geometry_, ray_, found.query);
  hit.rounding_seen = true;
  return hit;
}

SurfaceHit RoundedTrace::move_hit(const RTCRayHit& query, const Verdict& verdict) const {
  SurfaceHit hit;
  fill_owner(geometry_, query, hit);
  hit.t = float(verdict.hit.t);
  hit.position = Vec3f(Vec3d(ray_.origin) + Vec3d(ray_.direction) * verdict.hit.t);
  hit.geometric_normal = Vec3f(verdict.hit.normal);
  hit.side = verdict.entering ? Side::outside : Side::inside;
  hit.feature = verdict.hit.feature;
  hit.crossed = verdict.hit.crossed;
  hit.rounding_seen = true;
  hit.shading_normal =
      blended_normal(geometry_, rounding_.geometries[hit.geometry], hit, verdict.hit);
  return hit;
}

std::optional<RoundedTrace::Found> RoundedTrace::trace_filtered(const TraceRay& range,
                                                                const RTCHit* without) const {
  FilterContext context = make_filter_context(geometry_, rounding_, ray_);
  context.t_max = range.t_max;
  if (without != nullptr) {
    context.skip_geometry = geometry_of(*without);
    context.skip_triangle = without->primID;
  }
  return search(geometry_, range, context);
}

std::optional<RoundedTrace::Found> RoundedTrace::trace_own_solid() const {
  FilterContext context = make_filter_context(geometry_, rounding_, ray_);
  context.t_max = ray_.t_max;
  context.only_geometry = ray_.from.geometry;
  context.only_solid =
      rounding_.geometries[ray_.from.geometry].rounding->solid_of(ray_.from.triangle);
  return search(geometry_, ray_, context);
}

std::optional<RoundedTrace::Found> RoundedTrace::search(const SceneGeometry& geometry,
                                                        const TraceRay& range,
                                                        FilterContext& context) {
  context.base.filter = filter_passed;
  RTCRayHit query;
  query.ray = make_ray(range);
  // Embree's ranges are open at their begin.
  query.ray.tnear = std::nextafter(query.ray.tnear, 0.0F);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(geometry.embree.handle(), &context.base, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Found{query, context.last};
}

}  // namespace arris
