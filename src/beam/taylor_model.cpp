#include "beam/taylor_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Interval symmetric(Interval a) {
  const double most = absolute(a).hi;
  return {-most, most};
}

double middle(Interval a) {
  return a.lo / 2 + a.hi / 2;
}

// No coefficient but c is wider than a double.
Quadratic gathered(const Quadratic& a) {
  Quadratic out;
  out.c = a.c;
  const auto take = [&](Interval from, Interval& to, Interval monomial) {
    const double m = middle(from);
    out.c += (from - Interval(m)) * monomial;
    to = Interval(m);
  };
  const Interval one(-1, 1), square(0, 1);
  take(a.x, out.x, one);
  take(a.y, out.y, one);
  take(a.xx, out.xx, square);
  take(a.xy, out.xy, one);
  take(a.yy, out.yy, square);
  return out;
}

// f(m) + f'(m) δ + f''(m)/2 δ² + rest, for δ = a - m.
Quadratic series(const Quadratic& a, double m, Interval value, Interval first, Interval second,
                 Interval rest) {
  Quadratic delta = a;
  delta.c -= Interval(m);
  Quadratic sum = delta * first + squared(delta) * second;
  sum.c += value + rest;
  return sum;
}

Quadratic with_rest(const Quadratic& a, Interval slope, Interval rest) {
  Quadratic out = a * slope;
  out.c += rest;
  return out;
}

const Quadratic& narrower(const Quadratic& a, const Quadratic& b) {
  return gathered(a).c.width() <= gathered(b).c.width() ? a : b;
}

}  // namespace

Quadratic linear_over(const Rect& rect, Interval c, Interval per_x, Interval per_y) {
  const Interval x(rect.middle_x()), y(rect.middle_y());
  const Interval hx = Interval(rect.x1) - Interval(rect.x0);
  const Interval hy = Interval(rect.y1) - Interval(rect.y0);
  return Quadratic(Linear{c + per_x * x + per_y * y, per_x * (hx * Interval(0.5)),
                          per_y * (hy * Interval(0.5))});
}

Quadratic product(const Quadratic& a, const Quadratic& b) {
  const Interval a1 = absolute(a.x) + absolute(a.y), b1 = absolute(b.x) + absolute(b.y);
  const Interval a2 = absolute(a.xx) + absolute(a.xy) + absolute(a.yy);
  const Interval b2 = absolute(b.xx) + absolute(b.xy) + absolute(b.yy);
  const Interval beyond = symmetric(a1 * b2 + a2 * b1 + a2 * b2);
  return {a.c * b.c + beyond,
          a.c * b.x + a.x * b.c,
          a.c * b.y + a.y * b.c,
          a.c * b.xx + a.x * b.x + a.xx * b.c,
          a.c * b.xy + a.x * b.y + a.y * b.x + a.xy * b.c,
          a.c * b.yy + a.y * b.y + a.yy * b.c};
}

Quadratic squared(const Quadratic& a) {
  const Interval two(2);
  const Interval a1 = absolute(a.x) + absolute(a.y);
  const Interval a2 = absolute(a.xx) + absolute(a.xy) + absolute(a.yy);
  return {square(a.c) + symmetric(a1 * a2 * two) + Interval(0, square(a2).hi),
          two * a.c * a.x,
          two * a.c * a.y,
          two * a.c * a.xx + square(a.x),
          two * (a.c * a.xy + a.x * a.y),
          two * a.c * a.yy + square(a.y)};
}

// Chebyshev: with slope -s, 1/x + s x is convex, is largest at an end and no less than 2 √s anywhere. Taylor: the third
// derivative over 6 is -1/x⁴.
std::optional<Quadratic> reciprocal(const Quadratic& a) {
  const Interval range = range_over(a, kUnitSquare);
  if (range.hi < 0) {
    const std::optional<Quadratic> positive = reciprocal(-a);
    return positive ? std::optional(-*positive) : std::nullopt;
  }
  if (!(range.lo > 0) || !(range.hi < kInfinity)) return std::nullopt;
  const double slope = 1 / range.lo / range.hi;
  if (!(slope < kInfinity) || !(1 / range.lo < kInfinity)) return std::nullopt;
  const Interval s(slope);
  const auto rest_at = [&](double x) { return Interval(1) / Interval(x) + s * Interval(x); };
  const double high = std::max(rest_at(range.lo).hi, rest_at(range.hi).hi);
  const double low = (Interval(2) * square_root(s)).lo;
  const Quadratic linear = with_rest(a, -s, {low, high});
  const double m = middle(a.c);
  if (!(m > 0)) return linear;
  const Interval inverse = Interval(1) / Interval(m);
  const Interval far(std::max(m - range.lo, range.hi - m));
  const Interval third = far * square(far) / square(square(Interval(range.lo)));
  const Quadratic taylor =
      series(a, m, inverse, -square(inverse), inverse * square(inverse), symmetric(third));
  return narrower(taylor, linear);
}

