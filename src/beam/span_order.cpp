// span_order.cpp — which of two ends of spans a ray meets first, and whether it meets them at all
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "beam/leaf_span.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Of = SignKey::Of;
using Root = BeamSurface::Root;

// A plane behind the ray, or that it runs along, is never met; its depth is then said to be infinite.
Met plane_met(const BeamView& view, const SpanEnd& end, SignOracle& oracle) {
  return view.with_plane(end.surface.solid, end.surface.index, [&](const auto& form) {
    const Sign height = oracle.ask(key_of(Of::height, end.surface), form.height);
    const Sign slope = oracle.ask(key_of(Of::slope, end.surface), form.slope);
    if (height * slope == Sign::unknown) return Met::unknown;
    return height * slope == Sign::negative ? Met::yes : Met::no;
  });
}

Order order_of_sign(Sign difference) {
  return difference == Sign::unknown    ? Order::unknown
         : difference == Sign::negative ? Order::before
                                        : Order::after;
}

Order reversed(Order order) {
  return order == Order::before ? Order::after : order == Order::after ? Order::before : order;
}

// Depth at a minus depth at b, times the slopes of both.
Quadratic difference_of(const BeamView& view, const PlaneForm& a, const PlaneForm& b) {
  return plane_before_plane(a, b, view.kind());
}
TaylorModel difference_of(const BeamView&, const BundlePlane& a, const BundlePlane& b) {
  const double base = middle_depth(a);
  return plane_before_plane(begun_at(a, base), begun_at(b, base));
}

template <class Form>
Order order_of_planes(const BeamView& view, const SpanEnd& a, const SpanEnd& b, const Form& p,
                      const Form& q, SignOracle& oracle) {
  const Sign slopes = oracle.ask(key_of(Of::slope, a.surface), p.slope) *
                      oracle.ask(key_of(Of::slope, b.surface), q.slope);
  if (slopes == Sign::unknown) return Order::unknown;
  const SignKey key{Of::plane_plane, a.surface.solid, a.surface.index, b.surface.solid,
                    b.surface.index};
  return order_of_sign(slopes * oracle.ask(key, difference_of(view, p, q)));
}
Order order_of_planes(const BeamView& view, const SpanEnd& a, const SpanEnd& b,
                      SignOracle& oracle) {
  const BeamSurface &s = a.surface, &t = b.surface;
  return view.kind() == BeamKind::bundle
             ? order_of_planes(view, a, b, view.bundle_plane(s.solid, s.index),
                               view.bundle_plane(t.solid, t.index), oracle)
             : order_of_planes(view, a, b, view.plane(s.solid, s.index),
                               view.plane(t.solid, t.index), oracle);
}

// A plane and a quadric. `base`: the depth that theirs are told from.
template <class Plane, class Quadric>
struct PlaneAndQuadric {
  const BeamView& view;
  const SpanEnd &plane, &root;
  const Plane& p;
  const Quadric& q;
  double base = 0;

  [[nodiscard]] auto value_at_plane() const {
    if constexpr (std::is_same_v<Plane, BundlePlane>) {
      return quadric_at_plane(q, p);
    } else {
      return quadric_at_plane(q, p, view.kind());
    }
  }
  [[nodiscard]] auto beyond_middle() const {
    if constexpr (std::is_same_v<Plane, BundlePlane>) {
      return plane_beyond_middle(q, p);
    } else {
      return plane_beyond_middle(q, p, view.kind());
    }
  }
  [[nodiscard]] SignKey key(Of of) const {
    return {of, plane.surface.solid, plane.surface.index, root.surface.solid, root.surface.index};
  }
};

// The plane against the middle between the roots.
template <class Pair>
Order order_to_middle(const Pair& pair, SignOracle& oracle) {
  const Interval middle = Interval(pair.base) - range_over(pair.q.half_slope, oracle.rect()) /
                                                    range_over(pair.q.curvature, oracle.rect());
  if (pair.plane.depth.hi < middle.lo) return Order::before;
  if (pair.plane.depth.lo > middle.hi) return Order::after;
  const Sign scale = oracle.ask(key_of(Of::slope, pair.plane.surface), pair.p.slope) *
                     oracle.ask(key_of(Of::curvature, pair.root.surface), pair.q.curvature);
  if (scale == Sign::unknown) return Order::unknown;
  return order_of_sign(scale * oracle.ask(pair.key(Of::plane_middle), pair.beyond_middle()));
}

// By whether the point on the plane is inside the quadric; where that leaves two ways, by the middle.
template <class Pair>
Order order_of_pair(const Pair& pair, SignOracle& oracle) {
  const BeamView& view = pair.view;
  const SpanEnd& root = pair.root;
  const auto& q = pair.q;
  const CsgQuadric& quadric = view.shape(root.surface.solid).quadrics()[root.surface.index];
  const Sign at_plane = oracle.ask(pair.key(Of::plane_quadric), pair.value_at_plane());
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
      return between ? order_to_middle(pair, oracle) : Order::before;
    case Root::farther:
      if (inside || !between) return Order::before;
      return order_to_middle(pair, oracle);
    case Root::leaving: {
      if (!inside) return Order::after;
      if (between) return Order::before;
      const Met leaves = decide_end_met(view, root, oracle);
      if (leaves == Met::unknown) return Order::unknown;
      return leaves == Met::no ? Order::before : order_to_middle(pair, oracle);
    }
    case Root::other_half:
      return inside ? order_to_middle(pair, oracle) : Order::before;
    case Root::none:
    case Root::whole:
      break;
  }
  return Order::unknown;
}

