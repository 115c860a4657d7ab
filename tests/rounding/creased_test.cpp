// creased_test.cpp — solids with concave edges against the definition of rounding
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_oracle.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

// A block with another one on it, or let into it if `height` < 0.
TriangleSoup block_with_boss(std::string name, double base, double top, double height,
                             double lean = 0) {
  TriangleSoup mesh{std::move(name), {}, {}};
  const auto ring = [&](double half, double z, double shift) {
    for (const auto& [x, y] :
         {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      mesh.positions.push_back({float(x * half + shift), float(y * half), float(z)});
  };
  ring(2, -1.5, 0);
  ring(2, 0, 0);
  ring(base, 0, 0);
  ring(top, height, lean);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(3, 2, 1, 0);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    quad(i, j, j + 4, i + 4);
    quad(i + 4, j + 4, j + 8, i + 8);
    quad(i + 8, j + 8, j + 12, i + 12);
  }
  quad(12, 13, 14, 15);
  return mesh;
}

struct Case {
  TriangleSoup mesh;
  double radius;
};

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  const double w = 0.8;
  const Outline l{{0, 0}, {2, 0}, {2, w}, {w, w}, {w, 2}, {0, 2}};
  cases.push_back({prism_over("L", l, {1, 1, 0}), 0.15});
  TriangleSoup sheared = prism_over("sheared L", l, {1, 1, 0});
  for (Vec3f& p : sheared.positions) p = {p.x + 0.4F * p.z, p.y - 0.3F * p.z, p.z};
  cases.push_back({sheared, 0.12});
  cases.push_back({prism_over("tapered L", l, {1, 0.8, 0}), 0.12});
  cases.push_back({block_with_boss("boss", 0.8, 0.8, 0.9), 0.15});
  cases.push_back({block_with_boss("tapered boss", 0.9, 0.6, 0.8), 0.14});
  cases.push_back({block_with_boss("undercut boss", 0.6, 0.9, 0.8), 0.12});
  cases.push_back({block_with_boss("leaning boss", 0.7, 0.7, 0.9, 0.4), 0.12});
  cases.push_back({block_with_boss("pocket", 0.8, 0.8, -0.7), 0.15});
  cases.push_back({block_with_boss("slanted pocket", 0.9, 0.6, -0.7), 0.15});
  cases.push_back({block_with_boss("leaning pocket", 0.8, 0.7, -0.7, 0.25), 0.13});
  cases.push_back({prism_over("star", star_outline(5, 0.45), {0.8, 1, 0}), 0.06});
  cases.push_back({prism_over("cross",
                              {{-w, -2},
                               {w, -2},
                               {w, -w},
                               {2, -w},
                               {2, w},
                               {w, w},
                               {w, 2},
                               {-w, 2},
                               {-w, w},
                               {-2, w},
                               {-2, -w},
                               {-w, -w}},
                              {1, 1, 0}),
                   0.14});
  // Saddles: two convex and two concave edges at a corner.
  TriangleSoup saddle{"saddle", {}, {}};
  saddle.positions = {{-1, -1, -1},   {1, -1, -1},  {1, 1, -1},     {-1, 1, -1}, {-1, -1, 0.6F},
                      {1, -1, -0.4F}, {1, 1, 0.6F}, {-1, 1, -0.4F}, {0, 0, 0.1F}};
  saddle.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {4, 5, 8}, {5, 6, 8}, {6, 7, 8}, {7, 4, 8}};
  cases.push_back({saddle, 0.08});
  return cases;
}

struct Tally {
  int rays = 0, kept = 0, moved = 0, passed = 0;
  int wrong = 0;
  std::vector<std::string> examples;
};

// Rays at the edges and corners of a mesh.
class Shooter {
 public:
  Shooter(const Case& c, std::uint64_t seed)
      : mesh_(c.mesh.view()),
        name_(c.mesh.name),
        r_(c.radius),
        oracle_(mesh_, c.radius),
        rng_(seed) {
    RoundingOptions options;
    options.radius = r_;
    options.min_angle = radians(5);
    rounding_ = std::make_unique<const Rounding>(make_rounding(mesh_, options, c.mesh.name));
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

  void shoot(int rays, Tally& tally) {
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

  void judge(const Ray& ray, Tally& tally) {
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

TEST(Creased, rays_agree_with_the_balls_that_fit) {
  Tally all;
  for (const Case& c : make_cases()) {
    SCOPED_TRACE(c.mesh.name);
    Shooter shooter(c, 5);
    ASSERT_FALSE(shooter.rounding().data().creased.empty());
    Tally tally;
    shooter.shoot(160, tally);
    EXPECT_GT(tally.moved, 30);
    all.rays += tally.rays;
    all.wrong += tally.wrong;
    all.examples.insert(all.examples.end(), tally.examples.begin(), tally.examples.end());
  }
  EXPECT_LE(all.wrong * 300, all.rays) << fmt::format("{}", fmt::join(all.examples, "\n"));
}

// What is reflected, and shadow rays.
TEST(Creased, rays_that_leave_the_surface_do_not_meet_it_where_they_start) {
  for (const Case& c : make_cases()) {
    SCOPED_TRACE(c.mesh.name);
    Shooter shooter(c, 7);
    int left = 0;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = shooter.make_ray(i);
      const RoundedMesh object{c.mesh.view(), &shooter.rounding()};
      const auto hit = trace(ray, object);
      if (!hit || hit->feature == Feature::face) continue;
      if (dot(ray.direction, hit->normal) > 0) continue;  // it began in the solid
      const Vec3d x = ray.origin + ray.direction * hit->t;
      const Vec3d away = ray.direction - hit->normal * (2 * dot(ray.direction, hit->normal));
      const auto next = trace({x, away}, object, RayStart::outside);
      EXPECT_TRUE(!next || next->t > 1e-6 * c.radius)
          << i << " " << name_of(hit->feature) << " to " << name_of(next->feature) << " at "
          << next->t << ", cosine " << dot(away, next->normal);
      ++left;
    }
    EXPECT_GT(left, 100);
  }
}

}  // namespace
}  // namespace arris::oracle
