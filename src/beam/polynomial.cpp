#include "beam/polynomial.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

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

Centered center(const Quadratic& p, const Rect& rect) {
  const double x = rect.middle_x(), y = rect.middle_y();
  Centered c{};
  c.hx = half_side(rect.x0, rect.x1, x);
  c.hy = half_side(rect.y0, rect.y1, y);
  const Interval ix(x), iy(y), hx(c.hx), hy(c.hy);
  c.value = p.c + ix * (p.x + p.xx * ix + p.xy * iy) + iy * (p.y + p.yy * iy);
  c.dx = (p.x + Interval(2) * p.xx * ix + p.xy * iy) * hx;
  c.dy = (p.y + Interval(2) * p.yy * iy + p.xy * ix) * hy;
  c.xx = p.xx * hx * hx;
  c.xy = p.xy * hx * hy;
  c.yy = p.yy * hy * hy;
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

Interval range_over(const Quadratic& p, const Rect& rect) {
  const Centered c = center(p, rect);
  return c.value + parabola_range(c.xx, c.dx) + parabola_range(c.yy, c.dy) + symmetric(c.xy);
}

Slab slab_over(const Quadratic& p, const Rect& rect) {
  const Centered c = center(p, rect);
  const double dx = (c.dx.lo / 2 + c.dx.hi / 2) / c.hx, dy = (c.dy.lo / 2 + c.dy.hi / 2) / c.hy;
  const Interval unit_square(0, 1);
  const Interval rest = symmetric(c.dx - Interval(dx) * Interval(c.hx)) +
                        symmetric(c.dy - Interval(dy) * Interval(c.hy)) + c.xx * unit_square +
                        c.yy * unit_square + symmetric(c.xy);
  return {c.value + rest, dx, dy};
}

}  // namespace arris
