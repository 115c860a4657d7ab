#include "beam/taylor_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A rounding error is at most half of this part of a result.
constexpr double kUlp = std::numeric_limits<double>::epsilon();
constexpr double kTiny = std::numeric_limits<double>::min();

double middle(Interval a) {
  return a.lo / 2 + a.hi / 2;
}

// Sums of the coefficients' sizes, by degree: bounds over the square.
struct Norms {
  double constant, first, second;
  [[nodiscard]] double all() const { return constant + first + second; }
};
Norms norms_of(const TaylorModel& a) {
  return {std::abs(a.c), std::abs(a.x) + std::abs(a.y),
          std::abs(a.xx) + std::abs(a.xy) + std::abs(a.yy)};
}

// With the rounding of results of that size, each of at most `operations`, and of the rest itself.
TaylorModel rounded(TaylorModel a, double size, double operations) {
  a.rest = a.rest * (1 + 16 * kUlp) + operations * kUlp * size + kTiny;
  return a;
}

TaylorModel with_interval(TaylorModel a, Interval more) {
  const double m = middle(more);
  a.c += m;
  a.rest += std::max(next_up(more.hi - m), next_up(m - more.lo));
  return rounded(a, norms_of(a).all(), 1);
}

// f(m) + f'(m) δ + f''(m)/2 δ² + rest, for δ = a - m, of factors that have gone through a few roundings.
TaylorModel series(const TaylorModel& a, double m, double value, double first, double second,
                   double rest) {
  const TaylorModel delta = a - constant_model(m);
  TaylorModel sum = delta * first + squared(delta) * second;
  const double far = norms_of(delta).all() + delta.rest;
  const double size = std::abs(value) + std::abs(first) * far + std::abs(second) * far * far;
  sum.c += value;
  sum.rest += rest;
  return rounded(sum, size, 16);
}

const TaylorModel& narrower(const TaylorModel& a, const TaylorModel& b) {
  return a.rest <= b.rest ? a : b;
}

// Of a u² + b u over |u| ≤ 1, but for rounding.
Interval parabola_range(double a, double b) {
  const double slope = std::abs(b);
  double high = a + slope, low = a - slope;
  if (a < 0 && slope < -2 * a) high = slope * slope / (-4 * a);
  if (a > 0 && slope < 2 * a) low = -slope * slope / (4 * a);
  return {std::min(low, 0.0), std::max(high, 0.0)};
}

}  // namespace

TaylorModel::operator Quadratic() const {
  return {{next_down(c - rest), next_up(c + rest)}, x, y, xx, xy, yy};
}

TaylorModel constant_model(Interval c) {
  TaylorModel a;
  a.c = middle(c);
  a.rest = std::max(next_up(c.hi - a.c), next_up(a.c - c.lo));
  if (c.lo == c.hi) a.rest = 0;
  return a;
}

TaylorModel linear_over(const Rect& rect, double c, double per_x, double per_y) {
  TaylorModel a;
  const double x = rect.middle_x(), y = rect.middle_y();
  a.c = c + per_x * x + per_y * y;
  a.x = per_x * (rect.width() / 2);
  a.y = per_y * (rect.height() / 2);
  return rounded(
      a, std::abs(c) + std::abs(per_x * x) + std::abs(per_y * y) + std::abs(a.x) + std::abs(a.y),
      4);
}

TaylorModel operator+(const TaylorModel& a, const TaylorModel& b) {
  const TaylorModel sum{a.c + b.c,   a.x + b.x,   a.y + b.y,      a.xx + b.xx,
                        a.xy + b.xy, a.yy + b.yy, a.rest + b.rest};
  return rounded(sum, norms_of(sum).all(), 1);
}
TaylorModel operator-(const TaylorModel& a, const TaylorModel& b) {
  return a + -b;
}
TaylorModel operator-(const TaylorModel& a) {
  return {-a.c, -a.x, -a.y, -a.xx, -a.xy, -a.yy, a.rest};
}
TaylorModel operator*(const TaylorModel& a, double s) {
  const TaylorModel times{
      a.c * s, a.x * s, a.y * s, a.xx * s, a.xy * s, a.yy * s, a.rest * std::abs(s)};
  return rounded(times, norms_of(times).all(), 1);
}

// What is of a degree above 2 goes into the rest.
TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
  const Norms p = norms_of(a), q = norms_of(b);
  const double beyond = p.first * q.second + p.second * q.first + p.second * q.second;
  const TaylorModel times{a.c * b.c,
                          a.c * b.x + a.x * b.c,
                          a.c * b.y + a.y * b.c,
                          a.c * b.xx + a.x * b.x + a.xx * b.c,
                          a.c * b.xy + a.x * b.y + a.y * b.x + a.xy * b.c,
                          a.c * b.yy + a.y * b.y + a.yy * b.c,
                          p.all() * b.rest + q.all() * a.rest + a.rest * b.rest + beyond};
  return rounded(times, p.all() * q.all(), 4);
}

