// Intervals contain what they must and little else.
#include "base/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace arris {
namespace {

using Random = std::mt19937_64;

double random_number(Random& random) {
  const double size = std::exp2(std::uniform_real_distribution<double>(-40, 40)(random));
  return std::uniform_real_distribution<double>(-1, 1)(random) * size;
}

Interval random_interval(Random& random) {
  const double a = random_number(random);
  if (random() % 8 == 0) return a;
  const double b = random() % 2 == 0 ? random_number(random) : a * (1 + 1e-9);
  return {std::min(a, b), std::max(a, b)};
}

double inside(Interval a, Random& random) {
  const double u = std::uniform_real_distribution<double>(0, 1)(random);
  return random() % 4 == 0 ? (random() % 2 == 0 ? a.lo : a.hi)
                           : std::clamp(a.lo + u * (a.hi - a.lo), a.lo, a.hi);
}

// long double carries the exact products and sums of these doubles, or nearly so.
using Exact = long double;

TEST(interval, contains_every_result_of_its_operands) {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Interval a = random_interval(random), b = random_interval(random);
    const Interval sum = a + b, difference = a - b, product = a * b, quotient = a / b;
    for (int k = 0; k < 20; ++k) {
      const Exact x = inside(a, random), y = inside(b, random);
      ASSERT_TRUE(sum.lo <= x + y && x + y <= sum.hi);
      ASSERT_TRUE(difference.lo <= x - y && x - y <= difference.hi);
      ASSERT_TRUE(product.lo <= x * y && x * y <= product.hi);
      if (y != 0) {
        ASSERT_TRUE(quotient.lo <= x / y && x / y <= quotient.hi);
      }
      ASSERT_TRUE(square(a).lo <= x * x && x * x <= square(a).hi);
      ASSERT_TRUE(absolute(a).lo <= std::abs(x) && std::abs(x) <= absolute(a).hi);
      if (x >= 0) {
        ASSERT_TRUE(square_root(a).lo <= std::sqrt(x) && std::sqrt(x) <= square_root(a).hi);
      }
    }
  }
}

double ulps(double from, double to) {
  return std::abs(to - from) / std::max(std::abs(std::nextafter(from, INFINITY) - from), 1e-300);
}

TEST(interval, is_at_most_an_ulp_too_wide) {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const double x = random_number(random), y = random_number(random);
    const Interval a = x, b = y;
    for (const auto& [interval, value] :
         {std::pair{a + b, x + y}, {a - b, x - y}, {a * b, x * y}, {a / b, x / y}}) {
      ASSERT_LE(ulps(value, interval.lo), 2);
      ASSERT_LE(ulps(value, interval.hi), 2);
    }
    // The square knows that both factors are one number.
    const Interval wide{-std::abs(x), std::abs(x)};
    ASSERT_EQ(square(wide).lo, 0);
    ASSERT_LE(ulps(x * x, square(wide).hi), 2);
  }
}

TEST(interval, underflow_and_infinity_stay_sound) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_GT((Interval(tiny) * Interval(tiny)).hi, 0);
  EXPECT_LT((Interval(-tiny) * Interval(tiny)).lo, 0);
  EXPECT_GE((Interval(tiny) + Interval(tiny)).hi, 2 * tiny);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ((Interval(0, inf) * Interval(0, 1)).hi, inf);
  EXPECT_EQ((Interval(1) / Interval(-1, 1)).lo, -inf);
  EXPECT_FALSE(std::isnan((Interval(0) * Interval(-inf, inf)).lo));
  const double large = std::numeric_limits<double>::max();
  EXPECT_EQ((Interval(large) + Interval(large)).hi, inf);
}

}  // namespace
}  // namespace arris
