#include "beam/leaf_span.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Of = SignKey::Of;
using Root = BeamSurface::Root;

SignKey key_of(Of of, const BeamSurface& s) {
  return {of, s.solid, s.index, 0, 0};
}

// numerator / denominator for positive numbers of which the ends may be 0 or infinite.
double quotient_low(double numerator, double denominator) {
  if (numerator <= 0 || denominator == kInfinity) return 0;
  return denominator > 0 ? std::max(0.0, next_down(numerator / denominator)) : kInfinity;
}
double quotient_high(double numerator, double denominator) {
  return denominator > 0 && numerator < kInfinity ? next_up(numerator / denominator) : kInfinity;
}
Interval quotient(Interval numerator, Interval denominator) {
  return {quotient_low(numerator.lo, denominator.hi), quotient_high(numerator.hi, denominator.lo)};
}

class SpanMaker {
 public:
  SpanMaker(const BeamView& view, LeafPlace place, double depth_end, const SignOracle& oracle)
      : view_(view), place_(place), depth_end_(depth_end), oracle_(oracle) {}

  std::optional<LeafSpan> make() {
    if (place_.leaf == kStartLeaf) return make_plane_span(view_, view_.mirror(), oracle_.rect());
    const BeamShape& shape = view_.shape(place_.solid);
    if (const Facet* facet = shape.facet(place_.leaf)) return make_facet(*facet);
    if (shape.volume(place_.leaf) != nullptr) return make_volume();
    if (shape.is_whole(place_.leaf)) return make_whole();
    const ConvexLeaf& leaf = *shape.convex(place_.leaf);
    span_.starts_inside = true;
    for (std::uint32_t i = 0; i < leaf.planes.size(); ++i) {
      if (!add_plane(leaf.planes[i], i)) return std::nullopt;
    }
    if (leaf.quadric && !add_quadric(*leaf.quadric, std::uint32_t(leaf.planes.size()))) {
      return std::nullopt;
    }
    return finish();
  }

