#include "beam/ray_bundle.h"

#include <cmath>

namespace arris {
namespace {

using Root = BeamSurface::Root;

ModelVec constant_models(const Vec3i& v) {
  return {constant_model(v.x), constant_model(v.y), constant_model(v.z)};
}
TaylorModel squared_length(const ModelVec& a) {
  return squared(a.x) + squared(a.y) + squared(a.z);
}

ModelVec weighted(const ModelVec& v, Vec3d w) {
  return {v.x * w.x, v.y * w.y, v.z * w.z};
}
TaylorModel weighted_square(const ModelVec& v, Vec3d w) {
  return squared(v.x) * w.x + squared(v.y) * w.y + squared(v.z) * w.z;
}

// In a solid's space.
bool starts_on(const RayBundle& bundle, const BeamSurface& surface) {
  return bundle.start && bundle.start->lies_on(surface);
}

// Depth at which the rays meet the quadric: from the middle of the roots, which is near, where they lie around it.
std::optional<TaylorModel> depth_of(const BundleQuadric& q, Root root, bool begin_on_it) {
  const auto quotient = [](const TaylorModel& a,
                           const TaylorModel& b) -> std::optional<TaylorModel> {
    const std::optional<TaylorModel> inverse = reciprocal(b);
    return inverse ? std::optional(a * *inverse) : std::nullopt;
  };
  if (begin_on_it) return quotient(q.half_slope * -2.0, q.curvature);
  const TaylorModel middle = square_root(q.discriminant);
  if (range_of(q.curvature).lo > 0) {
    const bool nearer = root == Root::nearer;
    std::optional<TaylorModel> depth =
        quotient((nearer ? -middle : middle) - q.base_half_slope, q.curvature);
    if (depth) depth = *depth + constant_model(q.base);
    return depth;
  }
  switch (root) {
    case Root::nearer:
      return quotient(q.value, middle - q.half_slope);
    case Root::farther:
      return quotient(middle - q.half_slope, q.curvature);
    case Root::leaving:
      return quotient(-q.value, q.half_slope + middle);
    case Root::other_half:
      return quotient(q.half_slope + middle, -q.curvature);
    case Root::none:
    case Root::whole:
      break;
  }
  return std::nullopt;
}

struct BundleHit {
  ModelVec point, normal;  // of any length, and to either side
};

std::optional<BundleHit> hit_of(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                const BeamSurface& surface) {
  if (surface.is_whole()) return std::nullopt;
  const BeamSolid& solid = solids[surface.solid];
  const RayBundle own = map_bundle(solid.object_from_world, bundle);
  std::optional<TaylorModel> depth;
  if (surface.is_plane()) {
    if (starts_on(bundle, surface)) return std::nullopt;
    const BundlePlane form = make_form(own, solid.shape->planes()[surface.index]);
    const std::optional<TaylorModel> inverse = reciprocal(form.slope);
    if (inverse) depth = -form.height * *inverse;
  } else {
    depth = depth_of(make_form(own, solid.shape->quadrics()[surface.index]), surface.root,
                     starts_on(bundle, surface));
  }
  if (!depth) return std::nullopt;
  BundleHit hit;
  hit.point = bundle.origin + bundle.direction * *depth;
  const Mat3d to_world = transpose(solid.object_from_world.linear);
  if (surface.is_plane()) {
    const Vec3d n = solid.shape->planes()[surface.index].normal;
    hit.normal = constant_models(map_vector(to_world, to_intervals(n)));
    return hit;
  }
  const CsgQuadric& quadric = solid.shape->quadrics()[surface.index];
  const ModelVec at =
      map_point(quadric.unit_from_object, map_point(solid.object_from_world, hit.point));
  const ModelVec gradient = weighted(at, weights_of(quadric.form));
  hit.normal =
      map_vector(to_world, map_vector(transpose(quadric.unit_from_object.linear), gradient));
  return hit;
}

}  // namespace

RayBundle make_bundle(const EyeRays& eye, const Rect& rect) {
  const auto linear = [&](double c, double x, double y) { return linear_over(rect, c, x, y); };
  const Vec3d &c = eye.corner, &x = eye.step_x, &y = eye.step_y;
  return {constant_models(to_intervals(eye.position)),
          {linear(c.x, x.x, y.x), linear(c.y, x.y, y.y), linear(c.z, x.z, y.z)},
          std::nullopt};
}

RayBundle map_bundle(const Affine3d& m, const RayBundle& bundle) {
  return {map_point(m, bundle.origin), map_vector(m.linear, bundle.direction), bundle.start};
}

RayBundle begun_at(const RayBundle& bundle, double depth) {
  return {bundle.origin + scaled(bundle.direction, depth), bundle.direction, std::nullopt};
}

// d - 2 n (n·d) / n²
std::optional<RayBundle> reflect(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface) {
  const std::optional<BundleHit> hit = hit_of(bundle, solids, surface);
  if (!hit) return std::nullopt;
  const std::optional<TaylorModel> inverse = reciprocal(squared_length(hit->normal));
  if (!inverse) return std::nullopt;
  const TaylorModel across = dot(hit->normal, bundle.direction) * *inverse * 2.0;
  return RayBundle{hit->point, bundle.direction - hit->normal * across, surface};
}

namespace {

// Of a normal against the rays, a = n·d < 0: (1 - η²) n² d² + η² a², which is negative under total reflection.
TaylorModel radicand_of(const RayBundle& bundle, const ModelVec& normal, const TaylorModel& across,
                        double eta) {
  const TaylorModel less = constant_model(Interval(1) - square(Interval(eta)));
  return squared_length(normal) * squared_length(bundle.direction) * less + squared(across * eta);
}

}  // namespace

// By Snell's law with η the relative index: η d - n (η a + √radicand) / n².
std::optional<RayBundle> refract(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface, double relative_ior) {
  std::optional<BundleHit> hit = hit_of(bundle, solids, surface);
  if (!hit) return std::nullopt;
  const Interval side = range_of(dot(hit->normal, bundle.direction));
  if (side.contains(0)) return std::nullopt;
  if (side.lo > 0) hit->normal = -hit->normal;
  const TaylorModel across = dot(hit->normal, bundle.direction);
  const std::optional<TaylorModel> inverse = reciprocal(squared_length(hit->normal));
  if (!inverse) return std::nullopt;
  const TaylorModel radicand = radicand_of(bundle, hit->normal, across, relative_ior);
  if (!(range_of(radicand).lo > 0)) return std::nullopt;
  const TaylorModel along = (across * relative_ior + square_root(radicand)) * *inverse;
  return RayBundle{hit->point, scaled(bundle.direction, relative_ior) - hit->normal * along,
                   surface};
}

Passing passing_of(const RayBundle& bundle, std::span<const BeamSolid> solids,
                   const BeamSurface& surface, double relative_ior) {
  const std::optional<BundleHit> hit = hit_of(bundle, solids, surface);
  if (!hit) return Passing::unknown;
  const TaylorModel across = dot(hit->normal, bundle.direction);
  const Interval range = range_of(radicand_of(bundle, hit->normal, across, relative_ior));
  return range.lo > 0 ? Passing::all : range.hi < 0 ? Passing::none : Passing::unknown;
}

BundlePlane make_form(const RayBundle& bundle, const CsgPlane& plane) {
  return {dot_of(plane.normal, bundle.origin) - constant_model(plane.d),
          dot_of(plane.normal, bundle.direction)};
}

// The discriminant is the same wherever rays begin.
BundleQuadric make_form(const RayBundle& bundle, const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const TaylorModel constant = constant_model(constant_of(quadric.form));
  const ModelVec o = map_point(m, bundle.origin);
  const ModelVec d = map_vector(m.linear, bundle.direction), weighted_d = weighted(d, w);
  BundleQuadric form;
  form.value = weighted_square(o, w) - constant;
  form.half_slope = dot(o, weighted_d);
  form.curvature = weighted_square(d, w);
  form.along = o.z;
  const double base = -form.half_slope.c / form.curvature.c;
  form.base = std::isfinite(base) ? base : 0;
  const ModelVec near = o + scaled(d, form.base);
  form.base_half_slope = dot(near, weighted_d);
  form.discriminant =
      squared(form.base_half_slope) - (weighted_square(near, w) - constant) * form.curvature;
  return form;
}

// direction · ((b - a) × (origin - a))
TaylorModel make_side(const RayBundle& bundle, const BeamShape::Edge& edge) {
  const Vec3i a = to_intervals(edge.a);
  const ModelVec along = constant_models(to_intervals(edge.b) - a);
  return dot(bundle.direction, cross(along, bundle.origin - constant_models(a)));
}

BundlePlane begun_at(const BundlePlane& form, double depth) {
  return {form.height + form.slope * depth, form.slope};
}

double middle_depth(const BundlePlane& form) {
  const double depth = -form.height.c / form.slope.c;
  return std::isfinite(depth) && depth > 0 ? depth : 0;
}

// As of beams with one origin, see beam_view.cpp.
TaylorModel plane_before_plane(const BundlePlane& a, const BundlePlane& b) {
  return a.slope * b.height - b.slope * a.height;
}
TaylorModel quadric_at_plane(const BundleQuadric& q, const BundlePlane& p) {
  return q.value * squared(p.slope) - p.height * p.slope * q.half_slope * 2.0 +
         q.curvature * squared(p.height);
}
TaylorModel plane_beyond_middle(const BundleQuadric& q, const BundlePlane& p) {
  return p.slope * q.half_slope - p.height * q.curvature;
}

}  // namespace arris
