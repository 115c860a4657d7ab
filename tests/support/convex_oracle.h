// convex_oracle.h — the rounded convex solid by its definition, for judging the fast kernel
// What       P = {x : n_k·x ≤ d_k}; opening(P), the union of all balls of radius r inside P, is the
// set of
//            points within r of the erosion E = {x : n_k·x ≤ d_k − r}. Here are the distance to E,
//            the first crossing of a ray with opening(P), the inradius, and a slow second opinion.
// Guarantee  distances to about 1e-12 of the solid's size (tests/rounding/convex_oracle_test.cpp);
// knows
//            nothing of edges, cylinders or spheres
// Limits     tens to hundreds of planes; E must not be empty
// Cost       a projection is a few passes over the planes, a ray up to about 60 projections
// Source     D. Goldfarb, A. Idnani, "A numerically stable dual method for solving strictly convex
//            quadratic programs", 1983, for the projection onto E
// Legend     E erosion, n_k d_k planes, c nearest point of E, u multipliers, A active planes, g =
// dist − r
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"

namespace arris::oracle {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Plane {
  Vec3d normal;  // unit, outward
  double offset = 0;
};

// Planes are relative to `center`, a point near the middle of the solid, so that a solid far from
// the origin loses no digits.
struct ConvexSolid {
  std::vector<Plane> planes;
  Vec3d center;
  double size = 1;  // largest extent of the bounding box
};

// Planes active at the current point, at most three in space.
struct ActiveSet {
  std::array<std::size_t, 3> plane{};
  std::array<double, 3> multiplier{};
  int count = 0;

  void add(std::size_t k, double u) {
    plane[std::size_t(count)] = k;
    multiplier[std::size_t(count)] = u;
    ++count;
  }
  void drop(int at) {
    for (int i = at; i + 1 < count; ++i) {
      plane[std::size_t(i)] = plane[std::size_t(i) + 1];
      multiplier[std::size_t(i)] = multiplier[std::size_t(i) + 1];
    }
    --count;
  }
};

// n = rest + Σ coefficient_i n_i with rest orthogonal to the active normals.
struct Decomposition {
  Vec3d rest;
  std::array<double, 3> coefficient{};
};

// Gram–Schmidt over the active normals, then back substitution.
inline Decomposition decompose(std::span<const Plane> planes, const ActiveSet& active, Vec3d n) {
  std::array<Vec3d, 3> q;                    // orthonormal
  std::array<std::array<double, 3>, 3> r{};  // n_i = Σ_j r[i][j] q_j
  std::array<double, 3> along{};
  Decomposition d{n, {}};
  for (int i = 0; i < active.count; ++i) {
    Vec3d v = planes[active.plane[std::size_t(i)]].normal;
    for (int j = 0; j < i; ++j) {
      r[std::size_t(i)][std::size_t(j)] = dot(v, q[std::size_t(j)]);
      v -= q[std::size_t(j)] * r[std::size_t(i)][std::size_t(j)];
    }
    r[std::size_t(i)][std::size_t(i)] = length(v);
    q[std::size_t(i)] = normalize(v);
    along[std::size_t(i)] = dot(d.rest, q[std::size_t(i)]);
    d.rest -= q[std::size_t(i)] * along[std::size_t(i)];
  }
  for (int i = active.count - 1; i >= 0; --i) {
    const auto at = std::size_t(i);
    d.coefficient[at] = along[at] / r[at][at];
    for (int j = 0; j < i; ++j) along[std::size_t(j)] -= d.coefficient[at] * r[at][std::size_t(j)];
  }
  if (active.count == 3) d.rest = {};
  return d;
}

// The most violated plane of {n_k·c ≤ d_k − inset}, if any is violated by more than `tolerance`.
inline std::optional<std::size_t> find_violated(std::span<const Plane> planes, double inset,
                                                Vec3d c, double tolerance) {
  std::optional<std::size_t> worst;
  double most = tolerance;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const double over = dot(planes[k].normal, c) - (planes[k].offset - inset);
    if (over > most) {
      most = over;
      worst = k;
    }
  }
  return worst;
}

// Nearest point of {n_k·c ≤ d_k − inset} to x; empty if that set is.
inline std::optional<Vec3d> find_nearest(std::span<const Plane> planes, double inset, Vec3d x,
                                         double size) {
  constexpr double kParallel =
      1e-20;  // squared sine: planes closer than 1e-10 rad count as parallel
  const double tolerance = 1e-14 * size;
  ActiveSet active;
  Vec3d c = x;
  for (std::size_t round = 0; round < 20 * planes.size() + 200; ++round) {
    const auto violated = find_violated(planes, inset, c, tolerance);
    if (!violated) return c;
    const std::size_t p = *violated;
    const Vec3d n = planes[p].normal;
    double u = 0;
    for (;;) {
      const double over = dot(n, c) - (planes[p].offset - inset);
      const Decomposition d = decompose(planes, active, n);
      const double across = length_squared(d.rest);
      double step = across > kParallel ? over / across : kInfinity;
      int blocking = -1;
      for (int i = 0; i < active.count; ++i) {
        const double limit = active.multiplier[std::size_t(i)] / d.coefficient[std::size_t(i)];
        if (d.coefficient[std::size_t(i)] > 0 && limit < step) {
          step = limit;
          blocking = i;
        }
      }
      if (step == kInfinity) return std::nullopt;
      if (across > kParallel) c -= d.rest * step;
      u += step;
      for (int i = 0; i < active.count; ++i)
        active.multiplier[std::size_t(i)] -= step * d.coefficient[std::size_t(i)];
      if (blocking < 0) break;
      active.drop(blocking);
    }
    active.add(p, u);
  }
  return std::nullopt;
}

