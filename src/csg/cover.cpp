#include "csg/cover.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

// max and min over |u| ≤ 1 of a u² + b u, for all a and b in the intervals. Both grow with a; the sign of b is that
// of u, so only |b| counts.
Interval parabola_range(Interval a, Interval b) {
  const double slope = std::max(std::abs(b.lo), std::abs(b.hi));
  double high = next_up(a.hi + slope), low = next_down(a.lo - slope);
  if (a.hi < 0 && slope < -2 * a.hi) high = (square(Interval(slope)) / Interval(-4 * a.hi)).hi;
  if (a.lo > 0 && slope < 2 * a.lo) low = (-(square(Interval(slope)) / Interval(4 * a.lo))).lo;
  return {std::min(low, 0.0), std::max(high, 0.0)};
}

Interval weighted_dot(const Vec3i& a, const Vec3i& b, Vec3d w) {
  return a.x * b.x * Interval(w.x) + a.y * b.y * Interval(w.y) + a.z * b.z * Interval(w.z);
}
Interval weighted_square(const Vec3i& a, Vec3d w) {
  return square(a.x) * Interval(w.x) + square(a.y) * Interval(w.y) + square(a.z) * Interval(w.z);
}

}  // namespace

Interval quadratic_range(const SpaceCell& cell, Vec3d weights) {
  Interval range = weighted_square(cell.center, weights);
  for (int i = 0; i < 3; ++i) {
    range += parabola_range(weighted_square(cell.half[i], weights),
                            Interval(2) * weighted_dot(cell.center, cell.half[i], weights));
    for (int j = 0; j < i; ++j) {
      const double mixed =
          absolute(Interval(2) * weighted_dot(cell.half[i], cell.half[j], weights)).hi;
      range += Interval(-mixed, mixed);
    }
  }
  return range;
}

std::optional<Interval> depths_in(const Box3d& box, const Vec3i& origin, const Vec3i& direction,
                                  double end) {
  Interval depths(0, end);
  // To where some value + t · slope ≤ 0.
  const auto cut = [&](Interval value, double slope) {
    const Interval limit = -Interval(value.lo) / Interval(slope);
    if (slope > 0) depths.hi = std::min(depths.hi, limit.hi);
    if (slope < 0) depths.lo = std::max(depths.lo, limit.lo);
    if (slope == 0 && value.lo > 0) depths.lo = std::numeric_limits<double>::infinity();
  };
  for (int k = 0; k < 3; ++k) {
    cut(Interval(origin[k].lo) - Interval(box.high[k]), direction[k].lo);
    cut(Interval(box.low[k]) - Interval(origin[k].hi), -direction[k].hi);
  }
  // Both ends infinite: an endless box that some axis leaves for good.
  return depths.lo <= depths.hi && depths.lo < std::numeric_limits<double>::infinity()
             ? std::optional(depths)
             : std::nullopt;
}

double radius_of(const SpaceCell& cell) {
  const Vec3i &x = cell.half[0], &y = cell.half[1], &z = cell.half[2];
  double squared = 0;
  for (const double v : {1.0, -1.0}) {
    for (const double w : {1.0, -1.0}) {
      const Vec3i corner = x + y * Interval(v) + z * Interval(w);
      squared = std::max(squared, weighted_square(corner, Vec3d(1)).hi);
    }
  }
  return next_up(std::sqrt(squared));
}

}  // namespace arris
