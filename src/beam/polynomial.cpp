#include "beam/polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A half side that reaches both ends from the rounded middle.
double half_side(double low, double high, double middle) {
  return std::max(next_up(high - middle), next_up(middle - low));
}

// Of a u² + b u over |u| ≤ 1.
Interval parabola_range(Interval a, Interval b) {
  const double slope = std::max(std::abs(b.lo), std::abs(b.hi));
  double high = next_up(a.hi + slope), low = next_down(a.lo - slope);
  if (a.hi < 0 && slope < -2 * a.hi) high = (square(Interval(slope)) / Interval(-4 * a.hi)).hi;
  if (a.lo > 0 && slope < 2 * a.lo) low = (-(square(Interval(slope)) / Interval(4 * a.lo))).lo;
  return {std::min(low, 0.0), std::max(high, 0.0)};
}

struct Centered {
  double hx, hy;
  Interval value, dx, dy;  // at the middle; derivatives times half sides
  Interval xx, xy, yy;     // times half sides
};

// A number and how far the true one may be from it. What this file spends its time on: one product instead of the four
// of intervals. `size` bounds all that was added up, of which rounding takes a part at the end.
struct Ball {
  double value = 0, radius = 0, size = 0;

  Ball() = default;
  explicit Ball(Interval a)
      : value(a.lo * 0.5 + a.hi * 0.5), radius(a.hi * 0.5 - a.lo * 0.5), size(std::abs(value)) {}
  friend Ball operator+(const Ball& a, const Ball& b) {
    return {a.value + b.value, a.radius + b.radius, a.size + b.size};
  }
  friend Ball operator*(const Ball& a, double s) {
    return {a.value * s, a.radius * std::abs(s), a.size * std::abs(s)};
  }
  // Fewer than 16 operations lie behind each number, and each is off by less than 1.2e-16 of it.
  [[nodiscard]] Interval to_interval() const {
    constexpr double kRounding = 4e-15;
    const double reach = radius + kRounding * (size + radius) + std::numeric_limits<double>::min();
    if (!(reach < kInfinity)) return {-kInfinity, kInfinity};
    return {value - reach, value + reach};
  }

 private:
  Ball(double value_, double radius_, double size_) : value(value_), radius(radius_), size(size_) {}
};

Centered center(const Quadratic& p, const Rect& rect) {
  const double x = rect.middle_x(), y = rect.middle_y();
  Centered c{};
  c.hx = half_side(rect.x0, rect.x1, x);
  c.hy = half_side(rect.y0, rect.y1, y);
  const Ball px(p.x), py(p.y), xx(p.xx), xy(p.xy), yy(p.yy);
  c.value = (Ball(p.c) + (px + xx * x + xy * y) * x + (py + yy * y) * y).to_interval();
  c.dx = ((px + xx * (2 * x) + xy * y) * c.hx).to_interval();
  c.dy = ((py + yy * (2 * y) + xy * x) * c.hy).to_interval();
  c.xx = (xx * c.hx * c.hx).to_interval();
  c.xy = (xy * c.hx * c.hy).to_interval();
  c.yy = (yy * c.hy * c.hy).to_interval();
  return c;
}

Interval symmetric(Interval a) {
  const double most = absolute(a).hi;
  return {-most, most};
}

}  // namespace

Interval range_over(const Linear& p, const Rect& rect) {
  return p.c + p.x * Interval(rect.x0, rect.x1) + p.y * Interval(rect.y0, rect.y1);
}

Interval value_at(const Quadratic& p, double x, double y) {
  return (Ball(p.c) + (Ball(p.x) + Ball(p.xx) * x + Ball(p.xy) * y) * x +
          (Ball(p.y) + Ball(p.yy) * y) * y)
      .to_interval();
}

Interval range_over(const Quadratic& p, const Rect& rect) {
  const Centered c = center(p, rect);
  return c.value + parabola_range(c.xx, c.dx) + parabola_range(c.yy, c.dy) + symmetric(c.xy);
}

bool is_noise(const Quadratic& p, const Rect& rect) {
  return range_over(p, rect).width() <= 4 * value_at(p, rect.middle_x(), rect.middle_y()).width();
}