 private:
  // Met by rays that pass all edges on the side that the corners' turn tells; entered for good.
  std::optional<LeafSpan> make_facet(const Facet& facet) {
    const Sign wanted = Sign(view_.facet_turn(place_.solid, place_.leaf));
    if (wanted == Sign::unknown) return std::nullopt;  // it is seen as a line
    bool within = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const BeamSurface edge{place_.solid, facet.edges[k], Root::none};
      const Sign side = oracle_.find(key_of(Of::side, edge), view_.side(place_.solid, edge.index));
      const Sign own = facet.turned[k] ? -side : side;
      if (own == -wanted) return std::nullopt;
      within = within && own == wanted;
    }
    const PlaneForm& form = view_.plane(place_.solid, facet.plane.plane);
    span_.enter = quotient(absolute(range_over(form.height, oracle_.rect())),
                           absolute(range_over(form.slope, oracle_.rect())));
    if (!(span_.enter.lo <= depth_end_)) return std::nullopt;
    span_.leave = {kInfinity, kInfinity};
    span_.entering.push_back({span_.enter, {place_.solid, facet.plane.plane, Root::none}, 0});
    span_.facet_positive = wanted == Sign::positive;
    span_.certain = within && span_.enter.hi < kInfinity;
    return std::move(span_);
  }
  std::optional<LeafSpan> make_volume() {
    if (!view_.starts_in_volume(place_.solid, place_.leaf)) return std::nullopt;
    span_.starts_inside = span_.certain = true;
    span_.leave = {kInfinity, kInfinity};
    return std::move(span_);
  }

  // Of a leaf that is not convex: slices of the beam, from the front.
  std::optional<LeafSpan> make_whole() {
    const LeafWindow window = view_.window(place_.solid, place_.leaf);
    span_.enter = span_.leave = {window.near, window.far};
    if (window.far < kInfinity && window.near > 0 && !bound_whole()) return std::nullopt;
    if (!(span_.enter.lo <= depth_end_)) return std::nullopt;
    const BeamSurface surface{place_.solid, place_.leaf, Root::whole};
    span_.entering.push_back({span_.enter, surface, kAnyFace});
    span_.leaving.push_back({span_.leave, surface, kAnyFace});
    return std::move(span_);
  }
  // What slices of [near, far] tell, in their order.
  struct Slices {
    std::optional<double> first_on, first_in;  // where the first begin that are not outside, inside
    double in_end = 0, last_on = 0;            // where the inside ones end that come first; where the last end
  };
  [[nodiscard]] Slices slice(Interval range) const {
    constexpr int kSlices = 16;
    const CsgSolid& solid = view_.shape(place_.solid).csg();
    const auto depth = [&](int i) { return range.lo + (range.hi - range.lo) * (double(i) / kSlices); };
    Slices found;
    for (int i = 0; i < kSlices; ++i) {
      const Interval d{depth(i), i + 1 < kSlices ? depth(i + 1) : range.hi};
      const Cover cover = solid.cover_of(place_.leaf, view_.cell(place_.solid, oracle_.rect(), d));
      if (cover == Cover::out) continue;
      if (!found.first_on) found.first_on = d.lo;
      found.last_on = d.hi;
      if (cover != Cover::in) continue;
      if (!found.first_in) found.first_in = found.in_end = d.lo;
      if (found.in_end == d.lo) found.in_end = d.hi;
    }
    return found;
  }
  // False: all slices are outside. Finer ones follow until they are about as deep as the beam is wide.
  bool bound_whole() {
    const Slices all = slice(span_.enter);
    if (!all.first_on) return false;
    span_.certain = all.first_in.has_value();
    span_.enter = {*all.first_on, all.first_in.value_or(all.last_on)};
    span_.leave = {all.first_in ? all.in_end : *all.first_on, all.last_on};
    if (!span_.certain) return true;
    const SpaceCell cell = view_.cell(place_.solid, oracle_.rect(), span_.enter);
    const double width = absolute(dot(cell.half[0], cell.half[0])).hi;
    const double depth = absolute(dot(cell.half[2], cell.half[2])).hi;
    double ratio = std::sqrt(depth / width);
    for (; ratio > 2 && span_.enter.hi > span_.enter.lo; ratio /= 16) {
      const Slices closer = slice(span_.enter);
      if (!closer.first_on) break;
      // What is inside here may end before what was known to be inside begins.
      if (closer.first_in && closer.in_end < span_.enter.hi) span_.leave.lo = closer.in_end;
      span_.enter = {*closer.first_on, closer.first_in.value_or(span_.enter.hi)};
    }
    return true;
  }

  // False: every ray misses.
  bool add_plane(PlaneRef ref, std::uint32_t face) {
    const PlaneForm& form = view_.plane(place_.solid, ref.plane);
    const BeamSurface surface{place_.solid, ref.plane, Root::none};
    Sign height = oracle_.find(key_of(Of::height, surface), form.height);
    Interval slopes = range_over(form.slope, oracle_.rect());
    const Sign slope = oracle_.find(key_of(Of::slope, surface), form.slope);
    if (slope == Sign::positive) slopes.lo = std::max(slopes.lo, 0.0);
    if (slope == Sign::negative) slopes.hi = std::min(slopes.hi, 0.0);
    if (ref.flipped) {
      height = -height;
      slopes = -slopes;
    }
    if (height == Sign::unknown && !view_.direction_fixed()) {
      // The eye is in the plane: rays are on one side of it, for good.
      if (slopes.lo >= 0) return false;
      span_.start_open = span_.start_open || slopes.hi > 0;
      return true;
    }
    if (height == Sign::unknown) {
      span_.start_open = true;
      return true;
    }
    const Interval distance = absolute(range_over(form.height, oracle_.rect()));
    if (height == Sign::negative) {
      if (slopes.hi <= 0) return true;
      const Interval depth = quotient(distance, {std::max(slopes.lo, 0.0), slopes.hi});
      if (depth.lo <= depth_end_) span_.leaving.push_back({depth, surface, face});
      return true;
    }
    span_.starts_inside = false;
    if (slopes.lo >= 0) return false;
    const Interval depth = quotient(distance, {std::max(-slopes.hi, 0.0), -slopes.lo});
    span_.entering.push_back({depth, surface, face});
    return depth.lo <= depth_end_;
  }

  // The half of a double cone that the leaf is in: the sign of z in the cone's own frame.
  [[nodiscard]] Sign half_of(const CsgQuadric& quadric) const {
    const Box3d& box = view_.shape(place_.solid).leaf_box(place_.leaf);
    const Vec3d middle = transform_point(quadric.unit_from_object, (box.low + box.high) * 0.5);
    return middle.z > 0 ? Sign::positive : Sign::negative;
  }

  bool add_quadric(std::uint32_t index, std::uint32_t face) {
    const CsgQuadric& quadric = view_.shape(place_.solid).quadrics()[index];
    const QuadricForm& form = view_.quadric(place_.solid, index);
    BeamSurface surface{place_.solid, index, Root::nearer};
    span_.quadric = surface;
    const Sign value = oracle_.find(key_of(Of::value, surface), form.value);
    if (value == Sign::unknown) {
      span_.start_open = true;
      return true;
    }
    const bool is_cone = quadric.form == CsgQuadric::Form::cone;
    const Bounds b = bounds_of(form, surface, is_cone);
    if (value == Sign::positive) {
      span_.starts_inside = false;
      return add_from_outside(b, surface, face);
    }
    if (is_cone) {
      const Sign along = oracle_.find(key_of(Of::along, surface), form.along);
      if (along == Sign::unknown) {
        span_.start_open = true;
        return true;
      }
      if (along != half_of(quadric)) return add_from_other_half(b, surface, face);
    }
    // -value / (half_slope + root): the root that follows, where nothing cancels.
    surface.root = Root::leaving;
    span_.quadric.reset();
    const Interval sum = b.half_slope + b.root;
    Interval depth = quotient(absolute(b.value), {std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)});
    if (is_cone && b.curvature.lo <= 0) depth.hi = kInfinity;
    if (depth.lo <= depth_end_) span_.leaving.push_back({depth, surface, face});
    return true;
  }

  struct Bounds {
    Interval value, half_slope, curvature, discriminant, root;
    Sign tangents = Sign::unknown;  // positive: within both; negative: outside one
  };
  [[nodiscard]] Bounds bounds_of(const QuadricForm& form, const BeamSurface& s,
                                 bool is_cone) const {
    const Rect& rect = oracle_.rect();
    const bool fixed = view_.direction_fixed();
    Bounds b;
    b.value = fixed ? range_over(form.value, rect) : form.value.c;
    b.half_slope = range_over(form.half_slope, rect);
    b.curvature = fixed ? form.curvature.c : range_over(form.curvature, rect);
    b.discriminant = range_over(form.discriminant, rect);
    const auto clip = [&](Interval& range, Of of, const auto& polynomial) {
      const Sign sign = oracle_.find(key_of(of, s), polynomial);
      if (sign == Sign::positive) range.lo = std::max(range.lo, 0.0);
      if (sign == Sign::negative) range.hi = std::min(range.hi, 0.0);
    };
    clip(b.half_slope, Of::half_slope, form.half_slope);
    clip(b.curvature, Of::curvature, form.curvature);
    clip(b.discriminant, Of::discriminant, form.discriminant);
    if (!is_cone) b.curvature.lo = std::max(b.curvature.lo, 0.0);
    if (form.has_tangents) {
      const Sign low = oracle_.find(key_of(Of::tangent_low, s), form.tangents[0]);
      const Sign high = oracle_.find(key_of(Of::tangent_high, s), form.tangents[1]);
      if (low == Sign::negative || high == Sign::negative) b.tangents = Sign::negative;
      if (low == Sign::positive && high == Sign::positive) {
        b.tangents = Sign::positive;
        b.discriminant.lo = std::max(b.discriminant.lo, 0.0);
        if (!fixed) b.half_slope.hi = std::min(b.half_slope.hi, 0.0);
      }
    }
    b.root = square_root(b.discriminant);
    return b;
  }

  bool add_from_outside(const Bounds& b, BeamSurface surface, std::uint32_t face) {
    const bool bends_out =
        b.curvature.lo < 0;  // some rays may run into a cone that opens before them
    if (!bends_out && (b.discriminant.hi <= 0 || b.half_slope.lo >= 0)) return false;
    if (b.tangents == Sign::negative) return false;
    const Interval sum = b.root - b.half_slope;
    const Interval depth = quotient(b.value, {std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)});
    if (!(depth.lo <= depth_end_)) return false;
    span_.entering.push_back({depth, surface, face});
    if (b.curvature.hi > 0) {
      surface.root = Root::farther;
      Interval far = quotient({std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)},
                              {std::max(b.curvature.lo, 0.0), b.curvature.hi});
      far.lo = std::max(far.lo, depth.lo);
      span_.leaving.push_back({far, surface, face});
    }
    const bool crosses = b.tangents == Sign::positive || b.discriminant.lo > 0;
    const bool ahead =
        b.half_slope.hi < 0 || (b.tangents == Sign::positive && !view_.direction_fixed());
    needs_quadric_ = !(b.curvature.hi < 0 || (crosses && ahead));
    return true;
  }

  // (half_slope + root) / -curvature
  bool add_from_other_half(const Bounds& b, BeamSurface surface, std::uint32_t face) {
    span_.starts_inside = false;
    if (b.curvature.lo >= 0 || b.half_slope.hi <= 0) return false;
    const Interval sum = b.half_slope + b.root;
    const Interval depth = quotient({std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)},
                                    {std::max(-b.curvature.hi, 0.0), -b.curvature.lo});
    if (!(depth.lo <= depth_end_)) return false;
    surface.root = Root::other_half;
    span_.quadric = surface;
    span_.entering.push_back({depth, surface, face});
    needs_quadric_ = !(b.curvature.hi < 0 && b.half_slope.lo > 0);
    return true;
  }

  std::optional<LeafSpan> finish() {
    span_.enter = {0, 0};
    span_.leave = {kInfinity, kInfinity};
    for (const SpanEnd& e : span_.entering) {
      span_.enter = {std::max(span_.enter.lo, e.depth.lo), std::max(span_.enter.hi, e.depth.hi)};
    }
    for (const SpanEnd& e : span_.leaving) {
      span_.leave = {std::min(span_.leave.lo, e.depth.lo), std::min(span_.leave.hi, e.depth.hi)};
    }
    if (span_.start_open) {
      span_.starts_inside = false;
      span_.enter.lo = 0;
    }
    if (span_.enter.lo > span_.leave.hi || span_.enter.lo > depth_end_) return std::nullopt;
    std::erase_if(span_.entering, [&](const SpanEnd& e) { return e.depth.hi < span_.enter.lo; });
    std::erase_if(span_.leaving, [&](const SpanEnd& e) { return e.depth.lo > span_.leave.hi; });
    span_.certain = !span_.start_open && !needs_quadric_ &&
                    (span_.starts_inside || span_.enter.hi < span_.leave.lo);
    if (!needs_quadric_) span_.quadric.reset();
    return std::move(span_);
  }

  const BeamView& view_;
  LeafPlace place_;
  double depth_end_;
  const SignOracle& oracle_;
  LeafSpan span_;
  bool needs_quadric_ = false;
};