// Radius of the largest ball inside the solid.
inline double inradius(const ConvexSolid& solid) {
  double fits = 0, too_large = solid.size;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (fits + too_large);
    (find_nearest(solid.planes, r, {}, solid.size) ? fits : too_large) = r;
  }
  return fits;
}

struct OpeningHit {
  double t = 0;
  Vec3d normal;         // unit, outward
  bool inside = false;  // the ray starts in opening(P) and leaves it here
};

// opening(P) for one radius.
class Opening {
 public:
  Opening(ConvexSolid solid, double radius) : solid_(std::move(solid)), radius_(radius) {
    if (!find_nearest(solid_.planes, radius_, {}, solid_.size))
      throw std::invalid_argument("the radius is not smaller than the inradius");
  }

  [[nodiscard]] const ConvexSolid& solid() const { return solid_; }
  [[nodiscard]] double radius() const { return radius_; }

  // x minus its nearest point of E: its length is r on the surface, its direction the normal there.
  [[nodiscard]] Vec3d from_erosion(Vec3d x) const {
    const Vec3d local = x - solid_.center;
    const auto c = find_nearest(solid_.planes, radius_, local, solid_.size);
    if (!c) throw std::runtime_error("projection onto the erosion did not converge");
    return local - *c;
  }
  // dist(x, E) − r: at most 0 in opening(P); outside, the distance to it.
  [[nodiscard]] double distance(Vec3d x) const { return length(from_erosion(x)) - radius_; }
  [[nodiscard]] bool contains(Vec3d x) const { return distance(x) <= 0; }
  // True in P itself.
  [[nodiscard]] bool in_sharp_solid(Vec3d x) const {
    return !find_violated(solid_.planes, 0, x - solid_.center, 0);
  }

  // First crossing: where a ray from outside enters, where a ray from inside leaves.
  [[nodiscard]] std::optional<OpeningHit> intersect(const Ray& ray) const {
    const double speed = length(ray.direction);
    const Vec3d forward = ray.direction / speed;
    const bool inside = contains(ray.origin);
    std::optional<double> s;
    double at = 0;
    if (!inside) {
      s = find_entry(ray.origin, forward);
      if (s) at = *s;
    } else {
      // Where the reversed ray enters, from a point safely beyond the solid.
      const double far = length(ray.origin - solid_.center) + 4 * solid_.size;
      s = find_entry(ray.origin + forward * far, -forward);
      if (s) at = far - *s;
    }
    if (!s) return std::nullopt;
    return OpeningHit{at / speed, normalize(from_erosion(ray.origin + forward * at)), inside};
  }

  // Least distance(x) over the ray: by how much it misses, or (negative) how deep it goes.
  [[nodiscard]] double least_distance(const Ray& ray) const {
    const Vec3d forward = normalize(ray.direction);
    double near = 0, far = length(ray.origin - solid_.center) + 4 * solid_.size;
    for (int i = 0; i < 100; ++i) {
      const double s = 0.5 * (near + far);
      (dot(from_erosion(ray.origin + forward * s), forward) < 0 ? near : far) = s;
    }
    return std::min(distance(ray.origin), distance(ray.origin + forward * near));
  }

 private:
  // Newton's method on the convex function g(s) = dist(o + s·D, E) − r from its left: the steps
  // never pass the first root, and a ray whose distance stops shrinking misses.
  [[nodiscard]] std::optional<double> find_entry(Vec3d origin, Vec3d forward) const {
    const double enough = 2e-15 * (solid_.size + length(origin - solid_.center));
    double s = 0;
    for (int i = 0; i < 200; ++i) {
      const Vec3d v = from_erosion(origin + forward * s);
      const double far = length(v);
      const double g = far - radius_;
      if (g <= enough) return s;
      const double slope = dot(v, forward) / far;
      if (slope >= 0) return std::nullopt;
      const double step = -g / slope;
      if (!(step < 1e6 * solid_.size + length(origin - solid_.center))) return std::nullopt;
      s += step;
    }
    return s;  // a tangent: g is tiny and shrinks by half in each step
  }

  ConvexSolid solid_;
  double radius_;
};

// The definition taken literally, as a slow second opinion: the largest distance to the complement
// of P that the centre c of a ball containing x can have (|c − x| ≤ r). x is in opening(P) iff that
// is r or more.
inline double sampled_inside_distance(const ConvexSolid& solid, double radius, Vec3d x,
                                      std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> gauss;
  const Vec3d local = x - solid.center;
  const auto inside_distance = [&](Vec3d c) {
    double least = kInfinity;
    for (const Plane& p : solid.planes) least = std::min(least, p.offset - dot(p.normal, c));
    return least;
  };
  const auto into_ball = [&](Vec3d c) {
    const Vec3d v = c - local;
    const double far = length(v);
    return far > radius ? local + v * (radius / far) : c;
  };
  double best = -kInfinity;
  for (int restart = 0; restart < 4; ++restart) {
    Vec3d c = into_ball(local + Vec3d(gauss(rng), gauss(rng), gauss(rng)) * radius);
    double value = inside_distance(c);
    double spread = radius;
    for (int i = 0; i < 3000; ++i) {
      const Vec3d next = into_ball(c + Vec3d(gauss(rng), gauss(rng), gauss(rng)) * spread);
      const double there = inside_distance(next);
      if (there > value) {
        value = there;
        c = next;
        spread *= 1.5;
      } else {
        spread *= 0.97;
      }
      if (spread < 1e-9 * radius) break;
    }
    best = std::max(best, value);
  }
  return best;
}

}  // namespace arris::oracle
