#include "beam/beam_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

// c + x·sx + y·sy
LinearVec make_linear(const Vec3i& c, const Vec3i& sx, const Vec3i& sy) {
  return {{c.x, sx.x, sy.x}, {c.y, sx.y, sy.y}, {c.z, sx.z, sy.z}};
}
Linear dot(Vec3d n, const LinearVec& v) {
  return v.x * Interval(n.x) + v.y * Interval(n.y) + v.z * Interval(n.z);
}
LinearVec map_linear(const Mat3d& m, const LinearVec& v) {
  const Mat3d rows = transpose(m);
  return {dot(rows.x, v), dot(rows.y, v), dot(rows.z, v)};
}
LinearVec add_scaled(const LinearVec& a, const Linear& weight, Vec3d v) {
  return {a.x + weight * Interval(v.x), a.y + weight * Interval(v.y), a.z + weight * Interval(v.z)};
}
// Of a polynomial that is known to be constant.
Linear scaled(const Linear& a, const Linear& only_constant) {
  return a * only_constant.c;
}

// The discriminant of a cylinder is a product. With × in the plane across its axis, and w the weight:
// Direction fixed: w² d² - (o×d)² = (w |d| - o×d) (w |d| + o×d).
// Origin fixed: o² times it is (o·d)² - k² (o×d)², k² = o² - 1; before the eye o·d < 0, so both -o·d ± k o×d are
// positive where the ray hits.
void add_tangents(QuadricForm& form, const LinearVec& o, const LinearVec& d,
                  const ViewFrame& frame) {
  Linear middle, side;
  if (frame.kind == BeamKind::parallel) {
    middle = frame.weight * square_root(square(d.x.c) + square(d.y.c));
    side = scaled(o.x, d.y) - scaled(o.y, d.x);
  } else {
    const Interval squared_k = square(o.x.c) + square(o.y.c) - Interval(1);
    if (!(squared_k.lo > 0)) return;
    middle = -form.half_slope;
    side = (scaled(d.y, o.x) - scaled(d.x, o.y)) * square_root(squared_k);
  }
  form.has_tangents = true;
  form.tangents[0] = middle - side;
  form.tangents[1] = middle + side;
}

}  // namespace

PlaneForm make_form(const ViewFrame& frame, const CsgPlane& plane) {
  return {dot(plane.normal, frame.origin) - frame.weight * Interval(plane.d),
          dot(plane.normal, frame.direction)};
}

// One of origin and direction is constant, so no product has a degree above 2.
QuadricForm make_form(const ViewFrame& frame, const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const LinearVec o = add_scaled(map_linear(m.linear, frame.origin), frame.weight, m.translation);
  const LinearVec d = map_linear(m.linear, frame.direction);
  const bool fixed = frame.kind == BeamKind::parallel;
  const auto times = [fixed](const Linear& of_o, const Linear& of_d) {
    return fixed ? scaled(of_o, of_d) : scaled(of_d, of_o);
  };
  QuadricForm form;
  form.value = squared(o.x) * Interval(w.x) + squared(o.y) * Interval(w.y) +
               squared(o.z) * Interval(w.z) -
               squared(frame.weight) * Interval(constant_of(quadric.form));
  form.curvature =
      squared(d.x) * Interval(w.x) + squared(d.y) * Interval(w.y) + squared(d.z) * Interval(w.z);
  form.half_slope = times(o.x, d.x) * Interval(w.x) + times(o.y, d.y) * Interval(w.y) +
                    times(o.z, d.z) * Interval(w.z);
  form.discriminant = squared(form.half_slope) -
                      (fixed ? form.value * form.curvature.c : form.curvature * form.value.c);
  form.along = o.z;
  if (quadric.form == CsgQuadric::Form::cylinder) add_tangents(form, o, d, frame);
  return form;
}

