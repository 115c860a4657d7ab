// taylor_model.h — functions over a part of the picture, as quadratic polynomials and a bounded rest
// What       A TaylorModel stands for any function that differs from its polynomial by no more than `rest` at every
//            point of kUnitSquare, whose sides are those of the part of the picture. Sums, products, quotients, roots
//            are models again; what is lost, and all rounding, goes into the rest: third order in the size of the part.
// Guarantee  containment at each point of the square (tests/beam/taylor_model_test.cpp)
// Cost       a product is about 60 floating-point operations: a sixth of that of intervals' polynomials
// Source     K. Makino and M. Berz, "Taylor Models and Other Validated Functional Inclusion Methods", 2003; where a
//            root's or quotient's series is poor, Chebyshev's linear approximation
#pragma once

#include <optional>

#include "arris/math.h"
#include "beam/polynomial.h"

namespace arris {

inline constexpr Rect kUnitSquare{-1, -1, 1, 1};

struct TaylorModel {
  double c = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  double rest = 0;

  // Its rest is in c: holds over kUnitSquare only.
  explicit operator Quadratic() const;
};
using ModelVec = Vec3<TaylorModel>;

TaylorModel constant_model(Interval c);
// c + per_x x + per_y y, where the square stands for the rectangle.
TaylorModel linear_over(const Rect& rect, double c, double per_x, double per_y);

TaylorModel operator+(const TaylorModel& a, const TaylorModel& b);
TaylorModel operator-(const TaylorModel& a, const TaylorModel& b);
TaylorModel operator-(const TaylorModel& a);
TaylorModel operator*(const TaylorModel& a, double s);
TaylorModel operator*(const TaylorModel& a, const TaylorModel& b);
TaylorModel squared(const TaylorModel& a);
// Nothing: it may be 0.
std::optional<TaylorModel> reciprocal(const TaylorModel& a);
// Where it is not negative.
TaylorModel square_root(const TaylorModel& a);

// Precondition: `rect` is kUnitSquare.
Interval range_over(const TaylorModel& a, const Rect& rect);
inline Interval range_of(const TaylorModel& a) {
  return range_over(a, kUnitSquare);
}

ModelVec scaled(const ModelVec& v, double s);
TaylorModel dot_of(Vec3d n, const ModelVec& v);
ModelVec map_vector(const Mat3d& m, const ModelVec& v);
ModelVec map_point(const Affine3d& m, const ModelVec& p);
Vec3<Interval> ranges_of(const ModelVec& v);

// A polynomial over the square, of which no coefficient but c is uncertain, as one over the picture; valid in the
// rectangle that the square stands for.
Quadratic on_picture(const Quadratic& q, const Rect& rect);

}  // namespace arris