// The square of what is of second degree is not negative.
TaylorModel squared(const TaylorModel& a) {
  const Norms p = norms_of(a);
  const double fourth = p.second * p.second;
  const TaylorModel square{
      a.c * a.c + fourth / 2,
      2 * a.c * a.x,
      2 * a.c * a.y,
      2 * a.c * a.xx + a.x * a.x,
      2 * (a.c * a.xy + a.x * a.y),
      2 * a.c * a.yy + a.y * a.y,
      2 * p.all() * a.rest + a.rest * a.rest + 2 * p.first * p.second + fourth / 2};
  return rounded(square, p.all() * p.all(), 4);
}

Interval range_over(const TaylorModel& a, const Rect& /*rect*/) {
  const Interval in_x = parabola_range(a.xx, a.x), in_y = parabola_range(a.yy, a.y);
  const double mixed = std::abs(a.xy);
  const double slack = a.rest * (1 + 8 * kUlp) + 8 * kUlp * norms_of(a).all() + kTiny;
  return {a.c + in_x.lo + in_y.lo - mixed - slack, a.c + in_x.hi + in_y.hi + mixed + slack};
}

// Chebyshev: with slope -s, 1/x + s x is convex, is largest at an end and no less than 2 √s anywhere. Taylor: the third
// derivative over 6 is -1/x⁴.
std::optional<TaylorModel> reciprocal(const TaylorModel& a) {
  const Interval range = range_of(a);
  if (range.hi < 0) {
    const std::optional<TaylorModel> positive = reciprocal(-a);
    return positive ? std::optional(-*positive) : std::nullopt;
  }
  if (!(range.lo > 0) || !(range.hi < kInfinity)) return std::nullopt;
  const double slope = 1 / range.lo / range.hi;
  if (!(slope < kInfinity) || !(1 / range.lo < kInfinity)) return std::nullopt;
  const Interval s(slope);
  const auto rest_at = [&](double x) { return Interval(1) / Interval(x) + s * Interval(x); };
  const double high = std::max(rest_at(range.lo).hi, rest_at(range.hi).hi);
  const TaylorModel linear = with_interval(a * -slope, {(Interval(2) * square_root(s)).lo, high});
  const double m = a.c;
  if (!(m > 0)) return linear;
  const double far = std::max(m - range.lo, range.hi - m) * (1 + kUlp);
  const Interval third = Interval(far) * square(Interval(far)) / square(square(Interval(range.lo)));
  const double inverse = 1 / m;
  return narrower(series(a, m, inverse, -inverse * inverse, inverse * inverse * inverse, third.hi),
                  linear);
}

// Chebyshev: with slope s, √x - s x is concave, is smallest at an end and no more than 1 / (4 s) anywhere. Taylor: the
// third derivative over 6 is x^(-5/2) / 16.
TaylorModel square_root(const TaylorModel& a) {
  const Interval range = range_of(a);
  const double low = std::max(range.lo, 0.0);
  if (range.hi <= 0) return {};  // not if it is no number
  const double slope = 1 / (std::sqrt(low) + std::sqrt(range.hi));
  if (!(slope > 0) || !(slope < kInfinity)) {
    return constant_model({0, next_up(std::sqrt(range.hi))});
  }
  const Interval s(slope);
  const auto rest_at = [&](double x) { return square_root(Interval(x)) - s * Interval(x); };
  const double least = std::min(rest_at(low).lo, rest_at(range.hi).lo);
  const TaylorModel linear = with_interval(a * slope, {least, (Interval(0.25) / s).hi});
  const double m = a.c;
  if (!(low > 0) || !(m > 0)) return linear;
  const double far = std::max(m - range.lo, range.hi - m) * (1 + kUlp);
  const Interval third = Interval(far) * square(Interval(far)) /
                         (Interval(16) * square(Interval(low)) * square_root(Interval(low)));
  const double root = std::sqrt(m);
  return narrower(series(a, m, root, 0.5 / root, -0.125 / (m * root), third.hi), linear);
}

ModelVec scaled(const ModelVec& v, double s) {
  return {v.x * s, v.y * s, v.z * s};
}
TaylorModel dot_of(Vec3d n, const ModelVec& v) {
  return v.x * n.x + v.y * n.y + v.z * n.z;
}
ModelVec map_vector(const Mat3d& m, const ModelVec& v) {
  const Mat3d rows = transpose(m);
  return {dot_of(rows.x, v), dot_of(rows.y, v), dot_of(rows.z, v)};
}
ModelVec map_point(const Affine3d& m, const ModelVec& p) {
  const ModelVec v = map_vector(m.linear, p);
  const Vec3d& t = m.translation;
  return {v.x + constant_model(t.x), v.y + constant_model(t.y), v.z + constant_model(t.z)};
}

Vec3<Interval> ranges_of(const ModelVec& v) {
  return {range_of(v.x), range_of(v.y), range_of(v.z)};
}

Quadratic on_picture(const Quadratic& q, const Rect& rect) {
  // u = (x - mx) / hx, as in linear_over().
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
