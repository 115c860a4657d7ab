// varied_radii_test.cpp — edges with radii of their own against balls along each of them
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/convex_solids.h"
#include "support/creased_solids.h"
#include "support/rounded_box.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

// The definition, by itself: at both ends the median radius of the corner for 1.25 of it, then a smooth step to the
// edge's own of twice the length by which it changes, cut into 16.
double radius_along(const RoundedBox& box, const BoxEdge& edge, double v) {
  const double extent = length(edge.p1 - edge.p0);
  const auto corner_radius = [&](Vec3d p) {
    std::vector<double> radii;
    for (const BoxEdge& e : box.edges) {
      if (length(e.p0 - p) < 1e-9 || length(e.p1 - p) < 1e-9) radii.push_back(e.radius);
    }
    std::ranges::sort(radii);
    return radii[1];
  };
  const bool is_near_p1 = v > 0.5 * extent;
  const double from_end = is_near_p1 ? extent - v : v;
  const double corner = corner_radius(is_near_p1 ? edge.p1 : edge.p0);
  const double grown = edge.radius - corner;
  const double at = grown != 0 ? (from_end - 1.25 * corner) / (2 * std::abs(grown)) : 1;
  const double step = std::clamp(at, 0.0, 1.0) * 16;
  const auto smooth = [](double x) { return x * x * (3 - 2 * x); };
  const double low = std::floor(std::min(step, 15.999999));
  const double part = smooth(low / 16) + (smooth((low + 1) / 16) - smooth(low / 16)) * (step - low);
  return corner + grown * part;
}

struct Ball {
  Vec3d center;
  double radius;
};

std::vector<Ball> balls_along_edges(const RoundedBox& box) {
  std::vector<Ball> balls;
  for (const BoxEdge& e : box.edges) {
    const Vec3d along = e.p1 - e.p0;
    const double extent = length(along);
    const auto add = [&](double v) {
      const double r = radius_along(box, e, v);
      // At the ends the balls stay within the box.
      if (std::min(v, extent - v) < r * (1 - 1e-9)) return;
      balls.push_back({e.p0 + along * (v / extent) - (e.normal_a + e.normal_b) * r, r});
    };
    for (int i = 0; i <= 1500; ++i) add(extent * i / 1500);
    add(radius_along(box, e, 0));
    add(extent - radius_along(box, e, extent));
  }
  return balls;
}

std::optional<double> first_ball(const std::vector<Ball>& balls, const Ray& ray) {
  std::optional<double> first;
  for (const Ball& ball : balls) {
    const Vec3d m = ray.origin - ball.center;
    const double b = dot(m, ray.direction), c = length_squared(m) - ball.radius * ball.radius;
    const double d = b * b - c;
    if (d < 0) continue;
    const double t = -b - std::sqrt(d);
    if (t > 0 && (!first || t < *first)) first = t;
  }
  return first;
}

// How much farther from an edge of a face than the balls touch it; below 0: the rounding has taken it away.
double beside_edges(const RoundedBox& box, Vec3d x) {
  double least = INFINITY;
  for (const BoxEdge& e : box.edges) {
    const bool on_a = std::abs(dot(e.normal_a, x - e.p0)) < 1e-6;
    const bool on_b = std::abs(dot(e.normal_b, x - e.p0)) < 1e-6;
    if (!on_a && !on_b) continue;
    const Vec3d along = normalize(e.p1 - e.p0);
    const double v = dot(x - e.p0, along);
    const double away = length(x - e.p0 - along * v);
    least = std::min(least, away - radius_along(box, e, v));
  }
  return least;
}

TEST(VariedRadii, rays_agree_with_balls_along_each_edge) {
  Random rng(3);
  int moved = 0, kept = 0;
  for (int k = 0; k < 12; ++k) {
    const RoundedBox box = make_box({2, 1.5, 1.2}, rng, {0.15, 0.3, 0.05, k % 2 == 0 ? 0 : 0.2});
    const Rounding rounding = make_rounding(box.mesh.view(), box.options, "box");
    ASSERT_EQ(rounding.data().creased.size(), 1U);
    EXPECT_TRUE(rounding.report().clamped.empty());
    const std::vector<Ball> balls = balls_along_edges(box);
    for (int i = 0; i < 150; ++i) {
      const BoxEdge& e = box.edges[std::size_t(uniform_int(rng, 0, 11))];
      const Vec3d target =
          e.p0 + (e.p1 - e.p0) * uniform(rng, 0, 1) + random_direction(rng) * uniform(rng, 0, 0.3);
      const Vec3d d = random_direction(rng);
      const Ray ray{target - d * 10.0, d};
      const std::vector<MeshHit> sharp = intersect_mesh(ray, box.mesh.view());
      if (sharp.empty()) continue;
      const auto hit = trace(ray, {box.mesh.view(), &rounding});
      const Vec3d x = ray.origin + d * sharp.front().t;
      const double beside = beside_edges(box, x);
      if (std::abs(beside) < 2e-3) continue;
      if (beside > 0) {
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, sharp.front().t, 1e-5);
        ++kept;
        continue;
      }
      const std::optional<double> ball = first_ball(balls, ray);
      if (ball && *ball < sharp.back().t) {
        ASSERT_TRUE(hit) << k << " " << i;
        // Between balls that were sampled the surface lies a little before them, more so where it is grazed.
        const double grazing = std::max(std::abs(dot(d, hit->normal)), 0.05);
        EXPECT_LT(hit->t, *ball + 1e-5) << k << " " << i;
        EXPECT_GT(hit->t, *ball - 4e-4 / grazing) << k << " " << i;
        ++moved;
      } else {
        EXPECT_TRUE(!hit || std::abs(dot(d, hit->normal)) < 0.05) << k << " " << i;
      }
    }
  }
  EXPECT_GT(kept, 300);
  EXPECT_GT(moved, 300);
}

