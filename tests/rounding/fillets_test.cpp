// fillets_test.cpp — fillets of concave edges against the definition of rounding
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_oracle.h"
#include "support/creased_solids.h"
#include "support/fillet_shooter.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

void expect_agreement(RoundEdges edges) {
  FilletTally all;
  for (const CreasedCase& solid : make_creased_cases()) {
    SCOPED_TRACE(solid.mesh.name);
    FilletShooter shooter(solid, edges, 11);
    ASSERT_FALSE(shooter.rounding().data().filled.empty());
    FilletTally tally;
    shooter.shoot(120, tally);
    EXPECT_GT(tally.fillets, 2);
    all.rays += tally.rays;
    all.wrong += tally.wrong;
    all.fillets += tally.fillets;
    all.from_ends += tally.from_ends;
    all.examples.insert(all.examples.end(), tally.examples.begin(), tally.examples.end());
  }
  EXPECT_GT(all.from_ends, 3);
  EXPECT_LE(all.wrong * 300, all.rays) << fmt::format("{}", fmt::join(all.examples, "\n"));
}

TEST(Fillets, rays_agree_with_the_balls_that_fit_outside) {
  expect_agreement(RoundEdges::concave);
}

TEST(Fillets, both_kinds_of_edges_agree_with_the_balls_that_fit) {
  expect_agreement(RoundEdges::both);
}

// Glass: from within the solid or the fillet, the border between the two is none.
TEST(Fillets, rays_from_inside_leave_where_others_enter) {
  int all = 0, from_solid = 0;
  for (const CreasedCase& solid : make_creased_cases()) {
    SCOPED_TRACE(solid.mesh.name);
    FilletShooter shooter(solid, RoundEdges::concave, 3);
    const double r = solid.radius;
    int left = 0;
    for (int i = 0; i < 4000 && left < 15; ++i) {
      const Ray ray = shooter.make_ray(i);
      const auto hit = trace(ray, shooter.object());
      if (!hit || hit->feature != Feature::fillet || dot(hit->normal, ray.direction) > -0.2) {
        continue;
      }
      const double way = (i % 2 == 0 ? 0.05 : 0.6) * r;
      const auto at = [&](double t) { return ray.origin + ray.direction * t; };
      bool is_inside = true;
      for (double part = 0.25; part < 1.05; part += 0.25) {
        is_inside = is_inside && shooter.inside_by(at(hit->t + part * way)) > 0.01;
      }
      if (!is_inside) continue;
      const Vec3d start = at(hit->t + way);
      const auto out = trace({start, -ray.direction}, shooter.object(), RayStart::inside);
      ASSERT_TRUE(out.has_value()) << i;
      EXPECT_NEAR(out->t, way, 1e-5 * r) << i;
      EXPECT_GT(dot(out->normal, hit->normal), 0.999) << i;
      ++left;
      from_solid += shooter.depth(start) > 0 ? 1 : 0;
    }
    EXPECT_GT(left, 5);
    all += left;
  }
  EXPECT_GT(from_solid, all / 10);
  EXPECT_LT(from_solid, all - all / 10);
}

// What is reflected, and shadow rays.
TEST(Fillets, rays_that_leave_a_fillet_do_not_meet_it_where_they_start) {
  for (const CreasedCase& solid : make_creased_cases()) {
    SCOPED_TRACE(solid.mesh.name);
    FilletShooter shooter(solid, RoundEdges::both, 7);
    int left = 0;
    for (int i = 0; i < 1500; ++i) {
      const Ray ray = shooter.make_ray(i);
      const auto hit = trace(ray, shooter.object());
      if (!hit || hit->feature != Feature::fillet) continue;
      if (dot(ray.direction, hit->normal) > -1e-3) continue;
      const Vec3d x = ray.origin + ray.direction * hit->t;
      const Vec3d away = ray.direction - hit->normal * (2 * dot(ray.direction, hit->normal));
      const auto next = trace({x, away}, shooter.object(), RayStart::outside);
      EXPECT_TRUE(!next || next->t > 1e-4 * solid.radius)
          << i << " to " << name_of(next->feature) << " at " << next->t << ", cosine "
          << dot(away, next->normal);
      ++left;
    }
    EXPECT_GT(left, 50);
  }
}

