// creased_test.cpp — solids with concave edges against the definition of rounding
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_judge.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

TEST(Creased, rays_agree_with_the_balls_that_fit) {
  BallTally all;
  for (const CreasedCase& c : make_creased_cases()) {
    SCOPED_TRACE(c.mesh.name);
    BallShooter shooter(c.mesh, c.radius, 5);
    ASSERT_FALSE(shooter.rounding().data().creased.empty());
    BallTally tally;
    shooter.shoot(200, tally);
    EXPECT_GT(tally.moved, 37);
    all.rays += tally.rays;
    all.wrong += tally.wrong;
    all.examples.insert(all.examples.end(), tally.examples.begin(), tally.examples.end());
  }
  EXPECT_LE(all.wrong * 300, all.rays) << fmt::format("{}", fmt::join(all.examples, "\n"));
}

// What is reflected, and shadow rays.
TEST(Creased, rays_that_leave_the_surface_do_not_meet_it_where_they_start) {
  for (const CreasedCase& c : make_creased_cases()) {
    SCOPED_TRACE(c.mesh.name);
    BallShooter shooter(c.mesh, c.radius, 7);
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

// By rounding errors rays that leave a face start on either side of it: where they go must not depend on that.
TEST(Creased, rays_that_start_just_beneath_a_face_go_where_others_go_from_above) {
  std::vector<CreasedCase> cases = make_creased_cases();
  cases.push_back({block_with_boss("boss as wide as the ball", 0.5, 0.5, 0.8), 0.4});
  int started = 0, apart = 0;
  for (const CreasedCase& c : cases) {
    SCOPED_TRACE(c.mesh.name);
    BallShooter shooter(c.mesh, c.radius, 11);
    const RoundedMesh object{c.mesh.view(), &shooter.rounding()};
    for (int i = 0; i < 1000; ++i) {
      const Ray ray = shooter.make_ray(i);
      const auto hit = trace(ray, object);
      if (!hit || hit->feature != Feature::face || dot(ray.direction, hit->normal) > -0.1) continue;
      const Vec3d x = ray.origin + ray.direction * hit->t, off = hit->normal * (1e-8 * c.radius);
      const Vec3d away = ray.direction - hit->normal * (2 * dot(ray.direction, hit->normal));
      const auto above = trace({x + off, away}, object, RayStart::outside);
      const auto beneath = trace({x - off, away}, object, RayStart::outside);
      const bool is_same = above.has_value() == beneath.has_value() &&
                           (!above || std::abs(above->t - beneath->t) < 1e-3 * c.radius);
      ++started;
      apart += is_same ? 0 : 1;
    }
  }
  EXPECT_GT(started, 2000);
  EXPECT_EQ(apart, 0);
}

}  // namespace
}  // namespace arris::oracle