// On solids with mixed corners: what a ray is let through is nowhere deeper than the largest radius.
TEST(VariedRadii, rays_pass_through_no_material) {
  Random rng(8);
  int rounded = 0;
  for (const CreasedCase& c : make_creased_cases()) {
    RoundingOptions options;
    options.radius = 0.6 * c.radius;
    options.min_angle = radians(5);
    const MeshView mesh = c.mesh.view();
    for (int k = 0; k < 4; ++k) {
      const Vec3d corner(
          mesh.positions[std::size_t(uniform_int(rng, 0, int(mesh.positions.size()) - 1))]);
      EdgeRule rule;
      rule.radius = std::array{0.0, 0.3 * c.radius, c.radius, 1.3 * c.radius}[std::size_t(k)];
      rule.box = {corner - Vec3d(1.1), corner + Vec3d(1.1)};
      options.rules.push_back(rule);
    }
    const Rounding rounding = make_rounding(mesh, options, c.mesh.name);
    ASSERT_EQ(rounding.data().creased.size(), 1U) << c.mesh.name;
    const CreasedSolid& solid = *rounding.data().creased[0];
    const Vec3d center = rounding.data().solids[0].center;
    for (int i = 0; i < 600; ++i) {
      const Triangle& t =
          mesh.triangles[std::size_t(uniform_int(rng, 0, int(mesh.triangles.size()) - 1))];
      Vec3d target(mesh.positions[t[0]]);
      target += (Vec3d(mesh.positions[t[1]]) - target) * uniform(rng, 0, 1) +
                random_direction(rng) * uniform(rng, 0, c.radius);
      const Vec3d d = random_direction(rng);
      const Ray ray{target - d * 10.0, d};
      const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh);
      if (sharp.size() < 2) continue;
      const auto hit = trace(ray, {mesh, &rounding});
      rounded += hit && hit->feature != Feature::face ? 1 : 0;
      const double end = hit ? std::min(hit->t, sharp[1].t) : sharp[1].t;
      const double r = 1.3 * c.radius;
      for (int step = 0; step <= 8; ++step) {
        const double at = sharp[0].t + (end - sharp[0].t) * step / 8;
        EXPECT_TRUE(solid.surface.is_near(ray.origin + d * at - center, 1.001 * r, kNone))
            << c.mesh.name << " " << i;
      }
    }
  }
  EXPECT_GT(rounded, 1000);
}

TEST(VariedRadii, edges_without_radius_stay_sharp_between_their_corners) {
  Random rng(5);
  RoundedBox box = make_box({1, 1, 1}, rng, {0.2});
  box.options.rules[0].radius = 0;
  const Rounding rounding = make_rounding(box.mesh.view(), box.options, "box");
  const BoxEdge& sharp = box.edges[0];
  const Vec3d middle = (sharp.p0 + sharp.p1) * 0.5;
  const Vec3d d = normalize(sharp.normal_a + sharp.normal_b) * -1.0;
  const auto hit = trace({middle - d * 5.0, d}, {box.mesh.view(), &rounding});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 5, 1e-6);
  // The corner is that of the other two edges.
  const Vec3d to_corner = normalize(sharp.p0) * -1.0;
  const auto corner = trace({sharp.p0 - to_corner * 5.0, to_corner}, {box.mesh.view(), &rounding});
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->t, 5 + 0.2 * (std::sqrt(3.0) - 1), 1e-5);
  EXPECT_EQ(corner->feature, Feature::corner);
}