// Arms thinner than the ball: convex edges are rounded locally beside the fillet.
TEST(Fillets, rays_that_leave_local_roundings_beside_a_fillet_do_not_meet_the_inside) {
  const double w = 0.25;
  const Outline l{{0, 0}, {2, 0}, {2, w}, {w, w}, {w, 2}, {0, 2}};
  const CreasedCase thin{prism_over("thin L", l, {1, 1, 0}), 0.15};
  FilletShooter shooter(thin, RoundEdges::both, 5);
  ASSERT_TRUE(shooter.rounding().data().creased.empty());
  ASSERT_FALSE(shooter.rounding().data().filled.empty());
  int left = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = shooter.make_ray(i);
    const auto hit = trace(ray, shooter.object());
    if (!hit || (hit->feature != Feature::edge && hit->feature != Feature::corner)) continue;
    if (dot(ray.direction, hit->normal) > -1e-3) continue;
    const Vec3d x = ray.origin + ray.direction * hit->t;
    for (const MeshHit& next : intersect_mesh({x, hit->normal}, shooter.object().mesh)) {
      if (dot(shooter.rounding().face_normal(next.triangle), hit->normal) < 0) continue;
      const Resolution met = shooter.rounding().resolve({x, hit->normal}, next, RayStart::outside);
      EXPECT_EQ(met.outcome, Resolution::Outcome::passed) << i;
      ++left;
      break;
    }
  }
  EXPECT_GT(left, 20);
}

// A slot narrower than the ball keeps its edges, to its mouths; the pocket that it leads out of has all its fillets.
TEST(Fillets, gaps_too_narrow_for_the_ball_stay_sharp) {
  constexpr double kWidth = 0.3, kRadius = 0.2, kFloor = -0.6;
  const CreasedCase slot{plate_with_slot(kWidth), kRadius};
  FilletShooter shooter(slot, RoundEdges::concave, 9);
  // The floor's edges within the slot, and no other.
  for (const ClampedEdge& edge : shooter.rounding().report().clamped) {
    EXPECT_EQ(edge.radius, 0);
    for (const Vec3d p : {edge.from, edge.to}) {
      EXPECT_NEAR(std::abs(p.y), kWidth / 2, 1e-6);
      EXPECT_NEAR(p.z, kFloor, 1e-6);
      EXPECT_GT(p.x, 1 - 1e-6);
    }
  }
  EXPECT_EQ(shooter.rounding().report().clamped.size(), 2U);
  // Five of the pocket's floor, as the slot parts one, and four upright ones.
  EXPECT_EQ(shooter.rounding().report().rounded_edges, 9U);
  // In the slot, and about its other end.
  Random rng(5);
  for (int i = 0; i < 4000; ++i) {
    const Vec3d target(uniform(rng, 1 + 2 * kRadius, 2.1), uniform(rng, -0.2, 0.2),
                       uniform(rng, kFloor - 0.1, 0.1));
    const Vec3d d = random_direction(rng);
    const Ray ray{target - d * 10, d};
    const std::vector<MeshHit> sharp = intersect_mesh(ray, shooter.object().mesh);
    const auto hit = trace(ray, shooter.object());
    ASSERT_EQ(hit.has_value(), !sharp.empty()) << i;
    if (!hit || ray.origin.x + d.x * hit->t < 1 + 2 * kRadius) continue;
    EXPECT_NEAR(hit->t, sharp.front().t, 1e-6) << i << " " << name_of(hit->feature);
  }
  // On the other side of the pocket all is as if there were no slot.
  FilletTally tally;
  for (int i = 0; i < 1500; ++i) {
    const Ray ray = shooter.make_ray(i);
    if (ray.direction.x < 0) continue;
    const auto hit = trace(ray, shooter.object());
    if (hit && ray.origin.x + ray.direction.x * hit->t < 1 - 3 * kRadius) shooter.judge(ray, tally);
  }
  EXPECT_GT(tally.fillets, 20);
  EXPECT_LE(tally.wrong * 300, tally.rays) << fmt::format("{}", fmt::join(tally.examples, "\n"));
}

