// trigonometry.h — short polynomials for hot loops; no library calls, no tables
// Guarantee  absolute errors below 3e-7 (sine, cosine) and 1e-6 (angles) (tests/base/trigonometry_test.cpp)
// Source     acos: Abramowitz and Stegun, "Handbook of Mathematical Functions", 4.4.46
#pragma once

#include <cmath>
#include <cstdint>

#include "arris/math.h"

namespace arris {

// {cos(2πu), sin(2πu)} for u in [0, 1].
inline Vec2f unit_circle(float u) {
  const float quarter_turns = u * 4.0F;
  const auto quadrant = std::int32_t(quarter_turns + 0.5F);
  const float a = (quarter_turns - float(quadrant)) * 1.57079633F;  // -π/4 … π/4
  const float a2 = a * a;
  const float s = a * (1.0F + a2 * (-1.66666667e-1F + a2 * (8.3333310e-3F - a2 * 1.9840874e-4F +
                                                            a2 * a2 * 2.7525562e-6F)));
  const float c =
      1.0F + a2 * (-0.5F + a2 * (4.16666418e-2F - a2 * 1.3888397e-3F + a2 * a2 * 2.4760495e-5F));
  const bool odd = (quadrant & 1) != 0;
  const float x = odd ? s : c;
  const float y = odd ? c : s;
  return {((quadrant + 1) & 2) != 0 ? -x : x, (quadrant & 2) != 0 ? -y : y};
}

// Angle in [0, π] of the cosine x in [-1, 1].
inline float angle_of_cosine(float x) {
  const float a = std::fabs(x);
  const float p =
      1.5707963050F +
      a * (-0.2145988016F +
           a * (0.0889789874F +
                a * (-0.0501743046F +
                     a * (0.0308918810F +
                          a * (-0.0170881256F + a * (0.0066700901F - a * 0.0012624911F))))));
  const float r = std::sqrt(a < 1.0F ? 1.0F - a : 0.0F) * p;
  return x < 0.0F ? 3.14159265F - r : r;
}

// Angle of (x, y) as a share of the full turn, in [0, 1); 0 for the zero vector.
inline float turn_of(float y, float x) {
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float large = ax > ay ? ax : ay;
  const float q = large > 0.0F ? (ax > ay ? ay : ax) / large : 0.0F;
  const float q2 = q * q;
  // Odd polynomial for arctan(q)/2π on [0, 1]; Remez, error 3e-7 rad.
  float turn =
      q * (0.15915432F +
           q2 * (-0.05302624F +
                 q2 * (0.03152512F +
                       q2 * (-0.02106152F +
                             q2 * (0.01267250F + q2 * (-0.00534828F + q2 * 0.00108413F))))));
  turn = ay > ax ? 0.25F - turn : turn;
  turn = x < 0.0F ? 0.5F - turn : turn;
  turn = y < 0.0F ? 1.0F - turn : turn;
  return turn < 1.0F ? turn : 0.0F;
}

}  // namespace arris