// Origin fixed: direction · ((a - o) × (b - o)). Direction fixed: the same for the point origin / weight, times weight:
// weight d·(a × b) + origin · ((a - b) × d).
Linear make_side(const ViewFrame& frame, const BeamShape::Edge& edge) {
  const Vec3i a = to_intervals(edge.a), b = to_intervals(edge.b);
  const auto dot_linear = [](const LinearVec& v, const Vec3i& n) {
    return v.x * n.x + v.y * n.y + v.z * n.z;
  };
  if (frame.kind == BeamKind::parallel) {
    const Vec3i d{frame.direction.x.c, frame.direction.y.c, frame.direction.z.c};
    return frame.weight * dot(d, cross(a, b)) + dot_linear(frame.origin, cross(a - b, d));
  }
  const Vec3i o{frame.origin.x.c, frame.origin.y.c, frame.origin.z.c};
  return dot_linear(frame.direction, cross(a - o, b - o));
}

ViewFrame make_eye_frame(const EyeRays& eye, const BeamSolid& solid) {
  const Affine3d& m = solid.object_from_world;
  ViewFrame frame;
  const Vec3i origin =
      map_vector(m.linear, to_intervals(eye.position)) + to_intervals(m.translation);
  frame.origin = make_linear(origin, Vec3i(0), Vec3i(0));
  frame.direction = make_linear(map_vector(m.linear, to_intervals(eye.corner)),
                                map_vector(m.linear, to_intervals(eye.step_x)),
                                map_vector(m.linear, to_intervals(eye.step_y)));
  return frame;
}

// a: -ha / sa, b: -hb / sb; their difference times sa sb.
Quadratic plane_before_plane(const PlaneForm& a, const PlaneForm& b, BeamKind kind) {
  if (kind == BeamKind::parallel)
    return Quadratic(scaled(b.height, a.slope) - scaled(a.height, b.slope));
  return Quadratic(scaled(a.slope, b.height) - scaled(b.slope, a.height));
}

// value + 2 t half_slope + t² curvature at t = -h / s, times s².
Quadratic quadric_at_plane(const QuadricForm& q, const PlaneForm& p, BeamKind kind) {
  if (kind == BeamKind::parallel) {
    const Interval s = p.slope.c;
    return q.value * square(s) - (p.height * q.half_slope) * (Interval(2) * s) +
           squared(p.height) * q.curvature.c;
  }
  const Interval h = p.height.c;
  return squared(p.slope) * q.value.c - (p.slope * q.half_slope) * (Interval(2) * h) +
         q.curvature * square(h);
}

// -h / s + half_slope / curvature, times s · curvature.
Quadratic plane_beyond_middle(const QuadricForm& q, const PlaneForm& p, BeamKind kind) {
  if (kind == BeamKind::parallel) {
    return Quadratic(q.half_slope * p.slope.c - p.height * q.curvature.c);
  }
  return p.slope * q.half_slope - q.curvature * p.height.c;
}