// A dovetail whose mouth is narrower than the ball that fits within: the mouth stays open, and its lips are as if there
// were no fillets.
TEST(Fillets, mouths_of_undercut_grooves_stay_open) {
  const Outline dovetail{{-5, 0},  {5, 0},    {5, 3},    {0.3, 3},
                         {1.5, 1}, {-1.5, 1}, {-0.3, 3}, {-5, 3}};
  constexpr double kAboveFillets = 2.2;
  const CreasedCase groove{prism_over("dovetail", dovetail, {6, 1, 0}), 0.5};
  for (const RoundEdges edges : {RoundEdges::concave, RoundEdges::both}) {
    FilletShooter shooter(groove, edges, 9);
    EXPECT_GT(shooter.rounding().fillet_boxes().size(), 0U);
    Random rng(5);
    for (int i = 0; i < 1000; ++i) {
      const Vec3d target(uniform(rng, -0.25, 0.25), 1, uniform(rng, 2, 4));
      const Vec3d d = normalize(Vec3d(0, -1, uniform(rng, -0.02, 0.02)));
      const auto hit = trace({target - d * 10, d}, shooter.object());
      ASSERT_TRUE(hit.has_value()) << i;
      EXPECT_NEAR(hit->t, 10, 1e-6) << i << " " << name_of(hit->feature);
    }
    RoundingOptions convex;
    convex.radius = edges == RoundEdges::both ? groove.radius : 1e-8;
    const Rounding without = make_rounding(groove.mesh.view(), convex, "dovetail");
    int above = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3d target(uniform(rng, -1, 1), uniform(rng, kAboveFillets, 3.3),
                         uniform(rng, -0.5, 6.5));
      const Vec3d d = random_direction(rng);
      const Ray ray{target - d * (i % 2 == 0 ? 20 : 0.2), d};
      const auto is_above = [&](const auto& hit) {
        return hit && ray.origin.y + d.y * hit->t > kAboveFillets;
      };
      if (shooter.inside_by(ray.origin) > -0.1) continue;
      const auto hit = trace(ray, shooter.object(), RayStart::outside);
      const auto expected = trace(ray, {groove.mesh.view(), &without}, RayStart::outside);
      if (!is_above(hit) && !is_above(expected)) continue;
      if (hit && !is_above(hit) && hit->feature == Feature::fillet) continue;
      ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
      EXPECT_NEAR(hit->t, expected->t, 1e-6) << i << " " << name_of(hit->feature);
      ++above;
    }
    EXPECT_GT(above, 500);
  }
}

// Whatever way they go, and also where they come to the mesh within the material.
TEST(Fillets, rays_that_start_deep_in_one_leave_the_material) {
  const TriangleSoup mesh = plain_l();
  RoundingOptions options;
  options.radius = 0.15;
  options.edges = RoundEdges::concave;
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  Random rng(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d x(0.8 + uniform(rng, 0.005, 0.03), 0.8 + uniform(rng, 0.005, 0.03), 0.5);
    const Vec3d d = random_direction(rng);
    const auto hit = trace({x, d}, {mesh.view(), &rounding});
    ASSERT_TRUE(hit);
    EXPECT_GT(dot(hit->normal, d), 0) << i << " " << name_of(hit->feature) << " at " << hit->t;
  }
}

}  // namespace
}  // namespace arris::oracle
