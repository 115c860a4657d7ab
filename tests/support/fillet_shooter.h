// fillet_shooter.h — rays at a solid with fillets, judged by the definition of rounding
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "support/ball_oracle.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {

struct FilletTally {
  int rays = 0, fillets = 0, from_ends = 0;
  int wrong = 0;
  std::vector<std::string> examples;
};

// Rays at one solid's edges and corners.
class FilletShooter {
 public:
  FilletShooter(const CreasedCase& solid, RoundEdges edges, std::uint64_t seed)
      : mesh_(solid.mesh.view()),
        name_(solid.mesh.name),
        r_(solid.radius),
        edges_(edges),
        inside_(mesh_, r_),
        outside_(mesh_, r_, Space::outside),
        rng_(seed) {
    RoundingOptions options;
    options.radius = r_;
    options.edges = edges;
    options.min_angle = radians(5);
    rounding_ = std::make_unique<const Rounding>(make_rounding(mesh_, options, name_));
  }

  [[nodiscard]] const Rounding& rounding() const { return *rounding_; }
  [[nodiscard]] RoundedMesh object() const { return {mesh_, rounding_.get()}; }

  // Near an edge, near a corner, or in a fillet's box; some along an edge.
  Ray make_ray(int i) {
    const auto& positions = mesh_.positions;
    const Triangle& t = mesh_.triangles[pick(mesh_.triangles.size())];
    const Vec3d p(positions[t[0]]), q(positions[t[1]]);
    Vec3d target = p;
    if (i % 2 == 0) target += (q - p) * uniform(rng_, 0, 1);
    if (i % 3 != 0) {
      const auto boxes = rounding_->fillet_boxes();
      const auto& box = boxes[pick(boxes.size())];
      target = {uniform(rng_, box.low.x, box.high.x), uniform(rng_, box.low.y, box.high.y),
                uniform(rng_, box.low.z, box.high.z)};
    } else {
      target += direction() * (uniform(rng_, 0, 1.5) * r_);
    }
    Vec3d d = direction();
    if (i % 4 == 1) d = normalize(normalize(p - q) + direction() * 0.4);
    return {target - d * (20 * r_), d};
  }

  void shoot(int rays, FilletTally& tally) {
    for (int i = 0; i < rays; ++i) judge(make_ray(i), tally);
  }

  void judge(const Ray& ray, FilletTally& tally) {
    if (inside_by(ray.origin) > -0.1) return;
    const auto hit = trace(ray, object());
    ++tally.rays;
    const auto at = [&](double t) { return ray.origin + ray.direction * t; };
    std::string problem;
    const double close = 0.003;
    // Nothing before the hit. Rays are shot from 20 r away at what is within 1.5 r.
    const double end = std::min(hit ? hit->t : INFINITY, 24 * r_);
    for (double t = 16 * r_ + uniform(rng_, 0, 0.4) * r_; t < end - 0.02 * r_; t += 0.4 * r_) {
      if (const double by = inside_by(at(t)); by > close)
        problem = fmt::format("goes through material by {:.3g} r at {:.6g}", by, t);
    }
    if (hit) {
      const Vec3d step = hit->normal * (0.01 * r_);
      // A fillet thinner than the step may lie above what is taken away, or be seen from there.
      const bool is_thin =
          hit->feature == Feature::fillet &&
          (inside_.depth(at(hit->t) - step) > 0 || std::abs(inside_.depth(at(hit->t))) < 1e-4 * r_);
      if (const double by = inside_by(at(hit->t) - step); by < -close && !is_thin)
        problem = fmt::format("hits nothing, by {:.3g} r", -by);
      if (const double by = inside_by(at(hit->t) + step); by > close)
        problem = fmt::format("hits within, by {:.3g} r", by);
      // The ball that touches there fits outside, or inside. Sides of fillets' ends lie on the sharp face.
      if (hit->feature != Feature::face && std::abs(inside_.depth(at(hit->t))) > 1e-4 * r_) {
        const double side = hit->feature == Feature::fillet ? 1 : -1;
        const double room = -side * inside_.depth(at(hit->t) + hit->normal * (side * r_)) / r_;
        if (room < 0.99) problem = fmt::format("normal of no ball: room for {:.3g} r", room);
      }
      if (hit->feature == Feature::fillet) {
        ++tally.fillets;
        tally.from_ends += trace_hits(ray, object(), RayStart::unknown).has_value() ? 0 : 1;
      }
    }
    if (problem.empty()) return;
    ++tally.wrong;
    if (tally.examples.size() < 4) {
      tally.examples.push_back(fmt::format(
          "{}: o ({:.9g}, {:.9g}, {:.9g}) d ({:.9g}, {:.9g}, {:.9g}), {} {:.6g}: {}", name_,
          ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
          ray.direction.z, hit ? name_of(hit->feature) : "nothing", hit ? hit->t : 0, problem));
    }
  }

  [[nodiscard]] double depth(Vec3d x) const { return inside_.depth(x); }

  // By how much x is in the rounded solid, relative to the radius: above 0 surely, below 0 surely not.
  double inside_by(Vec3d x) {
    const double depth = inside_.depth(x);
    if (depth < 0) return -outside_.margin(x, rng_) / r_;
    return edges_ == RoundEdges::concave ? depth / r_ : inside_.margin(x, rng_) / r_;
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

  MeshView mesh_;
  std::string name_;
  double r_;
  RoundEdges edges_;
  BallOracle inside_, outside_;
  Random rng_;
  std::unique_ptr<const Rounding> rounding_;
};

}  // namespace arris::oracle