namespace {

// A point of the lit plane is (origin · weight + direction · far) / weight, where weight = |slope|, far = |height| of
// the lit plane in the eye's view: both polynomials of first degree, the second one constant.
struct LitPoints {
  Linear weight;
  Interval far;
};

LitPoints make_lit_points(const PlaneForm& lit) {
  const bool above = lit.height.c.lo > 0;
  return above ? LitPoints{-lit.slope, lit.height.c} : LitPoints{lit.slope, -lit.height.c};
}

// In the space of the solid. Precondition: `lit` seen from the eye.
ViewFrame make_light_frame(const EyeRays& eye, const BeamSolid& solid, const LitPoints& lit,
                           const LightPlace& light, double reach) {
  const ViewFrame seen = make_eye_frame(eye, solid);
  const Vec3i eye_at{seen.origin.x.c, seen.origin.y.c, seen.origin.z.c};
  const auto lit_axis = [&](Interval origin, const Linear& direction) {
    return lit.weight * origin + direction * lit.far;
  };
  const LinearVec point{lit_axis(eye_at.x, seen.direction.x), lit_axis(eye_at.y, seen.direction.y),
                        lit_axis(eye_at.z, seen.direction.z)};
  const Affine3d& m = solid.object_from_world;
  ViewFrame frame;
  if (light.is_directional) {
    const Vec3d travels = light.direction * (1 / length(light.direction));
    const Vec3i d = map_vector(m.linear, to_intervals(travels));
    const Interval back(-reach);
    frame.direction = make_linear(d, Vec3i(0), Vec3i(0));
    frame.origin = {point.x + lit.weight * (d.x * back), point.y + lit.weight * (d.y * back),
                    point.z + lit.weight * (d.z * back)};
    frame.weight = lit.weight;
    frame.kind = BeamKind::parallel;
    return frame;
  }
  const Vec3i at = map_vector(m.linear, to_intervals(light.position)) + to_intervals(m.translation);
  frame.origin = make_linear(at, Vec3i(0), Vec3i(0));
  frame.direction = {point.x - lit.weight * at.x, point.y - lit.weight * at.y,
                     point.z - lit.weight * at.z};
  return frame;
}

// Picture point (x, y) and depth of a world point: linear · (p - position) = (x, y, 1) · depth.
Mat3d make_picture_map(const EyeRays& eye) {
  return inverse(Mat3d{eye.step_x, eye.step_y, eye.corner});
}

// a bᵀ
Mat3d outer(Vec3d a, Vec3d b) {
  return {a * b.x, a * b.y, a * b.z};
}
Mat3d scaled(const Mat3d& m, double s) {
  return {m.x * s, m.y * s, m.z * s};
}
Mat3d sum(const Mat3d& a, const Mat3d& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

struct HomogeneousMap {
  Mat3d linear;
  Vec3d offset;
};

// Weight · (shadow on the plane - eye) in the picture, linear in the point that casts it. Weights are positive between
// the light and the plane.
HomogeneousMap make_shadow_map(const EyeRays& eye, Vec3d normal, double d,
                               const LightPlace& light) {
  const Mat3d picture = make_picture_map(eye);
  if (light.is_directional) {
    // s = p + direction (d - n·p) / (n·direction)
    const double slope = dot(normal, light.direction);
    const double sign = slope < 0 ? -1 : 1;
    const Mat3d one{};
    const Mat3d linear = sum(scaled(one, slope), scaled(outer(light.direction, normal), -1));
    const Vec3d offset = light.direction * d - eye.position * slope;
    return {scaled(picture * linear, sign), picture * offset * sign};
  }
  // s = l + (p - l) (d - n·l) / (n·(p - l))
  const Vec3d l = light.position;
  const double across = d - dot(normal, l), sign = across < 0 ? -1 : 1;
  const Mat3d linear = sum(outer(l - eye.position, normal), scaled(Mat3d{}, across));
  return {scaled(picture * linear, sign), picture * (-(linear * l)) * sign};
}

}  // namespace

// Boxes and maps are rounded: their outlines give way by this part of a coordinate, and this part of a pixel.
constexpr double kWindowMargin = 1e-7;

LeafWindow BeamView::make_window(std::uint32_t solid, std::uint32_t leaf) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const LeafWindow everywhere{-kInfinity, -kInfinity, kInfinity, kInfinity};
  if (leaf == kStartLeaf) return everywhere;
  const Box3d& box = shape(solid).leaf_box(leaf);
  if (!is_finite(box.low) || !is_finite(box.high)) return everywhere;
  if (bundle_) return make_bundle_window(solid, box);
  const Projection& map = projections_[solid];
  LeafWindow window{kInfinity, kInfinity, -kInfinity, -kInfinity, kInfinity, 0};
  for (int i = 0; i < 8; ++i) {
    const Vec3d p{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                  (i & 4) != 0 ? box.high.z : box.low.z};
    const Vec3d q = map.linear * p + map.offset;
    const Vec3d size = {length(map.linear.x), length(map.linear.y), length(map.linear.z)};
    const double scale = std::abs(map.offset.z) + length(size) * length(p);
    if (!(q.z > kWindowMargin * scale)) return everywhere;
    const double x = q.x / q.z, y = q.y / q.z;
    const double slack = kWindowMargin * (1 + std::abs(x) + std::abs(y)) * (1 + scale / q.z * 1e-6);
    window = {std::min(window.x0, x - slack),
              std::min(window.y0, y - slack),
              std::max(window.x1, x + slack),
              std::max(window.y1, y + slack),
              std::min(window.near, q.z - kWindowMargin * scale),
              std::max(window.far, q.z + kWindowMargin * scale)};
  }
  if (!is_eye_) {
    window.near = 0;
    window.far = kInfinity;
  }
  return window;
}

