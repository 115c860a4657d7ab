// short_arc.h — the nearest place on a short arc of an ellipse, without sines
// What       about the arc's middle an angle is its cosine and sine; Newton's steps turn it
// Legend     x(θ) = center + a cos θ + b sin θ, |θ| ≤ half; (c, s) = (cos θ, sin θ)
#pragma once

#include "arris/math.h"
#include "rounding/crease_curve.h"

namespace arris {

struct Turn {
  double c = 1, s = 0;
};

class ShortArc {
 public:
  ShortArc() = default;
  // An ellipse's arc of less than half a turn.
  explicit ShortArc(const CreaseCurve& arc);

  [[nodiscard]] Vec3d at(Turn turn) const { return center_ + a_ * turn.c + b_ * turn.s; }
  // The arc's own u; its ends' exactly.
  [[nodiscard]] double parameter(Turn turn) const;
  // Quick where it is near `guess`.
  [[nodiscard]] Turn nearest(Vec3d x, Turn guess) const;

 private:
  [[nodiscard]] Turn clamped(Turn turn) const;

  CreaseCurve arc_;
  Vec3d center_, a_, b_;
  Vec3d p0_, p1_;
  double middle_ = 0;
  Turn half_;
  double difference_ = 0, product_ = 0;  // b·b − a·a, a·b
};

}  // namespace arris
