#include "rounding/short_arc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace arris {
namespace {

// Of r²: distances whose squares differ by less are one.
constexpr double kClose = 2e-9;

// The first root of c + b u + u² that is not behind.
std::optional<double> first_root(double b, double c) {
  const double discriminant = b * b - 4 * c;
  if (b >= 0 || discriminant < 0) return std::nullopt;
  return 2 * c / (std::sqrt(discriminant) - b);
}

}  // namespace

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

ShortArc::Place ShortArc::place_at(Vec3d x, Vec3d direction, double along, double r,
                                   Turn guess) const {
  const Vec3d y = x + direction * along;
  const Turn turn = nearest(y, guess);
  const Vec3d away = y - at(turn);
  return {along, length_squared(away) - r * r, 2 * dot(away, direction), turn};
}

// Along a way the squared distance to a point is s² and a linear function, that to the arc s² and the least of such: a
// concave one. Between two places it is above their chord, which bounds the distance from below; the ball about the
// nearest point of the arc bounds it from above.
std::optional<ShortArc::Crossing> ShortArc::enter(Vec3d x, Vec3d direction, double from, double to,
                                                  double r) const {
  constexpr int kMostSteps = 200;
  constexpr std::size_t kMostEnds = 32;
  if (from > to) return std::nullopt;
  Place begin = place_at(x, direction, from, r, {});
  // Of the stretches ahead, the next one last.
  std::array<Place, kMostEnds> ends{place_at(x, direction, to, r, begin.turn)};
  std::size_t count = 1;
  for (int step = 0; step < kMostSteps && count > 0; ++step) {
    if (begin.excess <= kClose * r * r) return Crossing{begin.along, begin.turn};
    const Place& end = ends[count - 1];
    const double extent = end.along - begin.along;
    std::optional<double> ahead;
    if (extent > 0) {
      ahead = first_root((end.excess - begin.excess) / extent - extent, begin.excess);
    }
    if (!ahead || *ahead > extent) {
      begin = end;
      --count;
      continue;
    }
    begin = place_at(x, direction, begin.along + *ahead, r, begin.turn);
    const double rest = extent - *ahead;
    // Into the ball, or to where the way passes it; no farther than halfway, so that chords get short.
    double split = first_root(begin.slope, begin.excess).value_or(-0.5 * begin.slope);
    split = split > 0 ? std::min(split, 0.5 * rest) : 0.5 * rest;
    if (split > kClose * r && count < kMostEnds) {
      ends[count++] = place_at(x, direction, begin.along + split, r, begin.turn);
    }
  }
  if (begin.excess <= kClose * r * r) return Crossing{begin.along, begin.turn};
  return std::nullopt;
}

// From ball to ball, each about the point that is nearest where the way leaves the one before. On ways that touch, a
// little at a time.
ShortArc::Crossing ShortArc::leave(Vec3d x, Vec3d direction, double from, double r) const {
  constexpr int kMostSteps = 200;
  constexpr double kLeastStep = 1e-6;
  Place place = place_at(x, direction, from, r, {});
  for (int step = 0; step < kMostSteps; ++step) {
    const double half = 0.5 * place.slope;
    const double rest = std::sqrt(std::max(half * half - place.excess, 0.0)) - half;
    const bool is_close = !(rest > kLeastStep * r);
    const Place next =
        place_at(x, direction, place.along + std::max(rest, kLeastStep * r), r, place.turn);
    if (is_close && !(next.excess <= kClose * r * r)) break;
    place = next;
  }
  return {place.along, place.turn};
}

}  // namespace arris