namespace {

double middle(Interval a) {
  return a.lo / 2 + a.hi / 2;
}

// What is not linear, over the whole rectangle.
Slab plain_slab(const Centered& c) {
  const double dx = middle(c.dx), dy = middle(c.dy);
  const Interval unit_square(0, 1);
  const Interval rest = symmetric(c.dx - Interval(dx)) + symmetric(c.dy - Interval(dy)) +
                        c.xx * unit_square + c.yy * unit_square + symmetric(c.xy);
  return {c.value + rest, dx / c.hx, dy / c.hy};
}

// In coordinates u along the gradient and v across: value + gu u + gv v + a u² + b u v + e v², |u|, |v| ≤ reach.
struct Turned {
  double nx, ny, reach;
  Interval value, gu, gv, a, b, e;
};

Turned turn(const Centered& c, double nx, double ny) {
  const Interval x(nx), y(ny);
  Turned t{nx, ny, (std::abs(nx) + std::abs(ny)) * (1 + 1e-12), c.value, {}, {}, {}, {}, {}};
  t.gu = c.dx * x + c.dy * y;
  t.gv = c.dy * x - c.dx * y;
  t.a = c.xx * square(x) + c.xy * x * y + c.yy * square(y);
  t.b = Interval(2) * (c.yy - c.xx) * x * y + c.xy * (square(x) - square(y));
  t.e = c.xx * square(y) - c.xy * x * y + c.yy * square(x);
  return t;
}

// All zeros in the rectangle: u = -(value + gv v + a u² + b u v + e v²) / gu, put in again and again.
Interval zeros_of(const Turned& t) {
  const Interval v(-t.reach, t.reach), vv(0, next_up(t.reach * t.reach));
  Interval u(-t.reach, t.reach);
  for (int i = 0; i < 3; ++i) {
    const Interval again = -(t.value + t.gv * v + t.a * square(u) + t.b * u * v + t.e * vv) / t.gu;
    u = intersection(u, again);
    if (!(u.lo <= u.hi)) break;
  }
  return u;
}

// Where p grows all along u, only what is not linear near its zeros counts: beyond them the sign is known.
std::optional<Slab> narrow_slab(const Centered& c) {
  const double gx = middle(c.dx), gy = middle(c.dy), size = std::hypot(gx, gy);
  if (!(size > 0)) return std::nullopt;
  const Turned t = turn(c, gx / size, gy / size);
  const Interval v(-t.reach, t.reach), vv(0, next_up(t.reach * t.reach));
  if (!((t.gu + Interval(2) * t.a * v + t.b * v).lo > 0)) return std::nullopt;
  const Interval zeros = zeros_of(t);
  if (!(zeros.lo <= zeros.hi)) return std::nullopt;
  const double u0 = middle(zeros);
  const Interval w = zeros - Interval(u0);
  const Interval at = t.value + t.gu * Interval(u0) + t.a * square(Interval(u0));
  const Interval slope_u = t.gu + Interval(2) * t.a * Interval(u0);
  const Interval slope_v = t.gv + t.b * Interval(u0);
  const double su = middle(slope_u), sv = middle(slope_v);
  const double rounding = 1e-13 * (std::abs(su) + std::abs(sv)) * t.reach;
  const Interval rest = (slope_u - Interval(su)) * w + (slope_v - Interval(sv)) * v +
                        t.a * square(w) + t.b * w * v + t.e * vv + Interval(-rounding, rounding);
  const Interval bounds = at + rest;
  // The bounds' own zeros must not leave the strip.
  const double tilt = std::abs(sv) * t.reach;
  if (su * (zeros.lo - u0) + tilt + bounds.lo > 0 || su * (zeros.hi - u0) - tilt + bounds.hi < 0) {
    const Interval strip = -zeros + Interval(-1e-13, 1e-13);
    return Slab{strip, t.nx / c.hx, t.ny / c.hy};
  }
  const double dx = su * t.nx - sv * t.ny, dy = su * t.ny + sv * t.nx;
  return Slab{bounds - Interval(su) * Interval(u0), dx / c.hx, dy / c.hy};
}

}  // namespace

Slab slab_over(const Quadratic& p, const Rect& rect) {
  const Centered c = center(p, rect);
  const std::optional<Slab> narrow = narrow_slab(c);
  return narrow ? *narrow : plain_slab(c);
}

}  // namespace arris