// Chebyshev: with slope s, √x - s x is concave, is smallest at an end and no more than 1 / (4 s) anywhere. Taylor: the
// third derivative over 6 is x^(-5/2) / 16.
Quadratic square_root(const Quadratic& a) {
  const Interval range = range_over(a, kUnitSquare);
  const double low = std::max(range.lo, 0.0);
  if (!(range.hi > 0)) return {};
  const double slope = 1 / (std::sqrt(low) + std::sqrt(range.hi));
  if (!(slope > 0) || !(slope < kInfinity)) {
    return constant_model({0, next_up(std::sqrt(range.hi))});
  }
  const Interval s(slope);
  const auto rest_at = [&](double x) { return square_root(Interval(x)) - s * Interval(x); };
  const double least = std::min(rest_at(low).lo, rest_at(range.hi).lo);
  const double most = (Interval(0.25) / s).hi;
  const Quadratic linear = with_rest(a, s, {least, most});
  const double m = middle(a.c);
  if (!(low > 0) || !(m > 0)) return linear;
  const Interval root = square_root(Interval(m));
  const Interval far(std::max(m - range.lo, range.hi - m));
  const Interval third = far * square(far) / (Interval(16) * square(Interval(low)) *
                                              square_root(Interval(low)));
  const Quadratic taylor = series(a, m, root, Interval(0.5) / root,
                                  Interval(-0.125) / (Interval(m) * root), symmetric(third));
  return narrower(taylor, linear);
}

QuadraticVec scaled(const QuadraticVec& v, const Quadratic& s) {
  return {product(v.x, s), product(v.y, s), product(v.z, s)};
}
QuadraticVec scaled(const QuadraticVec& v, Interval s) {
  return {v.x * s, v.y * s, v.z * s};
}
Quadratic dot_of(const QuadraticVec& a, const QuadraticVec& b) {
  return product(a.x, b.x) + product(a.y, b.y) + product(a.z, b.z);
}

namespace {

Quadratic dot_of(Vec3d n, const QuadraticVec& v) {
  return v.x * Interval(n.x) + v.y * Interval(n.y) + v.z * Interval(n.z);
}

}  // namespace

QuadraticVec map_vector(const Mat3d& m, const QuadraticVec& v) {
  const Mat3d rows = transpose(m);
  return {dot_of(rows.x, v), dot_of(rows.y, v), dot_of(rows.z, v)};
}
QuadraticVec map_point(const Affine3d& m, const QuadraticVec& p) {
  QuadraticVec mapped = map_vector(m.linear, p);
  mapped.x.c += Interval(m.translation.x);
  mapped.y.c += Interval(m.translation.y);
  mapped.z.c += Interval(m.translation.z);
  return mapped;
}

Vec3<Interval> ranges_of(const QuadraticVec& v) {
  return {range_over(v.x, kUnitSquare), range_over(v.y, kUnitSquare),
          range_over(v.z, kUnitSquare)};
}

Quadratic on_picture(const Quadratic& a, const Rect& rect) {
  const Quadratic q = gathered(a);
  // u = (x - mx) / hx, with the middle and the half side that linear_over() has.
  const Interval mx(rect.middle_x()), my(rect.middle_y());
  const Interval sx = Interval(2) / (Interval(rect.x1) - Interval(rect.x0));
  const Interval sy = Interval(2) / (Interval(rect.y1) - Interval(rect.y0));
  const Interval x = q.x * sx, y = q.y * sy;
  const Interval xx = q.xx * square(sx), xy = q.xy * sx * sy, yy = q.yy * square(sy);
  const Interval two(2);
  return {q.c - x * mx - y * my + xx * square(mx) + xy * mx * my + yy * square(my),
          x - two * xx * mx - xy * my,
          y - two * yy * my - xy * mx,
          xx,
          xy,
          yy};
}

}  // namespace arris