LeafWindow BeamView::make_bundle_window(std::uint32_t solid, const Box3d& box) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const RayBundle& own = bundle_in(solid);
  const std::optional<Interval> depths =
      depths_in(box, ranges_of(own.origin), ranges_of(own.direction), kInfinity);
  if (!depths) return {kInfinity, kInfinity, -kInfinity, -kInfinity};
  return {-kInfinity, -kInfinity, kInfinity, kInfinity, depths->lo, depths->hi};
}

Cover BeamView::start_in_volume(std::uint32_t solid, std::uint32_t leaf) const {
  const ClosedMesh& volume = *shape(solid).volume(leaf);
  if (bundle_) return volume.cover(bundle_cell(solid, {0, 0}));
  const bool inside =
      apex_ && volume.contains(transform_point(solids_[solid].object_from_world, *apex_));
  return inside ? Cover::in : Cover::out;
}

// Of the corners' triple product as the origin sees them, which has the sign that all sides have where a ray meets it.
int BeamView::make_facet_turn(std::uint32_t solid, std::uint32_t leaf) const {
  const Facet& facet = *shape(solid).facet(leaf);
  const std::vector<BeamShape::Edge>& edges = shape(solid).edges();
  const auto corner = [&](std::size_t k) {
    const BeamShape::Edge& e = edges[facet.edges[k]];
    return to_intervals(facet.turned[k] ? e.b : e.a);
  };
  const Vec3i a = corner(0), b = corner(1), c = corner(2);
  const ViewFrame& frame = frames_[solid];
  Interval turn;
  if (frame.kind == BeamKind::parallel) {
    const LinearVec& d = frame.direction;
    turn = dot(Vec3i{d.x.c, d.y.c, d.z.c}, cross(b - a, c - a));
  } else {
    const Vec3i o{frame.origin.x.c, frame.origin.y.c, frame.origin.z.c};
    turn = dot(a - o, cross(b - o, c - o));
  }
  return turn.lo > 0 ? 1 : turn.hi < 0 ? -1 : 0;
}

// What is not linear, and what depth changes in it, goes into the centre.
SpaceCell BeamView::bundle_cell(std::uint32_t solid, Interval depths) const {
  const RayBundle& own = bundle_in(solid);
  const Interval z = (Interval(depths.lo) + Interval(depths.hi)) * Interval(0.5);
  const Interval reach = (Interval(depths.hi) - Interval(depths.lo)) * Interval(0.5);
  SpaceCell cell;
  for (int k = 0; k < 3; ++k) {
    const TaylorModel o = own.origin[k], d = own.direction[k];
    const Quadratic from(o), along(d);
    const Quadratic rest{0,
                         0,
                         0,
                         from.xx + along.xx * depths,
                         from.xy + along.xy * depths,
                         from.yy + along.yy * depths};
    cell.center[k] = from.c + along.c * z + range_over(rest, kUnitSquare);
    cell.half[0][k] = from.x + along.x * depths;
    cell.half[1][k] = from.y + along.y * depths;
    cell.half[2][k] = along.c * reach;
  }
  return cell;
}

