#include "beam/polynomial.h"

#include <gtest/gtest.h>

#include <random>

namespace arris::test {
namespace {

double value(const Quadratic& p, double x, double y) {
  return p.c.lo + p.x.lo * x + p.y.lo * y + p.xx.lo * x * x + p.xy.lo * x * y + p.yy.lo * y * y;
}

TEST(polynomial, ranges_and_slabs_hold_the_values) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  double wide = 0, open = 0;
  for (int i = 0; i < 3000; ++i) {
    const double x0 = uniform(-3, 3), y0 = uniform(-3, 3), side = uniform(0.01, 1);
    const Rect rect{x0, y0, x0 + side, y0 + side};
    Quadratic p(uniform(-2, 2), uniform(-2, 2), uniform(-2, 2), uniform(-1, 1), uniform(-1, 1),
                uniform(-1, 1));
    // Through the rectangle, so that there is something to bound.
    p.c = p.c - Interval(value(p, rect.middle_x(), rect.middle_y()));
    p.c = Interval(p.c.lo);
    const Interval range = range_over(p, rect);
    const Slab slab = slab_over(p, rect);
    double low = INFINITY, high = -INFINITY;
    int undecided = 0;
    for (int k = 0; k < 400; ++k) {
      const double x = k < 4 ? (k % 2 == 0 ? rect.x0 : rect.x1) : uniform(rect.x0, rect.x1);
      const double y = k < 4 ? (k < 2 ? rect.y0 : rect.y1) : uniform(rect.y0, rect.y1);
      const double v = value(p, x, y);
      low = std::min(low, v);
      high = std::max(high, v);
      const double line = slab.dx * (x - rect.middle_x()) + slab.dy * (y - rect.middle_y());
      ASSERT_TRUE(range.lo <= v + 1e-12 && v - 1e-12 <= range.hi) << i;
      if (line + slab.value.lo > 1e-12) ASSERT_GT(v, -1e-12) << i;
      if (line + slab.value.hi < -1e-12) ASSERT_LT(v, 1e-12) << i;
      undecided += line + slab.value.lo <= 0 && line + slab.value.hi >= 0 ? 1 : 0;
    }
    wide += (range.hi - range.lo) / (high - low);
    open += undecided / 400.0;
  }
  EXPECT_LT(wide / 3000, 1.5);
  EXPECT_LT(open / 3000, 0.2);
}

TEST(polynomial, slabs_of_two_lines_are_as_thin_as_those_of_one) {
  // (x - 0.1)(x - 0.9) near x = 0.1
  const Quadratic p(0.09, -1.0, 0, 1, 0, 0);
  const Slab slab = slab_over(p, {0, 0, 0.3, 0.3});
  EXPECT_LT((slab.value.hi - slab.value.lo) / std::abs(slab.dx), 1e-6);
}

}  // namespace
}  // namespace arris::test