// A plane behind the ray, or that it runs along, is never met; its depth is then said to be infinite.
Met plane_met(const BeamView& view, const SpanEnd& end, SignOracle& oracle) {
  const PlaneForm& form = view.plane(end.surface.solid, end.surface.index);
  const Sign height = oracle.ask(key_of(Of::height, end.surface), form.height);
  const Sign slope = oracle.ask(key_of(Of::slope, end.surface), form.slope);
  if (height * slope == Sign::unknown) return Met::unknown;
  return height * slope == Sign::negative ? Met::yes : Met::no;
}

Order order_of_sign(Sign difference) {
  return difference == Sign::unknown    ? Order::unknown
         : difference == Sign::negative ? Order::before
                                        : Order::after;
}

Order reversed(Order order) {
  return order == Order::before ? Order::after : order == Order::after ? Order::before : order;
}

Order order_of_planes(const BeamView& view, const SpanEnd& a, const SpanEnd& b,
                      SignOracle& oracle) {
  const PlaneForm& p = view.plane(a.surface.solid, a.surface.index);
  const PlaneForm& q = view.plane(b.surface.solid, b.surface.index);
  const Sign slopes = oracle.ask(key_of(Of::slope, a.surface), p.slope) *
                      oracle.ask(key_of(Of::slope, b.surface), q.slope);
  if (slopes == Sign::unknown) return Order::unknown;
  const SignKey key{Of::plane_plane, a.surface.solid, a.surface.index, b.surface.solid,
                    b.surface.index};
  return order_of_sign(slopes * oracle.ask(key, plane_before_plane(p, q, view.direction_fixed())));
}