SpaceCell BeamView::cell(std::uint32_t solid, const Rect& rect, Interval depths) const {
  if (bundle_) return bundle_cell(solid, depths);
  const ViewFrame& frame = frames_[solid];
  const Interval x = Interval(rect.x0) * Interval(0.5) + Interval(rect.x1) * Interval(0.5);
  const Interval y = Interval(rect.y0) * Interval(0.5) + Interval(rect.y1) * Interval(0.5);
  const auto half = [](double low, double high) {
    return (Interval(high) - Interval(low)) * Interval(0.5);
  };
  const auto at = [&](const Linear& p) { return p.c + p.x * x + p.y * y; };
  const Vec3i origin{frame.origin.x.c, frame.origin.y.c, frame.origin.z.c};
  const LinearVec& d = frame.direction;
  const Vec3i middle{at(d.x), at(d.y), at(d.z)};
  const auto scaled = [](const Vec3i& v, Interval s) { return Vec3i{v.x * s, v.y * s, v.z * s}; };
  const Interval z = (Interval(depths.lo) + Interval(depths.hi)) * Interval(0.5);
  const Interval far(depths.hi);
  return {origin + scaled(middle, z),
          {scaled({d.x.x, d.y.x, d.z.x}, far * half(rect.x0, rect.x1)),
           scaled({d.x.y, d.y.y, d.z.y}, far * half(rect.y0, rect.y1)),
           scaled(middle, half(depths.lo, depths.hi))}};
}

const RayBundle& BeamView::bundle_in(std::uint32_t solid) const {
  const auto known = asked_bundles_.find(solid);
  if (known != asked_bundles_.end()) return known->second;
  return asked_bundles_.emplace(solid, map_bundle(solids_[solid].object_from_world, *bundle_))
      .first->second;
}

const BundlePlane& BeamView::bundle_plane(std::uint32_t solid, std::uint32_t index) const {
  const std::uint64_t key = std::uint64_t(solid) << 32U | index;
  const auto known = asked_bundle_planes_.find(key);
  if (known != asked_bundle_planes_.end()) return known->second;
  BundlePlane form = make_form(bundle_in(solid), shape(solid).planes()[index]);
  if (starts_on({solid, index, BeamSurface::Root::none})) form.height = {};
  return asked_bundle_planes_.emplace(key, form).first->second;
}

const BundleQuadric& BeamView::bundle_quadric(std::uint32_t solid, std::uint32_t index) const {
  const std::uint64_t key = std::uint64_t(solid) << 32U | index;
  const auto known = asked_bundle_quadrics_.find(key);
  if (known != asked_bundle_quadrics_.end()) return known->second;
  BundleQuadric form = make_form(bundle_in(solid), shape(solid).quadrics()[index]);
  if (starts_on({solid, index, BeamSurface::Root::nearer})) {
    form.value = {};
    form.discriminant = squared(form.half_slope);
  }
  return asked_bundle_quadrics_.emplace(key, form).first->second;
}

const PlaneForm& BeamView::remembered_plane(std::uint32_t solid, std::uint32_t index) const {
  const std::uint64_t key = std::uint64_t(solid) << 32U | index;
  const auto known = asked_planes_.find(key);
  if (known != asked_planes_.end()) return known->second;
  const CsgPlane& plane = shape(solid).planes()[index];
  return asked_planes_.emplace(key, make_form(frames_[solid], plane)).first->second;
}

const Linear& BeamView::remembered_side(std::uint32_t solid, std::uint32_t edge) const {
  const std::uint64_t key = std::uint64_t(solid) << 32U | edge;
  const auto known = asked_sides_.find(key);
  if (known != asked_sides_.end()) return known->second;
  const BeamShape::Edge& ends = shape(solid).edges()[edge];
  return asked_sides_.emplace(key, make_side(frames_[solid], ends)).first->second;
}

const QuadricForm& BeamView::remembered_quadric(std::uint32_t solid, std::uint32_t index) const {
  const std::uint64_t key = std::uint64_t(solid) << 32U | index;
  const auto known = asked_quadrics_.find(key);
  if (known != asked_quadrics_.end()) return known->second;
  const CsgQuadric& quadric = shape(solid).quadrics()[index];
  return asked_quadrics_.emplace(key, make_form(frames_[solid], quadric)).first->second;
}

