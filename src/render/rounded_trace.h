// rounded_trace.h — rays among rounded objects
// What       A hit on a rounded object stands, moves onto an edge or corner, or the ray passes between the sharp and
//            the rounded surface (arris/rounding.h). Closest hits are traced without a filter, as most hits are kept;
//            a ray that passes is traced again with a filter that drops what it passes. It then sees what
//            touches the object from outside at the very distance where it leaves (the main picture of the
//            paper, its Fig. 9), with no resume distance and no tolerance. A ray that leaves a rounded edge starts in
//            the void, where the first hit is always its own solid's back: it is traced with the filter at once.
//            Where no other solid is near (void_neighbors.h), the void is crossed in one step instead, without filter.
// Guarantee  never a hole: a solid that is not rounded exactly is passed only where the ray enters and leaves
//            within what the rounding takes away; elsewhere its face stands
// Included   by trace.cpp only
// Source     Courtin et al. §4, Fig. 7. There a secondary ray starts on the mesh, at I″; here it starts at I′, with the
//            filter, as I″ lies on the face of any solid that touches
#pragma once

#include <algorithm>
#include <limits>

#include "render/embree_hit.h"
#include "render/scene_rounding.h"

namespace arris {

struct Candidate {
  std::uint32_t geometry = kNoGeometry;
  std::uint32_t triangle = 0;
  float u = 0, v = 0, t = 0;
};

inline Candidate candidate_of(const RTCHit& hit, float t) {
  return {geometry_of(hit), hit.primID, hit.u, hit.v, t};
}

struct Verdict {
  Resolution::Outcome outcome = Resolution::Outcome::kept;
  RoundedHit hit;  // if moved: t of the ray, normal in world space
  bool entering =
      false;  // of the hit, and of what it moved to: a ray from the void may enter before it leaves
};

// Most hits: from outside, on what is kept. From inside, the ray may be leaving its void, and a ray that starts inside
// may have left a fillet by its side: judge() looks.
inline bool is_plainly_kept(const RoundedGeometry& g, const TraceRay& ray, const RTCHit& hit) {
  if (g.rounding == nullptr) return true;
  if (ray.from.side == Side::inside) return false;
  if (!g.is_kept(hit.primID, hit.u, hit.v)) return false;
  if (g.frame == nullptr && !g.any_turned) [[likely]] {
    return dot(Vec3f(hit.Ng_x, hit.Ng_y, hit.Ng_z), ray.direction) < 0;
  }
  return dot(g.rounding->face_normal(hit.primID),
             g.local_ray(ray.origin, ray.direction).direction) < 0;
}

// The closest triangle that the ray does not start on.
inline std::optional<RTCRayHit> trace_mesh(const SceneGeometry& geometry, const TraceRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::optional<RTCRayHit> query(std::in_place);
  query->ray = make_ray(ray);
  float step = std::numeric_limits<float>::min();
  for (;;) {
    query->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(geometry.embree.handle(), &context, &*query);
    if (query->hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      query.reset();
      return query;
    }
    if (!is_departure(query->hit, ray.from)) [[likely]] {
      return query;
    }
    // A plane is met once: slivers can be met again by rounding. Steps that double end even where they
    // are flushed to zero at first.
    step = std::max(2 * step, query->ray.tfar * std::numeric_limits<float>::epsilon());
    query->ray.tnear = query->ray.tfar + step;
    query->ray.tfar = ray.t_max;
  }
}

// A surface that rounding has made.
inline bool is_rounded(Feature feature) {
  return feature != Feature::face && feature != Feature::csg;
}

// Between the sharp and the rounded surface: where rays leave a rounded edge outward.
inline bool starts_in_void(const TraceRay& ray) {
  return ray.from.feature != Feature::face && ray.from.feature != Feature::fillet &&
         ray.from.side == Side::outside;
}

// In a solid with neighbours: another's surface may coincide with where the ray leaves, or lie beyond it while the
// rounded edge lies before.
inline bool starts_inside_among_others(const SceneRounding& rounding, const TraceRay& ray) {
  if (ray.from.side != Side::inside) return false;
  const RoundedGeometry& g = rounding.geometries[ray.from.geometry];
  if (g.neighbors == nullptr) return false;
  const std::uint32_t solid = g.rounding->solid_of(ray.from.triangle);
  return solid != kNone && g.neighbors_of(solid, kNone) != VoidNeighbors::none;
}

// A ray that starts in the void of an exact solid, begun where it has left the mesh, as in the paper. Nothing if it
// could miss another solid that touches there or reaches into the void.
std::optional<TraceRay> skip_void(const SceneGeometry& geometry, const SceneRounding& rounding,
                                  const TraceRay& ray);

// A hit on a fillet that no hit on the mesh has led to.
SurfaceHit make_fillet_hit(const SceneGeometry& geometry, const TraceRay& ray,
                           const SceneFillets::Met& met);

// What becomes of one hit on a rounded geometry.
Verdict judge(const RoundedGeometry& g, const TraceRay& ray, const Candidate& c);

// Embree's context with what its filters need.
struct FilterContext {
  RTCIntersectContext base;  // first, so that a pointer to it is a pointer to this
  const SceneGeometry* geometry = nullptr;
  const SceneRounding* rounding = nullptr;
  const TraceRay* ray = nullptr;
  float t_max = 0;  // of this search; the ray's own may be farther
  // A ray that leaves a rounded edge of this closed solid outward: what it meets of it from inside is its void's end.
  std::uint32_t own_geometry = kNoGeometry;
  std::uint32_t own_solid = kNone;
  // Nothing but this solid counts, if one is given.
  std::uint32_t only_geometry = kNoGeometry;
  std::uint32_t only_solid = kNone;
  // Hit already judged, to be dropped.
  std::uint32_t skip_geometry = kNoGeometry;
  std::uint32_t skip_triangle = 0;
  float transmittance = 1;  // of a shadow ray so far
  Verdict last;             // of the last hit let through, the closest in the end
};

inline FilterContext make_filter_context(const SceneGeometry& geometry,
                                         const SceneRounding& rounding, const TraceRay& ray) {
  FilterContext context{};
  rtcInitIntersectContext(&context.base);
  context.geometry = &geometry;
  context.rounding = &rounding;
  context.ray = &ray;
  context.t_max = ray.t_max;
  if (rounding.any && starts_in_void(ray)) {
    const RoundedGeometry& g = rounding.geometries[ray.from.geometry];
    const std::uint32_t solid = g.rounding->solid_of(ray.from.triangle);
    if (g.frame == nullptr && !g.any_turned && g.rounding->data().solids[solid].closed) {
      context.own_geometry = ray.from.geometry;
      context.own_solid = solid;
    }
  }
  return context;
}

// Then the ray is judged where it enters the solid: to see it leave tells no more.
inline bool comes_from_outside(const RoundedGeometry& g, std::uint32_t solid_index,
                               const TraceRay& ray) {
  if (solid_index == kNone) return false;
  const Rounding::Data& data = g.rounding->data();
  const Solid& solid = data.solids[solid_index];
  if (!solid.exact) return false;
  const Vec3d start = Vec3d(ray.origin) + Vec3d(ray.direction) * double(ray.t_min);
  return !is_in_solid(data, solid, start - solid.center);
}

// The ray passes the sharp hit, or meets what it moved to only beyond its end.
inline bool is_rounded_away(FilterContext& context, const RTCHit& hit, float t) {
  const std::uint32_t geometry = geometry_of(hit);
  const RoundedGeometry& g = context.rounding->geometries[geometry];
  const bool leaves = dot(Vec3f(hit.Ng_x, hit.Ng_y, hit.Ng_z), context.ray->direction) > 0;
  if (leaves && g.rounding != nullptr && g.frame == nullptr && !g.any_turned) {
    const std::uint32_t solid = g.rounding->solid_of(hit.primID);
    if (geometry == context.own_geometry && solid == context.own_solid) return true;
    if (comes_from_outside(g, solid, *context.ray)) return true;
  }
  if (is_plainly_kept(g, *context.ray, hit)) {
    context.last.outcome = Resolution::Outcome::kept;
    return false;
  }
  const Verdict verdict = judge(g, *context.ray, candidate_of(hit, t));
  const bool beyond =
      verdict.outcome == Resolution::Outcome::moved && verdict.hit.t >= double(context.t_max);
  if (verdict.outcome == Resolution::Outcome::passed || beyond) return true;
  context.last = verdict;
  return false;
}

// The closest hit where the first hit of the mesh is not simply kept, or the ray starts in the void.
class RoundedTrace {
 public:
  RoundedTrace(const SceneGeometry& geometry, const SceneRounding& rounding, const TraceRay& ray)
      : geometry_(geometry), rounding_(rounding), ray_(ray) {}