// The plane against the middle between the roots.
Order order_to_middle(const BeamView& view, const SpanEnd& plane, const SpanEnd& root,
                      SignOracle& oracle) {
  const PlaneForm& p = view.plane(plane.surface.solid, plane.surface.index);
  const QuadricForm& q = view.quadric(root.surface.solid, root.surface.index);
  const Interval middle =
      -range_over(q.half_slope, oracle.rect()) / range_over(q.curvature, oracle.rect());
  if (plane.depth.hi < middle.lo) return Order::before;
  if (plane.depth.lo > middle.hi) return Order::after;
  const Sign scale = oracle.ask(key_of(Of::slope, plane.surface), p.slope) *
                     oracle.ask(key_of(Of::curvature, root.surface), q.curvature);
  if (scale == Sign::unknown) return Order::unknown;
  const SignKey key{Of::plane_middle, plane.surface.solid, plane.surface.index, root.surface.solid,
                    root.surface.index};
  return order_of_sign(scale * oracle.ask(key, plane_beyond_middle(q, p, view.direction_fixed())));
}

// By whether the point on the plane is inside the quadric; where that leaves two ways, by the middle.
Order order_of_plane_and_root(const BeamView& view, const SpanEnd& plane, const SpanEnd& root,
                              SignOracle& oracle) {
  const CsgQuadric& quadric =
      view.shape(root.surface.solid).quadrics()[root.surface.index];
  const QuadricForm& q = view.quadric(root.surface.solid, root.surface.index);
  const PlaneForm& p = view.plane(plane.surface.solid, plane.surface.index);
  const SignKey key{Of::plane_quadric, plane.surface.solid, plane.surface.index, root.surface.solid,
                    root.surface.index};
  const Sign at_plane = oracle.ask(key, quadric_at_plane(q, p, view.direction_fixed()));
  if (at_plane == Sign::unknown) return Order::unknown;
  const bool inside = at_plane == Sign::negative;
  // Round quadrics lie between their roots; a cone does where the curvature is positive.
  Sign curvature = Sign::positive;
  if (quadric.form == CsgQuadric::Form::cone) {
    curvature = oracle.ask(key_of(Of::curvature, root.surface), q.curvature);
    if (curvature == Sign::unknown) return Order::unknown;
  }
  const bool between = curvature == Sign::positive;
  switch (root.surface.root) {
    case Root::nearer:
      if (inside) return Order::after;
      return between ? order_to_middle(view, plane, root, oracle) : Order::before;
    case Root::farther:
      if (inside || !between) return Order::before;
      return order_to_middle(view, plane, root, oracle);
    case Root::leaving: {
      if (!inside) return Order::after;
      if (between) return Order::before;
      const Met leaves = decide_end_met(view, root, oracle);
      if (leaves == Met::unknown) return Order::unknown;
      return leaves == Met::no ? Order::before : order_to_middle(view, plane, root, oracle);
    }
    case Root::other_half:
      return inside ? order_to_middle(view, plane, root, oracle) : Order::before;
    case Root::none:
    case Root::whole:
      break;
  }
  return Order::unknown;
}

}  // namespace

