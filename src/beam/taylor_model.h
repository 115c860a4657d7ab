// taylor_model.h — functions over a part of the picture, as quadratic polynomials and a bounded rest
// What       A Quadratic whose c is an interval stands for any function that differs from it by no more than that
//            interval is wide, at every point of kUnitSquare. Sums are those of polynomial.h; products, quotients and
//            roots are quadratic again, with what is lost in c: third order in the size of the part of the picture, as
//            that is what the square's sides stand for.
// Guarantee  containment at each point of the square (tests/beam/taylor_model_test.cpp)
// Source     K. Makino and M. Berz, "Taylor Models and Other Validated Functional Inclusion Methods", 2003; where a
//            root's or quotient's series is poor, Chebyshev's linear approximation
#pragma once

#include <optional>

#include "arris/math.h"
#include "beam/polynomial.h"

namespace arris {

inline constexpr Rect kUnitSquare{-1, -1, 1, 1};

using QuadraticVec = Vec3<Quadratic>;

// c + per_x x + per_y y, where the square stands for the rectangle.
Quadratic linear_over(const Rect& rect, Interval c, Interval per_x, Interval per_y);
inline Quadratic constant_model(Interval c) {
  return Quadratic(Linear{c, 0, 0});
}

Quadratic product(const Quadratic& a, const Quadratic& b);
Quadratic squared(const Quadratic& a);
// Nothing: it may be 0.
std::optional<Quadratic> reciprocal(const Quadratic& a);
// Where it is not negative.
Quadratic square_root(const Quadratic& a);

QuadraticVec scaled(const QuadraticVec& v, const Quadratic& s);
QuadraticVec scaled(const QuadraticVec& v, Interval s);
Quadratic dot_of(const QuadraticVec& a, const QuadraticVec& b);
QuadraticVec map_vector(const Mat3d& m, const QuadraticVec& v);
QuadraticVec map_point(const Affine3d& m, const QuadraticVec& p);
Vec3<Interval> ranges_of(const QuadraticVec& v);

// The polynomial over the square as one over the picture, valid in the rectangle that the square stands for.
Quadratic on_picture(const Quadratic& a, const Rect& rect);
}  // namespace arris
