#include "beam/taylor_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/csg_oracle.h"

namespace arris::test {
namespace {

// A function that a Quadratic stands for: its middle coefficients, and a rest that varies within c.
struct Sampled {
  TaylorModel form;
  double c, x, y, xx, xy, yy, rest;
  [[nodiscard]] double at(double u, double v) const {
    return c + x * u + y * v + xx * u * u + xy * u * v + yy * v * v +
           rest * std::cos(7 * u + 3 * v);
  }
};

Sampled random_model(CsgRandom& random, double c) {
  const auto any = [&](double most) { return uniform(random, -most, most); };
  const double x = any(0.6), y = any(0.6), xx = any(0.2), xy = any(0.2), yy = any(0.2);
  const double rest = uniform(random, 0, 1) < 0.5 ? 0 : uniform(random, 0, 0.1);
  return {{c, x, y, xx, xy, yy, rest}, c, x, y, xx, xy, yy, rest};
}

void expect_holds(const TaylorModel& a, double u, double v, double value) {
  const double slack = 1e-14 * (1 + std::abs(value));  // of the value itself
  const Interval at = range_over(Quadratic(a), {u, v, u, v}), whole = range_of(a);
  EXPECT_LE(whole.lo, value + slack);
  EXPECT_GE(whole.hi, value - slack);
  EXPECT_LE(at.lo, value + slack);
  EXPECT_GE(at.hi, value - slack);
}

TEST(taylor_model, operations_hold_functions_of_their_operands) {
  CsgRandom random(5);
  int series = 0;
  for (int i = 0; i < 2000; ++i) {
    const Sampled a = random_model(random, uniform(random, -2, 4));
    const Sampled b = random_model(random, uniform(random, -2, 4));
    const TaylorModel times = a.form * b.form, squares = squared(a.form);
    const TaylorModel root = square_root(a.form);
    const std::optional<TaylorModel> inverse = reciprocal(a.form);
    for (int k = 0; k < 25; ++k) {
      const double u = k < 4 ? (k % 2) * 2 - 1 : uniform(random, -1, 1);
      const double v = k < 4 ? (k / 2) * 2 - 1 : uniform(random, -1, 1);
      const double p = a.at(u, v), q = b.at(u, v);
      expect_holds(times, u, v, p * q);
      expect_holds(squares, u, v, p * p);
      if (p >= 0) expect_holds(root, u, v, std::sqrt(p));
      if (inverse) expect_holds(*inverse, u, v, 1 / p);
      series += inverse && inverse->rest < 0.01 ? 1 : 0;
    }
  }
  EXPECT_GT(series, 1000);
}

TEST(taylor_model, what_is_lost_shrinks_with_the_cube_of_the_side) {
  double before = 0;
  for (const double side : {0.5, 0.25, 0.125, 0.0625}) {
    const TaylorModel a{3, side, -0.5 * side, 0.3 * side * side, 0, 0, 0};
    const TaylorModel b{2, -0.3 * side, side, 0, 0.2 * side * side, 0, 0};
    const double lost = (a * b).rest + reciprocal(a)->rest + square_root(a).rest;
    if (before > 0) {
      EXPECT_LT(lost, before / 6.5);
    }
    before = lost;
  }
}

TEST(taylor_model, a_reciprocal_of_what_may_be_zero_is_none) {
  EXPECT_FALSE(reciprocal({0.5, 0.5}).has_value());
  EXPECT_FALSE(reciprocal({0.5, 0.4, 0.2}).has_value());
  EXPECT_TRUE(reciprocal({-0.5, 0.3, 0.1}).has_value());
}

TEST(taylor_model, the_root_of_what_is_no_number_is_not_known) {
  const TaylorModel lost = squared(TaylorModel{3e200}) - squared(TaylorModel{2e200});
  const Interval root = range_of(square_root(lost));
  EXPECT_FALSE(root.lo > 0 || root.hi < 1e200);
}

TEST(taylor_model, polynomials_over_the_square_are_those_over_the_picture) {
  CsgRandom random(6);
  for (int i = 0; i < 500; ++i) {
    const double x = uniform(random, 0, 2000), y = uniform(random, 0, 2000);
    const double side = std::exp2(-int(random() % 8));
    const Rect rect{x, y, x + side, y + side};
    const auto value = [&] { return Interval(uniform(random, -1, 1)); };
    Quadratic over_square(value(), value(), value(), value(), value(), value());
    over_square.c = over_square.c + Interval(-0.01, 0.01);
    const Quadratic over_picture = on_picture(over_square, rect);
    for (int k = 0; k < 20; ++k) {
      const double u = uniform(random, -1, 1), v = uniform(random, -1, 1);
      const double px = rect.middle_x() + u * side / 2, py = rect.middle_y() + v * side / 2;
      const Interval a = range_over(over_square, {u, v, u, v});
      const Interval b = range_over(over_picture, {px, py, px, py});
      EXPECT_LE(b.lo, a.lo + 1e-9);
      EXPECT_GE(b.hi, a.hi - 1e-9);
    }
  }
}

}  // namespace
}  // namespace arris::test
