// short_arc.h — the nearest place on a short arc of an ellipse, without sines, and where a way comes near to it
// What       about the arc's middle an angle is its cosine and sine; Newton's steps turn it
// Legend     x(θ) = center + a cos θ + b sin θ, |θ| ≤ half; (c, s) = (cos θ, sin θ)
#pragma once

#include <optional>

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
  // From x along a unit direction, between two places of the way: the first one within r of the arc; and from one
  // within, the first one beyond.
  struct Crossing {
    double along;
    Turn turn;  // of the nearest place
  };
  [[nodiscard]] std::optional<Crossing> enter(Vec3d x, Vec3d direction, double from, double to,
                                              double r) const;
  [[nodiscard]] Crossing leave(Vec3d x, Vec3d direction, double from, double r) const;

 private:
  // A place on a way: the excess of its squared distance over r², and how that changes as if with the nearest point.
  struct Place {
    double along, excess, slope;
    Turn turn;
  };

  [[nodiscard]] Turn clamped(Turn turn) const;
  [[nodiscard]] Place place_at(Vec3d x, Vec3d direction, double along, double r, Turn guess) const;

  CreaseCurve arc_;
  Vec3d center_, a_, b_;
  Vec3d p0_, p1_;
  double middle_ = 0;
  Turn half_;
  double difference_ = 0, product_ = 0;  // b·b − a·a, a·b
};

}  // namespace arris