LeafSpan make_plane_span(const BeamView& view, const LitPlane& plane, const Rect& rect) {
  const PlaneForm& form = view.plane(plane.solid, plane.plane);
  LeafSpan span;
  span.enter = quotient(absolute(range_over(form.height, rect)), absolute(range_over(form.slope, rect)));
  span.leave = {kInfinity, kInfinity};
  span.certain = true;
  span.entering.push_back({span.enter, {plane.solid, plane.plane, Root::none}, 0});
  return span;
}

std::optional<LeafSpan> make_span(const BeamView& view, LeafPlace place, double depth_end,
                                  const SignOracle& oracle) {
  return SpanMaker(view, place, depth_end, oracle).make();
}

Met decide_end_met(const BeamView& view, const SpanEnd& end, SignOracle& oracle) {
  if (end.depth.hi < kInfinity) return Met::yes;
  if (end.surface.is_whole()) return Met::unknown;
  if (end.surface.is_plane()) return plane_met(view, end, oracle);
  const CsgQuadric& quadric =
      view.shape(end.surface.solid).quadrics()[end.surface.index];
  const bool may_open = quadric.form == CsgQuadric::Form::cone &&
                        (end.surface.root == Root::farther || end.surface.root == Root::leaving);
  if (!may_open) return Met::yes;
  // A ray that runs into the opening of a cone leaves it if it comes from the apex's side, but for good.
  const QuadricForm& q = view.quadric(end.surface.solid, end.surface.index);
  const Sign curvature = oracle.ask(key_of(Of::curvature, end.surface), q.curvature);
  if (curvature == Sign::unknown) return Met::unknown;
  if (curvature == Sign::positive) return Met::yes;
  if (end.surface.root == Root::farther) return Met::no;
  const Sign half_slope = oracle.ask(key_of(Of::half_slope, end.surface), q.half_slope);
  if (half_slope == Sign::unknown) return Met::unknown;
  return half_slope == Sign::positive ? Met::yes : Met::no;
}

