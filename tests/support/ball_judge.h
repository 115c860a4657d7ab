// ball_judge.h — sends rays at a rounded solid of any shape and compares what they hit with the balls that fit
// Guarantee  a hit is wrong if the opening is missed before it, or its place is outside of the opening or within it, by
//            more than 0.003 r
// Cost       see ball_oracle.h, some times a ray
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "support/ball_oracle.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {

struct BallTally {
  int rays = 0, kept = 0, moved = 0, passed = 0;
  int wrong = 0;
  std::vector<std::string> examples;
};

// Rays at the edges and corners of a mesh.
class BallShooter {
 public:
  BallShooter(const TriangleSoup& mesh, double radius, std::uint64_t seed,
              double min_angle = radians(5))
      : mesh_(mesh.view()), name_(mesh.name), r_(radius), oracle_(mesh_, radius), rng_(seed) {
    RoundingOptions options;
    options.radius = r_;
    options.min_angle = min_angle;
    rounding_ = std::make_unique<const Rounding>(make_rounding(mesh_, options, mesh.name));
  }

  [[nodiscard]] const Rounding& rounding() const { return *rounding_; }

  // At every other i near an edge, else near a corner.
  Ray make_ray(int i) {
    const auto& positions = mesh_.positions;
    const Triangle& t = mesh_.triangles[pick(mesh_.triangles.size())];
    Vec3d target(positions[t[0]]);
    if (i % 2 == 0) target += (Vec3d(positions[t[1]]) - target) * uniform(rng_, 0, 1);
    target += direction() * (uniform(rng_, 0, 1.5) * r_);
    const Vec3d d = direction();
    return {target - d * (20 * r_), d};
  }

  void shoot(int rays, BallTally& tally) {
    for (int i = 0; i < rays; ++i) {
      judge(make_ray(i), tally);
    }
  }

 private:
  std::size_t pick(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(rng_);
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{uniform(rng_, -1, 1), uniform(rng_, -1, 1), uniform(rng_, -1, 1)};
      const double l = length(v);
      if (l > 0.1 && l <= 1) return v / l;
    }
  }

  void judge(const Ray& ray, BallTally& tally) {
    const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh_);
    if (sharp.empty()) return;
    const auto hit = trace(ray, {mesh_, rounding_.get()});
    ++tally.rays;
    const auto at = [&](double t) { return ray.origin + ray.direction * t; };
    std::string problem;
    const double close = 0.003 * r_;
    // Nothing of the opening before the hit.
    const double end = hit ? hit->t : sharp.back().t;
    for (std::size_t i = 0; i + 1 < sharp.size() && problem.empty(); i += 2) {
      const double from = sharp[i].t, to = std::min(sharp[i + 1].t, end);
      if (to - from < 4 * close) continue;
      for (const double part : {0.25, 0.5, 0.75}) {
        const double m = oracle_.margin(at(from + (to - from) * part), rng_);
        if (m > close) problem = fmt::format("goes through material of margin {:.3g} r", m / r_);
      }
    }
    if (hit) {
      (hit->feature == Feature::face ? tally.kept : tally.moved) += 1;
      const Vec3d x = at(hit->t);
      const double inside = oracle_.margin(x - hit->normal * (0.01 * r_), rng_);
      const double outside = oracle_.margin(x + hit->normal * (0.01 * r_), rng_);
      if (inside < -close) problem = fmt::format("hits nothing: margin {:.3g} r", inside / r_);
      // Beside a concave edge what is above a face is under another one.
      if (hit->feature != Feature::face && outside > close)
        problem = fmt::format("hits within: margin {:.3g} r", outside / r_);
      // The ball that touches there fits.
      if (hit->feature != Feature::face) {
        const double room = oracle_.depth(x - hit->normal * r_) / r_;
        if (room < 0.99) problem = fmt::format("normal of no ball: room for {:.3g} r", room);
      }
    } else {
      ++tally.passed;
    }
    if (problem.empty()) return;
    ++tally.wrong;
    if (tally.examples.size() < 8) {
      tally.examples.push_back(fmt::format(
          "{}: o ({:.9g}, {:.9g}, {:.9g}) d ({:.9g}, {:.9g}, {:.9g}), sharp {:.6g}, {} {:.6g}: {}",
          name_, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
          ray.direction.z, sharp[0].t, hit ? name_of(hit->feature) : "nothing", hit ? hit->t : 0,
          problem));
    }
  }

  MeshView mesh_;
  std::string name_;
  double r_;
  BallOracle oracle_;
  Random rng_;
  std::unique_ptr<const Rounding> rounding_;
};

}  // namespace arris::oracle
