// trace.cpp — the ray functions: the only way to geometry
#include <limits>

#include "render/bevel_shader.h"
#include "render/rounded_trace.h"

namespace arris {
namespace {

MaterialId csg_material(const SceneGeometry& geometry, const TraceRay& ray, const RTCHit& hit,
                        float t) {
  RTCRayHit query{make_ray(ray), hit};
  query.ray.tfar = t;
  return make_surface_hit(geometry, ray, query).material;
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
  const bool is_csg = record.triangles == nullptr;
  const MaterialId id = is_csg ? csg_material(geometry, *context->ray, *hit, query->tfar)
                               : material_of(record, hit->primID);
  if (!geometry.materials[id.index].translucent) return;
  const Vec2f uv =
      is_csg ? Vec2f{} : interpolated_uv(record, record.triangles[hit->primID], hit->u, hit->v);
  context->transmittance *=
      1 - eval_opacity(geometry.scene.materials[id.index], geometry.scene.textures, uv);
  if (context->transmittance > 0) args->valid[0] = 0;
}

float transmittance_of_fillets(const SceneGeometry& geometry, const SceneRounding& rounding,
                               TraceRay ray) {
  float transmittance = 1;
  while (const auto met = rounding.fillets.meet(rounding.geometries, ray, ray.t_max)) {
    const SurfaceHit hit = make_fillet_hit(geometry, ray, *met);
    if (!geometry.materials[hit.material.index].translucent) return 0;
    transmittance *= 1 - eval_opacity(geometry.scene.materials[hit.material.index],
                                      geometry.scene.textures, hit.uv);
    if (!(transmittance > 0) || !(hit.t > ray.t_min)) break;
    ray.t_min = hit.t;
    ray.from = {};
  }
  return transmittance;
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
  const bool from_void = rounding_.any && starts_in_void(ray);
  const std::optional<TraceRay> beyond =
      from_void ? skip_void(*geometry_, rounding_, ray) : std::nullopt;
  const TraceRay& way = beyond ? *beyond : ray;
  if (from_void && !beyond) [[unlikely]] {
    hit = RoundedTrace(*geometry_, rounding_, way).trace_from_void();
  } else if (rounding_.any && starts_inside_among_others(rounding_, way)) [[unlikely]] {
    hit = RoundedTrace(*geometry_, rounding_, way).trace_from_inside();
  } else if (const std::optional<RTCRayHit> first = trace_mesh(*geometry_, way)) {
    const std::uint32_t geometry = geometry_of(first->hit);
    if (!rounding_.any || is_plainly_kept(rounding_.geometries[geometry], way, first->hit))
        [[likely]] {
      fill_hit(*geometry_, way, *first, hit.emplace());
    } else {
      hit = RoundedTrace(*geometry_, rounding_, way).settle(*first);
    }
  }
  if (!rounding_.fillets.is_empty()) {
    const double end = hit ? double(hit->t) : double(ray.t_max);
    if (const auto met = rounding_.fillets.meet(rounding_.geometries, ray, end)) {
      hit = make_fillet_hit(*geometry_, ray, *met);
    }
  }
  if (!rounding_.shaders.empty() && hit) [[unlikely]] {
    const BevelShader& shader = rounding_.shaders[hit->geometry];
    if (shader.delta > 0) bend_normal(*this, shader, way.direction, *hit);
  }
  return hit;
}

float PreparedScene::transmittance(const TraceRay& ray) const {
  const std::optional<TraceRay> beyond =
      rounding_.any && starts_in_void(ray) ? skip_void(*geometry_, rounding_, ray) : std::nullopt;
  const TraceRay& way = beyond ? *beyond : ray;
  FilterContext context = make_filter_context(*geometry_, rounding_, way);
  if (rounding_.any || geometry_->any_translucent) {
    context.base.filter = filter_shadow;
  }
  RTCRay query = make_ray(way);
  rtcOccluded1(geometry_->embree.handle(), &context.base, &query);
  if (query.tfar < 0) return 0;
  if (rounding_.fillets.is_empty()) return context.transmittance;
  return context.transmittance * transmittance_of_fillets(*geometry_, rounding_, ray);
}

}  // namespace arris