Order order_of(const BeamView& view, const SpanEnd& a, const SpanEnd& b, SignOracle& oracle) {
  if (a.surface == b.surface) return Order::same;
  if (a.depth.hi < b.depth.lo) return Order::before;
  if (a.depth.lo > b.depth.hi) return Order::after;
  if (a.surface.is_whole() || b.surface.is_whole()) return Order::unknown;
  for (const bool first : {true, false}) {
    const SpanEnd& end = first ? a : b;
    if (!end.surface.is_plane()) continue;
    const Met met = decide_end_met(view, end, oracle);
    if (met == Met::unknown) return Order::unknown;
    if (met == Met::no) return first ? Order::after : Order::before;
  }
  if (a.surface.is_plane() && b.surface.is_plane()) {
    // One polynomial for both ways round.
    const bool turned =
        std::pair(b.surface.solid, b.surface.index) < std::pair(a.surface.solid, a.surface.index);
    return turned ? reversed(order_of_planes(view, b, a, oracle))
                  : order_of_planes(view, a, b, oracle);
  }
  if (a.surface.is_plane()) return order_of_plane_and_root(view, a, b, oracle);
  if (b.surface.is_plane()) return reversed(order_of_plane_and_root(view, b, a, oracle));
  if (a.surface.solid == b.surface.solid && a.surface.index == b.surface.index) {
    return a.surface.root == Root::nearer ? Order::before : Order::after;
  }
  const auto rank = [](const SpanEnd& e) {
    return std::tuple(e.surface.solid, e.surface.index, e.surface.root);
  };
  const bool turned = rank(b) < rank(a);
  const BeamSurface &p = turned ? b.surface : a.surface, &q = turned ? a.surface : b.surface;
  const SignKey key{Of::root_root, p.solid, p.index,
                    q.solid,       q.index, std::uint8_t(int(p.root) * 8 + int(q.root))};
  const Order order = order_of_sign(oracle.ask_without_polynomial(key));
  return turned ? reversed(order) : order;
}