  std::optional<SurfaceHit> settle(RTCRayHit first) const;
  std::optional<SurfaceHit> trace_from_void() const;
  std::optional<SurfaceHit> trace_from_inside() const;

 private:
  struct Found {
    RTCRayHit query;
    Verdict verdict;

    [[nodiscard]] float t() const {
      return verdict.outcome == Resolution::Outcome::moved ? float(verdict.hit.t) : query.ray.tfar;
    }
  };

  [[nodiscard]] std::optional<SurfaceHit> moved(const RTCRayHit& query,
                                                const Verdict& verdict) const;
  [[nodiscard]] std::optional<SurfaceHit> passed(const RTCRayHit& query,
                                                 const Verdict& verdict) const;
  // What was found beyond a hit that was passed.
  [[nodiscard]] std::optional<SurfaceHit> next_hit(const Found& found) const;
  [[nodiscard]] std::optional<float> way_past(const RoundedGeometry& g, const Candidate& c,
                                              const Verdict& verdict) const;
  [[nodiscard]] bool leaves_kept(const RTCRayHit& entry, const RTCRayHit& exit) const;
  [[nodiscard]] SurfaceHit finish(const Found& found) const;
  [[nodiscard]] SurfaceHit move_hit(const RTCRayHit& query, const Verdict& verdict) const;
  // Next hit at or behind range.t_min that the ray does not pass, other than `without`.
  [[nodiscard]] std::optional<Found> trace_filtered(const TraceRay& range,
                                                    const RTCHit* without) const;
  // The same for the solid in which the ray starts alone.
  [[nodiscard]] std::optional<Found> trace_own_solid() const;
  [[nodiscard]] static std::optional<Found> search(const SceneGeometry& geometry,
                                                   const TraceRay& range, FilterContext& context);

  const SceneGeometry& geometry_;
  const SceneRounding& rounding_;
  const TraceRay& ray_;
};

}  // namespace arris