BeamView::BeamView(std::span<const BeamSolid> solids, const EyeRays& eye)
    : solids_(solids), is_eye_(true), apex_(eye.position) {
  const Mat3d picture = make_picture_map(eye);
  for (const BeamSolid& solid : solids) {
    const ViewFrame frame = make_eye_frame(eye, solid);
    std::vector<PlaneForm>& planes = planes_.emplace_back();
    for (const CsgPlane& plane : solid.shape->planes()) {
      planes.push_back(make_form(frame, plane));
    }
    std::vector<QuadricForm>& quadrics = quadrics_.emplace_back();
    std::vector<Linear>& sides = sides_.emplace_back();
    for (const BeamShape::Edge& edge : solid.shape->edges()) {
      sides.push_back(make_side(frame, edge));
    }
    for (const CsgQuadric& quadric : solid.shape->quadrics()) {
      quadrics.push_back(make_form(frame, quadric));
    }
    frames_.push_back(frame);
    const Affine3d world_from_object = inverse(solid.object_from_world);
    projections_.push_back({picture * world_from_object.linear,
                            picture * (world_from_object.translation - eye.position)});
  }
  std::vector<std::vector<LeafWindow>> windows;
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    std::vector<LeafWindow>& of_solid = windows.emplace_back(shape(i).leaf_count());
    for (const std::uint32_t leaf : shape(i).root().leaves()) {
      of_solid[leaf] = make_window(i, leaf);
    }
  }
  windows_ = std::move(windows);
  std::vector<std::vector<std::int8_t>> turns;
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    std::vector<std::int8_t>& of_solid = turns.emplace_back(shape(i).leaf_count());
    for (std::uint32_t leaf = 0; leaf < of_solid.size(); ++leaf) {
      if (shape(i).facet(leaf) != nullptr) of_solid[leaf] = std::int8_t(make_facet_turn(i, leaf));
    }
  }
  turns_ = std::move(turns);
}

BeamView::BeamView(std::span<const BeamSolid> solids, const RayBundle& bundle)
    : solids_(solids), bundle_(bundle) {}

BeamView::BeamView(std::span<const BeamSolid> solids, const EyeRays& eye, LitPlane mirror)
    : solids_(solids), is_eye_(true), mirror_(mirror), apex_(eye.position) {
  const Mat3d picture = make_picture_map(eye);
  for (const BeamSolid& solid : solids) {
    frames_.push_back(make_eye_frame(eye, solid));
    const Affine3d world_from_object = inverse(solid.object_from_world);
    projections_.push_back({picture * world_from_object.linear,
                            picture * (world_from_object.translation - eye.position)});
  }
}

BeamView::BeamView(std::span<const BeamSolid> solids, const EyeRays& eye, LitPlane lit,
                   const LightPlace& light, double reach)
    : solids_(solids) {
  if (!light.is_directional) apex_ = light.position;
  const BeamSolid& of = solids[lit.solid];
  const CsgPlane& lit_plane = of.shape->planes()[lit.plane];
  const PlaneForm plane = make_form(make_eye_frame(eye, of), lit_plane);
  const LitPoints points = make_lit_points(plane);
  // The plane in the world: its normal goes with the transpose of the map into the solid's space.
  const Vec3d normal = transpose(of.object_from_world.linear) * lit_plane.normal;
  const double d = lit_plane.d - dot(lit_plane.normal, of.object_from_world.translation);
  const HomogeneousMap shadow = make_shadow_map(eye, normal, d, light);
  for (const BeamSolid& solid : solids) {
    frames_.push_back(make_light_frame(eye, solid, points, light, reach));
    const Affine3d world_from_object = inverse(solid.object_from_world);
    projections_.push_back({shadow.linear * world_from_object.linear,
                            shadow.linear * world_from_object.translation + shadow.offset});
  }
}

}  // namespace arris