// Pieces of a rim are too short for transitions: one that is smaller makes all of them so.
TEST(VariedRadii, pieces_of_a_rim_share_the_smallest_radius) {
  constexpr int kPieces = 48;
  Outline circle;
  for (int i = 0; i < kPieces; ++i) {
    const double angle = 2 * kPi * i / kPieces;
    circle.push_back({2 * std::cos(angle), 2 * std::sin(angle)});
  }
  const TriangleSoup mesh = prism_over("drum", circle, {1, 1, 0});
  RoundingOptions options;
  options.radius = 0.2;
  EdgeRule rule;
  rule.radius = 0.1;
  const auto at = [&](std::size_t i) { return Vec3d(mesh.positions[kPieces + i]); };
  rule.segments = {{at(20), at(21)}};
  options.rules = {rule};
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  int smaller = 0;
  for (const ClampedEdge& edge : rounding.report().clamped) {
    EXPECT_EQ(edge.radius, 0.1);
    smaller += std::min(edge.from.z, edge.to.z) > 0.5 ? 1 : 0;
  }
  EXPECT_EQ(smaller, kPieces - 1);
  // In the middle of the opposite piece.
  const Vec3d middle = (at(44) + at(45)) * 0.5;
  const Vec3d d = normalize(Vec3d(-middle.x, -middle.y, -length(Vec3d(middle.x, middle.y, 0))));
  const auto hit = trace({middle - d * 5.0, d}, {mesh.view(), &rounding});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 5 + 0.1 * (std::sqrt(2.0) - 1), 1e-4);
}

// The corners of edges without a radius have none: their other edges begin there as asked, not for want of room.
TEST(VariedRadii, what_a_rule_leaves_sharp_is_not_listed_as_without_room) {
  const TriangleSoup mesh = block_with_boss("thin boss", 0.1, 0.1, 0.9);
  RoundingOptions options;
  options.radius = 0.15;
  EdgeRule rule;
  rule.radius = 0;
  rule.box = {Vec3d(-3, -3, -1.6), Vec3d(3, 3, -1.4)};
  options.rules = {rule};
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  EXPECT_EQ(rounding.report().clamped.size(), 8U);
  for (const ClampedEdge& edge : rounding.report().clamped) {
    EXPECT_GT(std::max(edge.from.z, edge.to.z), 0.89);
  }
}

// A chamfer's edges turn less and are nearer to where the large ball touches than its own edge.
TEST(VariedRadii, large_radii_beside_edges_that_turn_less_leave_no_holes) {
  const TriangleSoup mesh =
      prism_over("chamfered", {{0, 0}, {1.7, 0}, {2.7, 1}, {2.7, 3}, {0, 3}}, {8, 1, 0});
  RoundingOptions options;
  options.radius = 0.2;
  EdgeRule rule;
  rule.radius = 1;
  rule.segments = {{Vec3d(0, 0, -9), Vec3d(0, 0, 9)}};
  options.rules = {rule};
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  EXPECT_FALSE(rounding.report().clamped.empty());
  Random rng(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d from(uniform(rng, 0, 2.7), -1, uniform(rng, 2, 6));
    const auto hit = trace({from, {0, 1, 0}}, {mesh.view(), &rounding});
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->t, 2.05 + (from.x > 1.7 ? from.x - 1.7 : 0));
  }
}

TEST(VariedRadii, edges_that_are_too_short_take_the_smaller_radius_and_are_told) {
  Random rng(5);
  RoundedBox box = make_box({0.35, 1, 1}, rng, {0.05});
  for (std::size_t i = 0; i < 4; ++i) box.options.rules[i].radius = 0.3;  // along x
  const Rounding rounding = make_rounding(box.mesh.view(), box.options, "box");
  ASSERT_EQ(rounding.report().clamped.size(), 4U);
  for (const ClampedEdge& edge : rounding.report().clamped) EXPECT_EQ(edge.radius, 0.05);
}

TEST(VariedRadii, clamping_halves_radii_until_they_fit) {
  const TriangleSoup mesh = block_with_boss("boss", 0.1, 0.1, 0.9);
  RoundingOptions options;
  options.radius = 0.15;
  options.on_overlap = OnOverlap::clamp;
  const Rounding rounding = make_rounding(mesh.view(), options, "boss");
  ASSERT_EQ(rounding.report().clamped.size(), 8U);
  for (const ClampedEdge& edge : rounding.report().clamped) EXPECT_EQ(edge.radius, 0.075);
  // The boss' top edge, rounded by it.
  const Vec3d d = normalize(Vec3d(-1, 0, -1));
  const Ray ray{Vec3d(0.1, 0, 0.9) - d * 5.0, d};
  const auto hit = trace(ray, {mesh.view(), &rounding});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 5 + 0.075 * (std::sqrt(2.0) - 1), 1e-5);
}

}  // namespace
}  // namespace arris::oracle
