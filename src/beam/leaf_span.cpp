#include "beam/leaf_span.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Of = SignKey::Of;
using Root = BeamSurface::Root;

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
    const BeamSurface surface{place_.solid, facet.plane.plane, Root::none};
    if (view_.starts_on(surface)) return std::nullopt;
    const bool is_bundle = view_.kind() == BeamKind::bundle;
    const Sign wanted =
        is_bundle ? side_of_bundle(facet) : Sign(view_.facet_turn(place_.solid, place_.leaf));
    if (wanted == Sign::unknown && !is_bundle) return std::nullopt;  // it is seen as a line
    bool within = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const BeamSurface edge{place_.solid, facet.edges[k], Root::none};
      const Sign side = view_.with_side(place_.solid, edge.index, [&](const auto& form) {
        return oracle_.find(key_of(Of::side, edge), form);
      });
      const Sign own = facet.turned[k] ? -side : side;
      if (wanted != Sign::unknown && own == -wanted) return std::nullopt;
      within = within && own == wanted;
    }
    span_.enter = view_.with_plane(place_.solid, facet.plane.plane, [&](const auto& form) {
      return intersection(quotient(absolute(range_over(form.height, oracle_.rect())),
                                   absolute(range_over(form.slope, oracle_.rect()))),
                          depth_from_base(form));
    });
    if (!(span_.enter.lo <= depth_end_)) return std::nullopt;
    bool beyond = true;
    if (counts_from_mirror(view_, place_)) {
      const LeafSpan start = make_plane_span(view_, view_.mirror(), oracle_.rect());
      if (surface == start.entering[0].surface || span_.enter.hi < start.enter.lo) {
        return std::nullopt;
      }
      beyond = span_.enter.lo > start.enter.hi;
    }
    span_.leave = {kInfinity, kInfinity};
    span_.entering.push_back({span_.enter, surface, 0});
    if (wanted == Sign::unknown) {
      span_.start_open = true;  // some rays may begin on either side of it
      return std::move(span_);
    }
    span_.facet_positive = wanted == Sign::positive;
    span_.certain = within && beyond && span_.enter.hi < kInfinity;
    return std::move(span_);
  }
  // 1: the bundle's rays begin where they see the facet's corners turn counter-clockwise.
  [[nodiscard]] Sign side_of_bundle(const Facet& facet) const {
    const BundlePlane& form = view_.bundle_plane(place_.solid, facet.plane.plane);
    const Sign height = sign_of(range_over(form.height, oracle_.rect()));
    return facet.plane.flipped ? height : -height;
  }
  std::optional<LeafSpan> make_volume() {
    const Cover start = view_.start_in_volume(place_.solid, place_.leaf);
    if (start == Cover::out) return std::nullopt;
    span_.start_open = start == Cover::on;
    span_.starts_inside = span_.certain = start == Cover::in;
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
    double in_end = 0,
           last_on = 0;  // where the inside ones end that come first; where the last end
  };
  [[nodiscard]] Slices slice(Interval range) const {
    constexpr int kSlices = 16;
    const CsgSolid& solid = view_.shape(place_.solid).csg();
    const auto depth = [&](int i) {
      return range.lo + (range.hi - range.lo) * (double(i) / kSlices);
    };
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

  // The plane's depth, for a bundle from where the rays are near it; for others quotients tell all.
  [[nodiscard]] static Interval depth_from_base(const PlaneForm&) {
    return {-kInfinity, kInfinity};
  }
  [[nodiscard]] Interval depth_from_base(const BundlePlane& form) const {
    const Interval slope = range_over(form.slope, oracle_.rect());
    if (slope.contains(0)) return {-kInfinity, kInfinity};
    const double base = middle_depth(form);
    return Interval(base) - range_over(begun_at(form, base).height, oracle_.rect()) / slope;
  }

  // False: every ray misses.
  bool add_plane(PlaneRef ref, std::uint32_t face) {
    return view_.with_plane(place_.solid, ref.plane,
                            [&](const auto& form) { return add_plane(form, ref, face); });
  }
  template <class Form>
  bool add_plane(const Form& form, PlaneRef ref, std::uint32_t face) {
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
    if (begins_in_plane(view_, surface, height)) {
      // Rays are on one side of it, for good.
      if (slopes.lo >= 0) return false;
      span_.start_open = span_.start_open || slopes.hi > 0;
      return true;
    }
    if (height == Sign::unknown) {
      span_.start_open = true;
      return true;
    }
    const Interval distance = absolute(range_over(form.height, oracle_.rect()));
    const Interval near = depth_from_base(form);
    if (height == Sign::negative) {
      if (slopes.hi <= 0) return true;
      const Interval depth =
          intersection(quotient(distance, {std::max(slopes.lo, 0.0), slopes.hi}), near);
      if (depth.lo <= depth_end_) span_.leaving.push_back({depth, surface, face});
      return true;
    }
    span_.starts_inside = false;
    if (slopes.lo >= 0) return false;
    const Interval depth =
        intersection(quotient(distance, {std::max(-slopes.hi, 0.0), -slopes.lo}), near);
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
    return view_.with_quadric(place_.solid, index,
                              [&](const auto& form) { return add_quadric(form, index, face); });
  }
  template <class Form>
  bool add_quadric(const Form& form, std::uint32_t index, std::uint32_t face) {
    const CsgQuadric& quadric = view_.shape(place_.solid).quadrics()[index];
    BeamSurface surface{place_.solid, index, Root::nearer};
    span_.quadric = surface;
    const bool is_cone = quadric.form == CsgQuadric::Form::cone;
    if (view_.starts_on(surface)) return add_from_itself(form, surface, face, is_cone);
    const Sign value = oracle_.find(key_of(Of::value, surface), form.value);
    if (value == Sign::unknown) {
      span_.start_open = true;
      return true;
    }
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
    depth = intersection(depth, from_base(b, false));
    if (depth.lo <= depth_end_) span_.leaving.push_back({depth, surface, face});
    return true;
  }

  struct Bounds {
    Interval value, half_slope, curvature, discriminant, root;
    double base = 0;  // see BundleQuadric
    Interval base_half_slope;
    Sign tangents = Sign::unknown;  // positive: within both; negative: outside one
  };
  template <class Form>
  [[nodiscard]] Bounds bounds_of(const Form& form, const BeamSurface& s, bool is_cone) const {
    const Rect& rect = oracle_.rect();
    const BeamKind kind = view_.kind();
    Bounds b;
    b.value = kind == BeamKind::from_point ? form.value.c : range_over(form.value, rect);
    b.half_slope = range_over(form.half_slope, rect);
    b.curvature = kind == BeamKind::parallel ? form.curvature.c : range_over(form.curvature, rect);
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
    if constexpr (std::is_same_v<Form, QuadricForm>) clip_by_tangents(form, s, b);
    b.root = square_root(b.discriminant);
    if constexpr (std::is_same_v<Form, BundleQuadric>) {
      b.base = form.base;
      b.base_half_slope = range_over(form.base_half_slope, rect);
    }
    return b;
  }
  void clip_by_tangents(const QuadricForm& form, const BeamSurface& s, Bounds& b) const {
    if (form.has_tangents) {
      const Sign low = oracle_.find(key_of(Of::tangent_low, s), form.tangents[0]);
      const Sign high = oracle_.find(key_of(Of::tangent_high, s), form.tangents[1]);
      if (low == Sign::negative || high == Sign::negative) b.tangents = Sign::negative;
      if (low == Sign::positive && high == Sign::positive) {
        b.tangents = Sign::positive;
        b.discriminant.lo = std::max(b.discriminant.lo, 0.0);
        if (view_.kind() == BeamKind::from_point) b.half_slope.hi = std::min(b.half_slope.hi, 0.0);
      }
    }
  }

  // The depth of the root on that side of the middle, from the middle of a bundle's rays; else anything.
  [[nodiscard]] Interval from_base(const Bounds& b, bool nearer) const {
    if (view_.kind() != BeamKind::bundle || !(b.curvature.lo > 0)) return {-kInfinity, kInfinity};
    const Interval root = nearer ? -b.root : b.root;
    return Interval(b.base) + (root - b.base_half_slope) / b.curvature;
  }

  bool add_from_outside(const Bounds& b, BeamSurface surface, std::uint32_t face) {
    const bool bends_out =
        b.curvature.lo < 0;  // some rays may run into a cone that opens before them
    if (!bends_out && (b.discriminant.hi <= 0 || b.half_slope.lo >= 0)) return false;
    if (b.tangents == Sign::negative) return false;
    const Interval sum = b.root - b.half_slope;
    const Interval depth = intersection(
        quotient(b.value, {std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)}), from_base(b, true));
    if (!(depth.lo <= depth_end_) || !(depth.lo <= depth.hi)) return false;
    span_.entering.push_back({depth, surface, face});
    if (b.curvature.hi > 0) {
      surface.root = Root::farther;
      Interval far = quotient({std::max(sum.lo, 0.0), std::max(sum.hi, 0.0)},
                              {std::max(b.curvature.lo, 0.0), b.curvature.hi});
      far = intersection(far, from_base(b, false));
      if (!(far.lo <= far.hi)) return false;
      far.lo = std::max(far.lo, depth.lo);
      span_.leaving.push_back({far, surface, face});
    }
    const bool crosses = b.tangents == Sign::positive || b.discriminant.lo > 0;
    const bool ahead = b.half_slope.hi < 0 ||
                       (b.tangents == Sign::positive && view_.kind() == BeamKind::from_point);
    needs_quadric_ = !(b.curvature.hi < 0 || (crosses && ahead));
    return true;
  }

  // Rays that begin on the quadric meet it again at -2 half_slope / curvature: inside to where they leave it, or to the
  // other half of a double cone.
  template <class Form>
  bool add_from_itself(const Form& form, BeamSurface surface, std::uint32_t face, bool is_cone) {
    const Sign slope = oracle_.find(key_of(Of::half_slope, surface), form.half_slope);
    const CsgQuadric& quadric = view_.shape(place_.solid).quadrics()[surface.index];
    const Sign half = is_cone ? half_of(quadric) : Sign::positive;
    const Sign own =
        is_cone ? oracle_.find(key_of(Of::along, surface), form.along) : Sign::positive;
    if (slope == Sign::unknown || own == Sign::unknown) {
      span_.start_open = true;
      return true;
    }
    const Bounds b = bounds_of(form, surface, is_cone);
    if ((own == half) == (slope == Sign::positive)) return false;
    if (own != half) return add_from_other_half(b, surface, face);
    surface.root = Root::leaving;
    span_.quadric.reset();
    const Interval depth = quotient(absolute(b.half_slope * Interval(2)),
                                    {std::max(b.curvature.lo, 0.0), std::max(b.curvature.hi, 0.0)});
    if (depth.lo <= depth_end_) span_.leaving.push_back({depth, surface, face});
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

}  // namespace

bool begins_in_plane(const BeamView& view, const BeamSurface& plane, Sign height) {
  return view.starts_on(plane) || (height == Sign::unknown && view.kind() == BeamKind::from_point);
}

bool counts_from_mirror(const BeamView& view, const LeafPlace& place) {
  return view.is_mirrored() && view.shape(place.solid).is_mesh();
}

LeafSpan make_plane_span(const BeamView& view, const LitPlane& plane, const Rect& rect) {
  const PlaneForm& form = view.plane(plane.solid, plane.plane);  // no view of a bundle has any
  LeafSpan span;
  span.enter =
      quotient(absolute(range_over(form.height, rect)), absolute(range_over(form.slope, rect)));
  span.leave = {kInfinity, kInfinity};
  span.certain = true;
  span.entering.push_back({span.enter, {plane.solid, plane.plane, Root::none}, 0});
  return span;
}

std::optional<LeafSpan> make_span(const BeamView& view, LeafPlace place, double depth_end,
                                  const SignOracle& oracle) {
  return SpanMaker(view, place, depth_end, oracle).make();
}

}  // namespace arris