Order order_of_plane_and_root(const BeamView& view, const SpanEnd& plane, const SpanEnd& root,
                              SignOracle& oracle) {
  const BeamSurface &s = plane.surface, &t = root.surface;
  if (view.kind() != BeamKind::bundle) {
    return order_of_pair(
        PlaneAndQuadric<PlaneForm, QuadricForm>{view, plane, root, view.plane(s.solid, s.index),
                                                view.quadric(t.solid, t.index)},
        oracle);
  }
  // As the rays begin near the plane: from afar signs are differences of large numbers.
  const double base = middle_depth(view.bundle_plane(s.solid, s.index));
  const BundlePlane p = begun_at(view.bundle_plane(s.solid, s.index), base);
  const BundleQuadric q =
      make_form(begun_at(view.bundle_in(t.solid), base), view.shape(t.solid).quadrics()[t.index]);
  return order_of_pair(PlaneAndQuadric<BundlePlane, BundleQuadric>{view, plane, root, p, q, base},
                       oracle);
}

}  // namespace

Met decide_end_met(const BeamView& view, const SpanEnd& end, SignOracle& oracle) {
  if (end.depth.hi < kInfinity) return Met::yes;
  if (end.surface.is_whole()) return Met::unknown;
  if (end.surface.is_plane()) return plane_met(view, end, oracle);
  const CsgQuadric& quadric = view.shape(end.surface.solid).quadrics()[end.surface.index];
  const bool may_open = quadric.form == CsgQuadric::Form::cone &&
                        (end.surface.root == Root::farther || end.surface.root == Root::leaving);
  if (!may_open) return Met::yes;
  // A ray that runs into the opening of a cone leaves it if it comes from the apex's side, but for good.
  return view.with_quadric(end.surface.solid, end.surface.index, [&](const auto& q) {
    const Sign curvature = oracle.ask(key_of(Of::curvature, end.surface), q.curvature);
    if (curvature == Sign::unknown) return Met::unknown;
    if (curvature == Sign::positive) return Met::yes;
    if (end.surface.root == Root::farther) return Met::no;
    const Sign half_slope = oracle.ask(key_of(Of::half_slope, end.surface), q.half_slope);
    if (half_slope == Sign::unknown) return Met::unknown;
    return half_slope == Sign::positive ? Met::yes : Met::no;
  });
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
template <class Form>
Met quadric_met(const BeamView& view, const Form& q, const BeamSurface& s, SignOracle& oracle) {
  const bool is_cone = view.shape(s.solid).quadrics()[s.index].form == CsgQuadric::Form::cone;
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
  if constexpr (std::is_same_v<Form, QuadricForm>) {
    if (q.has_tangents) {
      const Met low = met(oracle.ask(key_of(Of::tangent_low, s), q.tangents[0]), Sign::positive);
      if (low != Met::yes) return low;
      const Met high = met(oracle.ask(key_of(Of::tangent_high, s), q.tangents[1]), Sign::positive);
      if (high != Met::yes || view.kind() == BeamKind::from_point) return high;
      return met(oracle.ask(key_of(Of::half_slope, s), q.half_slope), Sign::negative);
    }
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
    const Sign side = view.with_side(place.solid, edge.index, [&](const auto& form) {
      return oracle.ask(key_of(Of::side, edge), form);
    });
    if (side == Sign::unknown) return Met::unknown;
    if ((facet.turned[k] ? -side : side) != wanted) return Met::no;
  }
  if (counts_from_mirror(view, place)) {
    const LeafSpan start = make_plane_span(view, view.mirror(), oracle.rect());
    const Order order = order_of(view, span.entering[0], start.entering[0], oracle);
    if (order != Order::after) return order == Order::unknown ? Met::unknown : Met::no;
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
    if (view.shape(place.solid).convex(place.leaf) == nullptr) return Met::unknown;
    const ConvexLeaf& leaf = *view.shape(place.solid).convex(place.leaf);
    for (const PlaneRef& ref : leaf.planes) {
      const BeamSurface s{place.solid, ref.plane, Root::none};
      const Sign sign = view.with_plane(s.solid, s.index, [&](const auto& form) {
        const Sign height = oracle.find(key_of(Of::height, s), form.height);
        return begins_in_plane(view, s, height) ? oracle.ask(key_of(Of::slope, s), form.slope)
                                                : oracle.ask(key_of(Of::height, s), form.height);
      });
      if (sign == Sign::unknown) return Met::unknown;
    }
    if (leaf.quadric) {
      const BeamSurface s{place.solid, *leaf.quadric, Root::nearer};
      view.with_quadric(s.solid, s.index, [&](const auto& q) {
        const Sign start = view.starts_on(s) ? oracle.ask(key_of(Of::half_slope, s), q.half_slope)
                                             : oracle.ask(key_of(Of::value, s), q.value);
        if (start != Sign::unknown) oracle.ask(key_of(Of::along, s), q.along);
      });
    }
    return Met::unknown;
  }
  if (span.quadric) {
    const BeamSurface& s = *span.quadric;
    const Met met = view.with_quadric(
        s.solid, s.index, [&](const auto& q) { return quadric_met(view, q, s, oracle); });
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
