#include "rounding/short_arc.h"

#include <cmath>

namespace arris {

ShortArc::ShortArc(const CreaseCurve& arc) : arc_(arc), center_(arc.center) {
  middle_ = 0.5 * (arc.u0 + arc.u1);
  const double half = 0.5 * (arc.u1 - arc.u0);
  half_ = {std::cos(half), std::sin(half)};
  a_ = arc.at(middle_) - center_;
  b_ = arc.derivative(middle_);
  p0_ = arc.at(arc.u0);
  p1_ = arc.at(arc.u1);
  difference_ = length_squared(b_) - length_squared(a_);
  product_ = dot(a_, b_);
}

double ShortArc::parameter(Turn turn) const {
  if (turn.s <= -half_.s) return arc_.u0;
  if (turn.s >= half_.s) return arc_.u1;
  return middle_ + std::asin(turn.s);
}

Turn ShortArc::clamped(Turn turn) const {
  if (turn.s > half_.s) return half_;
  if (turn.s < -half_.s) return {half_.c, -half_.s};
  return turn;
}

Turn ShortArc::nearest(Vec3d x, Turn guess) const {
  constexpr int kMostSteps = 6;
  constexpr double kConverged = 1e-12;
  const Vec3d offset = x - center_;
  const double p = dot(offset, a_), q = dot(offset, b_);
  Turn at = guess;
  for (int k = 0; k < kMostSteps; ++k) {
    const auto [c, s] = at;
    // Half of the squared distance, derived once and twice.
    const double cosine2 = c * c - s * s;
    const double slope = difference_ * s * c + product_ * cosine2 + p * s - q * c;
    const double bend = difference_ * cosine2 - 4 * product_ * s * c + p * c + q * s;
    if (!(bend > 0)) break;
    const double turn = -slope / bend;
    if (!(std::abs(turn) < 1)) break;
    const double scale = 1 / std::sqrt(1 + turn * turn);
    const Turn next = clamped({(c - turn * s) * scale, (s + turn * c) * scale});
    if (std::abs(next.s - s) < kConverged) {
      // Another minimum may be at an end.
      const double here = length_squared(this->at(next) - x);
      if (here > length_squared(p0_ - x) || here > length_squared(p1_ - x)) break;
      return next;
    }
    at = next;
  }
  const double u = nearest_parameter(arc_, x) - middle_;
  return {std::cos(u), std::sin(u)};
}

}  // namespace arris
