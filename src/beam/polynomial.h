// polynomial.h — polynomials over the picture, with coefficients that are known between two doubles
// What       Linear and Quadratic are polynomials of the picture's x and y. All that a beam asks of planes and quadrics
//            is a sign of one of these (beam_view.h), and the outlines that it sees are their zeros.
// Guarantee  range_over() holds every value over the rectangle: of a Linear it is exact but for rounding, of a
//            Quadratic too, but for its mixed term (tests/beam/polynomial_test.cpp)
// Legend     c + x·x + y·y + xx·x² + xy·xy + yy·y²
#pragma once

#include <array>

#include "base/interval.h"

namespace arris {

// A part of the picture, in pixels; (0, 0) is the upper left corner.
struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double height() const { return y1 - y0; }
  [[nodiscard]] double area() const { return width() * height(); }
  [[nodiscard]] double middle_x() const { return x0 + (x1 - x0) / 2; }
  [[nodiscard]] double middle_y() const { return y0 + (y1 - y0) / 2; }
};

inline std::array<Rect, 4> quarters_of(const Rect& r) {
  const double x = r.middle_x(), y = r.middle_y();
  return {Rect{r.x0, r.y0, x, y}, Rect{x, r.y0, r.x1, y}, Rect{r.x0, y, x, r.y1},
          Rect{x, y, r.x1, r.y1}};
}

struct Linear {
  Interval c, x, y;

  friend Linear operator+(const Linear& a, const Linear& b) {
    return {a.c + b.c, a.x + b.x, a.y + b.y};
  }
  friend Linear operator-(const Linear& a, const Linear& b) {
    return {a.c - b.c, a.x - b.x, a.y - b.y};
  }
  friend Linear operator*(const Linear& a, Interval s) { return {a.c * s, a.x * s, a.y * s}; }
  Linear operator-() const { return {-c, -x, -y}; }
};

struct Quadratic {
  Interval c, x, y, xx, xy, yy;

  Quadratic() = default;
  Quadratic(Interval c_, Interval x_, Interval y_, Interval xx_, Interval xy_, Interval yy_)
      : c(c_), x(x_), y(y_), xx(xx_), xy(xy_), yy(yy_) {}
  explicit Quadratic(const Linear& a) : c(a.c), x(a.x), y(a.y) {}

  friend Quadratic operator+(const Quadratic& a, const Quadratic& b) {
    return {a.c + b.c, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  friend Quadratic operator-(const Quadratic& a, const Quadratic& b) {
    return {a.c - b.c, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  }
  friend Quadratic operator*(const Quadratic& a, Interval s) {
    return {a.c * s, a.x * s, a.y * s, a.xx * s, a.xy * s, a.yy * s};
  }
  Quadratic operator-() const { return {-c, -x, -y, -xx, -xy, -yy}; }
};

inline Quadratic operator*(const Linear& a, const Linear& b) {
  return {a.c * b.c, a.c * b.x + a.x * b.c, a.c * b.y + a.y * b.c,
          a.x * b.x, a.x * b.y + a.y * b.x, a.y * b.y};
}
inline Quadratic squared(const Linear& a) {
  return {square(a.c), Interval(2) * a.c * a.x, Interval(2) * a.c * a.y,
          square(a.x), Interval(2) * a.x * a.y, square(a.y)};
}

Interval range_over(const Linear& p, const Rect& rect);
Interval range_over(const Quadratic& p, const Rect& rect);
Interval value_at(const Quadratic& p, double x, double y);

// Are all its values over the rectangle rounding? Cutting the rectangle then tells no more.
bool is_noise(const Quadratic& p, const Rect& rect);

// Two planes, value + dx (x - middle) + dy (y - middle) for both ends of value: in the rectangle p is positive where
// the lower one is, and negative where the upper one is.
struct Slab {
  Interval value;
  double dx = 0, dy = 0;
};
Slab slab_over(const Quadratic& p, const Rect& rect);

}  // namespace arris
