#include "beam/ray_bundle.h"

#include <cmath>

namespace arris {
namespace {

using Root = BeamSurface::Root;

double middle_of(Interval a) {
  return a.lo / 2 + a.hi / 2;
}

QuadraticVec sum(const QuadraticVec& a, const QuadraticVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
QuadraticVec difference(const QuadraticVec& a, const QuadraticVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
QuadraticVec constant_models(const Vec3i& v) {
  return {constant_model(v.x), constant_model(v.y), constant_model(v.z)};
}
Quadratic dot_of(const Vec3i& n, const QuadraticVec& v) {
  return v.x * n.x + v.y * n.y + v.z * n.z;
}
Quadratic squared_length(const QuadraticVec& a) {
  return squared(a.x) + squared(a.y) + squared(a.z);
}

QuadraticVec weighted(const QuadraticVec& v, Vec3d w) {
  return {v.x * Interval(w.x), v.y * Interval(w.y), v.z * Interval(w.z)};
}
Quadratic weighted_square(const QuadraticVec& v, Vec3d w) {
  return squared(v.x) * Interval(w.x) + squared(v.y) * Interval(w.y) + squared(v.z) * Interval(w.z);
}

// In a solid's space.
bool starts_on(const RayBundle& bundle, const BeamSurface& surface) {
  return bundle.start && bundle.start->lies_on(surface);
}

// Depth at which the rays meet the quadric: from the middle of the roots, which is near, where they lie around it.
std::optional<Quadratic> depth_of(const BundleQuadric& q, Root root, bool begin_on_it) {
  const auto quotient = [](const Quadratic& a, const Quadratic& b) -> std::optional<Quadratic> {
    const std::optional<Quadratic> inverse = reciprocal(b);
    return inverse ? std::optional(product(a, *inverse)) : std::nullopt;
  };
  if (begin_on_it) return quotient(q.half_slope * Interval(-2), q.curvature);
  const Quadratic middle = square_root(q.discriminant);
  if (range_over(q.curvature, kUnitSquare).lo > 0) {
    const bool nearer = root == Root::nearer;
    std::optional<Quadratic> depth =
        quotient((nearer ? -middle : middle) - q.base_half_slope, q.curvature);
    if (depth) depth->c += Interval(q.base);
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
  QuadraticVec point, normal;  // of any length, and to either side
};

std::optional<BundleHit> hit_of(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                const BeamSurface& surface) {
  if (surface.is_whole()) return std::nullopt;
  const BeamSolid& solid = solids[surface.solid];
  const RayBundle own = map_bundle(solid.object_from_world, bundle);
  std::optional<Quadratic> depth;
  if (surface.is_plane()) {
    if (starts_on(bundle, surface)) return std::nullopt;
    const BundlePlane form = make_form(own, solid.shape->planes()[surface.index]);
    const std::optional<Quadratic> inverse = reciprocal(form.slope);
    if (inverse) depth = -product(form.height, *inverse);
  } else {
    depth = depth_of(make_form(own, solid.shape->quadrics()[surface.index]), surface.root,
                     starts_on(bundle, surface));
  }
  if (!depth) return std::nullopt;
  BundleHit hit;
  hit.point = sum(bundle.origin, scaled(bundle.direction, *depth));
  const Mat3d to_world = transpose(solid.object_from_world.linear);
  if (surface.is_plane()) {
    const Vec3d n = solid.shape->planes()[surface.index].normal;
    hit.normal = constant_models(map_vector(to_world, to_intervals(n)));
    return hit;
  }
  const CsgQuadric& quadric = solid.shape->quadrics()[surface.index];
  const QuadraticVec at =
      map_point(quadric.unit_from_object, map_point(solid.object_from_world, hit.point));
  const QuadraticVec gradient = weighted(at, weights_of(quadric.form));
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
  return {sum(bundle.origin, scaled(bundle.direction, Interval(depth))), bundle.direction,
          std::nullopt};
}

// d - 2 n (n·d) / n²
std::optional<RayBundle> reflect(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface) {
  const std::optional<BundleHit> hit = hit_of(bundle, solids, surface);
  if (!hit) return std::nullopt;
  const std::optional<Quadratic> inverse = reciprocal(squared_length(hit->normal));
  if (!inverse) return std::nullopt;
  const Quadratic across = product(dot_of(hit->normal, bundle.direction), *inverse) * Interval(2);
  return RayBundle{hit->point, difference(bundle.direction, scaled(hit->normal, across)), surface};
}

// By Snell's law with η the relative index, a = n·d < 0: η d - n (η a + √((1 - η²) n² d² + η² a²)) / n². Total
// reflection where the root's argument is negative.
std::optional<RayBundle> refract(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface, double relative_ior) {
  const std::optional<BundleHit> hit = hit_of(bundle, solids, surface);
  if (!hit) return std::nullopt;
  const Quadratic across = dot_of(hit->normal, bundle.direction);
  const Interval side = range_over(across, kUnitSquare);
  if (side.contains(0)) return std::nullopt;
  const Interval against(side.lo > 0 ? -1 : 1);
  const Quadratic a = across * against;
  const Quadratic nn = squared_length(hit->normal), dd = squared_length(bundle.direction);
  const std::optional<Quadratic> inverse = reciprocal(nn);
  if (!inverse) return std::nullopt;
  const Interval eta(relative_ior);
  const Quadratic radicand =
      product(nn, dd) * (Interval(1) - square(eta)) + squared(a) * square(eta);
  if (!(range_over(radicand, kUnitSquare).lo > 0)) return std::nullopt;
  const Quadratic along = product(a * eta + square_root(radicand), *inverse) * against;
  return RayBundle{
      hit->point, difference(scaled(bundle.direction, eta), scaled(hit->normal, along)), surface};
}

BundlePlane make_form(const RayBundle& bundle, const CsgPlane& plane) {
  const Vec3i n = to_intervals(plane.normal);
  return {dot_of(n, bundle.origin) - constant_model(plane.d), dot_of(n, bundle.direction)};
}

// The discriminant is the same wherever rays begin.
BundleQuadric make_form(const RayBundle& bundle, const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const Quadratic constant = constant_model(constant_of(quadric.form));
  const QuadraticVec o = map_point(m, bundle.origin);
  const QuadraticVec d = map_vector(m.linear, bundle.direction), weighted_d = weighted(d, w);
  BundleQuadric form;
  form.value = weighted_square(o, w) - constant;
  form.half_slope = dot_of(o, weighted_d);
  form.curvature = weighted_square(d, w);
  form.along = o.z;
  const double base = -middle_of(form.half_slope.c) / middle_of(form.curvature.c);
  form.base = std::isfinite(base) ? base : 0;
  const QuadraticVec near = sum(o, scaled(d, Interval(form.base)));
  form.base_half_slope = dot_of(near, weighted_d);
  form.discriminant = squared(form.base_half_slope) -
                      product(weighted_square(near, w) - constant, form.curvature);
  return form;
}

// direction · ((b - a) × (origin - a))
Quadratic make_side(const RayBundle& bundle, const BeamShape::Edge& edge) {
  const Vec3i a = to_intervals(edge.a), along = to_intervals(edge.b) - a;
  const QuadraticVec o = difference(bundle.origin, constant_models(a));
  const QuadraticVec across{o.z * along.y - o.y * along.z, o.x * along.z - o.z * along.x,
                            o.y * along.x - o.x * along.y};
  return dot_of(bundle.direction, across);
}

BundlePlane begun_at(const BundlePlane& form, double depth) {
  return {form.height + form.slope * Interval(depth), form.slope};
}

double middle_depth(const BundlePlane& form) {
  const double depth = -middle_of(form.height.c) / middle_of(form.slope.c);
  return std::isfinite(depth) && depth > 0 ? depth : 0;
}

// As of beams with one origin, see beam_view.cpp.
Quadratic plane_before_plane(const BundlePlane& a, const BundlePlane& b) {
  return product(a.slope, b.height) - product(b.slope, a.height);
}
Quadratic quadric_at_plane(const BundleQuadric& q, const BundlePlane& p) {
  return product(q.value, squared(p.slope)) -
         product(product(p.height, p.slope), q.half_slope) * Interval(2) +
         product(q.curvature, squared(p.height));
}
Quadratic plane_beyond_middle(const BundleQuadric& q, const BundlePlane& p) {
  return product(p.slope, q.half_slope) - product(p.height, q.curvature);
}

}  // namespace arris
