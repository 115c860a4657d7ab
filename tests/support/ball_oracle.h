// ball_oracle.h — rounding by its definition, for solids of any shape
// What       P minus its opening is what no ball of the radius within P covers. margin(x) says by how much the largest
//            ball that covers x and fits, of those of this radius, fits: the most that the distance to the surface
//            can be within r of x, less r. Above 0, x is in opening(P); below, it is in the void.
//            For the space outside P, what no ball outside it covers is a fillet.
// Limits     a search by chance: the margin may come out too small, by little
// Cost       thousands of distances to all triangles
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"

namespace arris::oracle {

enum class Space { inside, outside };

class BallOracle {
 public:
  BallOracle(const MeshView& mesh, double radius, Space space = Space::inside)
      : r_(radius), sign_(space == Space::inside ? 1 : -1) {
    for (const Triangle& t : mesh.triangles) {
      triangles_.push_back(
          {Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])});
    }
  }

  // To the surface; negative where the space is not.
  [[nodiscard]] double depth(Vec3d x) const {
    double least = INFINITY, angle = 0;
    for (const Corners& t : triangles_) {
      least = std::min(least, length(x - nearest(x, t)));
      angle += solid_angle(x, t);
    }
    return sign_ * (angle > 2 * kPi ? least : -least);
  }

  template <class Random>
  [[nodiscard]] double margin(Vec3d x, Random& rng) const {
    double best = depth(x) - r_;
    for (int start = 0; start < 6 && best < 0; ++start) {
      Vec3d c = x + in_ball(rng) * r_;
      double at = depth(c);
      for (double step = r_; step > 1e-4 * r_; step *= 0.85) {
        for (int i = 0; i < 6; ++i) {
          Vec3d d = c + in_ball(rng) * step;
          if (const double away = length(d - x); away > r_) d = x + (d - x) * (r_ / away);
          const double there = depth(d);
          if (there <= at) continue;
          at = there;
          c = d;
        }
      }
      best = std::max(best, at - r_);
    }
    return best;
  }

 private:
  struct Corners {
    Vec3d p0, p1, p2;
  };

  template <class Random>
  static Vec3d in_ball(Random& rng) {
    std::uniform_real_distribution<double> any(-1, 1);
    for (;;) {
      const Vec3d v{any(rng), any(rng), any(rng)};
      if (length_squared(v) <= 1) return v;
    }
  }

  // Of the plane's foot and those of the three sides, which is enough though not fast.
  static Vec3d nearest(Vec3d x, const Corners& t) {
    const Vec3d n = cross(t.p1 - t.p0, t.p2 - t.p0);
    const Vec3d foot = x - n * (dot(x - t.p0, n) / length_squared(n));
    const auto is_left = [&](Vec3d a, Vec3d b) { return dot(cross(b - a, foot - a), n) >= 0; };
    if (is_left(t.p0, t.p1) && is_left(t.p1, t.p2) && is_left(t.p2, t.p0)) return foot;
    Vec3d best = t.p0;
    const auto try_side = [&](Vec3d a, Vec3d b) {
      const double u = std::clamp(dot(x - a, b - a) / length_squared(b - a), 0.0, 1.0);
      const Vec3d p = a + (b - a) * u;
      if (length_squared(x - p) < length_squared(x - best)) best = p;
    };
    try_side(t.p0, t.p1);
    try_side(t.p1, t.p2);
    try_side(t.p2, t.p0);
    return best;
  }

  // A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle" (1983). Positive from inside.
  static double solid_angle(Vec3d x, const Corners& t) {
    const Vec3d a = t.p0 - x, b = t.p1 - x, c = t.p2 - x;
    const double la = length(a), lb = length(b), lc = length(c);
    const double y = dot(a, cross(b, c));
    const double d = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2 * std::atan2(y, d);
  }

  std::vector<Corners> triangles_;
  double r_, sign_;
};

}  // namespace arris::oracle
