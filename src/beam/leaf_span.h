// leaf_span.h — where the rays through a part of the picture are inside a leaf
// What       make_span() bounds the depths at which all rays through a rectangle enter and leave a leaf that is planes
//            and at most one quadric (csg_leaf.h: spheres, boxes, cylinders, cones, convex polyhedra). Of each end it
//            keeps the surfaces that may make it. What the bounds leave open, SignOracle asks as signs of polynomials.
//            Of any other leaf it is known where slices of the beam are certainly outside or inside, no more: its
//            surface is one, whatever face of it a ray meets, and its order before others only where bounds are apart.
//            A facet of a mesh (beam_shape.h) is entered at its plane, for good.
// Limits     an eye that is in a plane but for rounding counts as in it
// Guarantee  along every ray through the rectangle for which the oracle's assumptions hold, the leaf is entered and
//            left within the bounds or missed; nothing is missed if `certain` (tests/beam/region_look_test.cpp)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beam/beam_view.h"
#include "csg/csg_leaf.h"

namespace arris {

// The face of a leaf that is seen as a whole.
inline constexpr std::uint32_t kAnyFace = ~std::uint32_t{0};

// Which polynomial: of one surface, or of two.
struct SignKey {
  enum class Of : std::uint8_t {
    height,
    slope,
    value,
    half_slope,
    curvature,
    discriminant,
    along,
    side,  // of a mesh's edge
    tangent_low,
    tangent_high,
    plane_plane,
    plane_quadric,
    plane_middle,
    root_root  // an order that no polynomial here decides
  };
  Of of = Of::height;
  std::uint32_t solid_a = 0, index_a = 0, solid_b = 0, index_b = 0;
  std::uint8_t roots = 0;  // root_root: which of both

  friend bool operator==(const SignKey&, const SignKey&) = default;
};

// Of one surface.
inline SignKey key_of(SignKey::Of of, const BeamSurface& s) {
  return {of, s.solid, s.index, 0, 0};
}

struct Assumption {
  SignKey key;
  bool positive = false;
};

// A sign that must be known before anything more can be said.
struct OpenSign {
  SignKey key;
  std::optional<Quadratic> polynomial;  // nothing: it can be followed both ways, but not measured
};

enum class Sign : std::int8_t { negative = -1, unknown = 0, positive = 1 };
constexpr Sign operator-(Sign s) {
  return Sign(-int(s));
}
constexpr Sign operator*(Sign a, Sign b) {
  return Sign(int(a) * int(b));
}
constexpr Sign sign_of(Interval range) {
  return range.lo > 0 ? Sign::positive : range.hi < 0 ? Sign::negative : Sign::unknown;
}

// Signs over a rectangle, by range or by assumption. Remembers the first one that was needed and unknown.
class SignOracle {
 public:
  SignOracle(const Rect& rect, const std::vector<Assumption>& assumptions)
      : rect_(rect), assumptions_(assumptions) {}

  [[nodiscard]] const Rect& rect() const { return rect_; }
  template <class Polynomial>
  [[nodiscard]] Sign find(const SignKey& key, const Polynomial& p) const {
    const Sign assumed = find_assumed(key);
    return assumed != Sign::unknown ? assumed : sign_of(range_over(p, rect_));
  }
  template <class Polynomial>
  Sign ask(const SignKey& key, const Polynomial& p) {
    const Sign sign = find(key, p);
    if (sign == Sign::unknown && !open_) open_ = OpenSign{key, Quadratic(p)};
    return sign;
  }
  Sign ask_without_polynomial(const SignKey& key) {
    const Sign sign = find_assumed(key);
    if (sign == Sign::unknown && !open_) open_ = OpenSign{key, std::nullopt};
    return sign;
  }
  [[nodiscard]] const std::optional<OpenSign>& open() const { return open_; }

 private:
  [[nodiscard]] Sign find_assumed(const SignKey& key) const {
    for (const Assumption& a : assumptions_) {
      if (a.key == key) return a.positive ? Sign::positive : Sign::negative;
    }
    return Sign::unknown;
  }
  Rect rect_;
  const std::vector<Assumption>& assumptions_;
  std::optional<OpenSign> open_;
};

// A surface that may be where rays enter, or leave.
struct SpanEnd {
  Interval depth;  // up to infinity where a ray may never get there
  BeamSurface surface;
  std::uint32_t face = 0;
};

struct LeafSpan {
  bool starts_inside = false;
  bool start_open = false;  // some rays may start inside, some outside
  bool certain = false;     // every ray enters, or starts inside
  Interval enter, leave;    // depths; enter is that of the start for rays that start inside
  std::vector<SpanEnd> entering,
      leaving;                         // the last of `entering` is where, the first of `leaving`
  std::optional<BeamSurface> quadric;  // that a ray must meet to meet the leaf
  // Of a facet: whether its edges must be passed on the positive side, or on the negative one.
  std::optional<bool> facet_positive;

  [[nodiscard]] Interval on() const { return {starts_inside ? leave.lo : enter.lo, leave.hi}; }
};

struct LeafPlace {
  std::uint32_t solid = 0, leaf = 0;
};

// The depths in which we are interested end at `depth_end`. Nothing: no ray meets the leaf before it.
std::optional<LeafSpan> make_span(const BeamView& view, LeafPlace place, double depth_end,
                                  const SignOracle& oracle);

// Do all rays begin in the plane? Then they are on one side of it. `height`: of where they begin.
bool begins_in_plane(const BeamView& view, const BeamSurface& plane, Sign height);

// A mesh by itself is the union of what is behind its facets: those that lie before a mirror, behind which rays begin,
// don't count.
bool counts_from_mirror(const BeamView& view, const LeafPlace& place);

// Of all that is beyond a plane that every ray meets.
LeafSpan make_plane_span(const BeamView& view, const LitPlane& plane, const Rect& rect);

enum class Met : std::uint8_t { no, yes, unknown };

enum class Order : std::uint8_t { before, after, same, unknown };
// Where a ray meets one surface against where it meets another. unknown: the oracle's open sign decides.
Order order_of(const BeamView& view, const SpanEnd& a, const SpanEnd& b, SignOracle& oracle);

// Does a ray get there at all? Only ends of which the depth may be infinite are in doubt.
Met decide_end_met(const BeamView& view, const SpanEnd& end, SignOracle& oracle);
Met decide_met(const BeamView& view, const LeafSpan& span, LeafPlace place, SignOracle& oracle);
// The last of `entering`, or the first of `leaving`; nothing if it is unknown.
std::optional<SpanEnd> decide_end(const BeamView& view, const std::vector<SpanEnd>& ends,
                                  bool entering, SignOracle& oracle);

}  // namespace arris