namespace {

// Does a ray from outside meet the quadric before it?
Met quadric_met(const BeamView& view, const BeamSurface& s, SignOracle& oracle) {
  const QuadricForm& q = view.quadric(s.solid, s.index);
  const bool is_cone =
      view.shape(s.solid).quadrics()[s.index].form == CsgQuadric::Form::cone;
  const auto met = [](Sign sign, Sign wanted) {
    return sign == Sign::unknown ? Met::unknown : sign == wanted ? Met::yes : Met::no;
  };
  if (s.root == Root::other_half) {
    const Met curved = met(oracle.ask(key_of(Of::curvature, s), q.curvature), Sign::negative);
    if (curved != Met::yes) return curved;
    return met(oracle.ask(key_of(Of::half_slope, s), q.half_slope), Sign::positive);
  }
  if (is_cone) {
    const Met opens = met(oracle.ask(key_of(Of::curvature, s), q.curvature), Sign::negative);
    if (opens != Met::no) return opens;
  }
  if (q.has_tangents) {
    const Met low = met(oracle.ask(key_of(Of::tangent_low, s), q.tangents[0]), Sign::positive);
    if (low != Met::yes) return low;
    const Met high = met(oracle.ask(key_of(Of::tangent_high, s), q.tangents[1]), Sign::positive);
    if (high != Met::yes || !view.direction_fixed()) return high;
    return met(oracle.ask(key_of(Of::half_slope, s), q.half_slope), Sign::negative);
  }
  const Met hits = met(oracle.ask(key_of(Of::discriminant, s), q.discriminant), Sign::positive);
  if (hits != Met::yes) return hits;
  return met(oracle.ask(key_of(Of::half_slope, s), q.half_slope), Sign::negative);
}

}  // namespace

namespace {

Met facet_met(const BeamView& view, const LeafSpan& span, LeafPlace place, SignOracle& oracle) {
  const Facet& facet = *view.shape(place.solid).facet(place.leaf);
  const Sign wanted = *span.facet_positive ? Sign::positive : Sign::negative;
  for (std::size_t k = 0; k < 3; ++k) {
    const BeamSurface edge{place.solid, facet.edges[k], Root::none};
    const Sign side = oracle.ask(key_of(Of::side, edge), view.side(place.solid, edge.index));
    if (side == Sign::unknown) return Met::unknown;
    if ((facet.turned[k] ? -side : side) != wanted) return Met::no;
  }
  return decide_end_met(view, span.entering[0], oracle);
}

}  // namespace

Met decide_met(const BeamView& view, const LeafSpan& span, LeafPlace place, SignOracle& oracle) {
  if (span.certain) return Met::yes;
  if (span.facet_positive) return facet_met(view, span, place, oracle);
  if (span.entering.size() == 1 && span.entering[0].surface.is_whole()) return Met::unknown;
  if (span.start_open) {
    // make_span() found a sign open that it could not ask for.
    const ConvexLeaf& leaf = *view.shape(place.solid).convex(place.leaf);
    for (const PlaneRef& ref : leaf.planes) {
      const BeamSurface s{place.solid, ref.plane, Root::none};
      const PlaneForm& form = view.plane(s.solid, s.index);
      const bool eye_in_plane = !view.direction_fixed() &&
                                oracle.find(key_of(Of::height, s), form.height) == Sign::unknown;
      const Sign sign = eye_in_plane ? oracle.ask(key_of(Of::slope, s), form.slope)
                                     : oracle.ask(key_of(Of::height, s), form.height);
      if (sign == Sign::unknown) return Met::unknown;
    }
    if (leaf.quadric) {
      const BeamSurface s{place.solid, *leaf.quadric, Root::nearer};
      const QuadricForm& q = view.quadric(s.solid, s.index);
      if (oracle.ask(key_of(Of::value, s), q.value) != Sign::unknown) {
        oracle.ask(key_of(Of::along, s), q.along);
      }
    }
    return Met::unknown;
  }
  if (span.quadric) {
    const Met met = quadric_met(view, *span.quadric, oracle);
    if (met != Met::yes) return met;
  }
  for (const SpanEnd& e : span.entering) {
    const Met met = decide_end_met(view, e, oracle);
    if (met != Met::yes) return met;
    for (const SpanEnd& l : span.leaving) {
      const Order order = order_of(view, e, l, oracle);
      if (order == Order::unknown) return Met::unknown;
      if (order != Order::before) return Met::no;
    }
  }
  return Met::yes;
}

std::optional<SpanEnd> decide_end(const BeamView& view, const std::vector<SpanEnd>& ends,
                                  bool entering, SignOracle& oracle) {
  if (ends.empty()) return std::nullopt;
  const SpanEnd* best = ends.data();
  for (const SpanEnd& end : ends) {
    if (&end == best) continue;
    const Order order = order_of(view, end, *best, oracle);
    if (order == Order::unknown) return std::nullopt;
    if (order == (entering ? Order::after : Order::before)) best = &end;
  }
  return *best;
}

}  // namespace arris
