#include "base/trigonometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arris {
namespace {

constexpr int kSteps = 100'000;

TEST(Trigonometry, unit_circle_is_cosine_and_sine) {
  for (int i = 0; i <= kSteps; ++i) {
    const float u = float(i) / kSteps;
    const Vec2f c = unit_circle(u);
    ASSERT_NEAR(double(c.x), std::cos(2 * kPi * double(u)), 3e-7) << u;
    ASSERT_NEAR(double(c.y), std::sin(2 * kPi * double(u)), 3e-7) << u;
  }
}

TEST(Trigonometry, angle_of_cosine_is_arccosine) {
  for (int i = -kSteps; i <= kSteps; ++i) {
    const float x = float(i) / kSteps;
    ASSERT_NEAR(double(angle_of_cosine(x)), std::acos(double(x)), 1e-6) << x;
  }
}

TEST(Trigonometry, turn_is_arctangent_over_two_pi) {
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * kPi * i / kSteps;
    const float turn = turn_of(float(3 * std::sin(angle)), float(3 * std::cos(angle)));
    ASSERT_GE(turn, 0.0F);
    ASSERT_LT(turn, 1.0F);
    const double difference = double(turn) * 2 * kPi - angle;
    ASSERT_NEAR(std::remainder(difference, 2 * kPi), 0.0, 1e-6) << angle;
  }
  EXPECT_EQ(turn_of(0, 0), 0.0F);
}

}  // namespace
}  // namespace arris
