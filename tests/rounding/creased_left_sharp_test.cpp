// creased_left_sharp_test.cpp — solids some of whose edges have no room for the radius
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/convex_solids.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

constexpr double kRadius = 0.15;

Rounding round(const TriangleSoup& mesh) {
  RoundingOptions options;
  options.radius = kRadius;
  return make_rounding(mesh.view(), options, mesh.name);
}

// A block whose boss is too thin, and the block alone.
class LeftSharp : public testing::Test {
 protected:
  Ray make_ray(Vec3d target) {
    const Vec3d d = random_direction(rng_);
    return {target - d * 20.0, d};
  }

  Random rng_{11};
  TriangleSoup mesh_ = block_with_boss("thin boss", 0.1, 0.1, 0.9);
  Rounding rounding_ = round(mesh_);
  TriangleSoup block_ = block_with_boss("block", 0.1, 0.1, 0);
  Rounding block_rounding_ = round(block_);
};

TEST_F(LeftSharp, are_the_edges_without_room_and_no_others) {
  ASSERT_EQ(rounding_.data().creased.size(), 1U);
  const std::vector<ClampedEdge>& clamped = rounding_.report().clamped;
  EXPECT_EQ(clamped.size(), 8U);
  for (const ClampedEdge& edge : clamped) {
    EXPECT_EQ(edge.radius, 0);
    EXPECT_GT(std::max(edge.from.z, edge.to.z), 0.89);
  }
  EXPECT_EQ(rounding_.report().rounded_edges, 12U);
  ASSERT_EQ(rounding_.report().notes.size(), 2U);
  EXPECT_EQ(rounding_.report().notes[1].text(),
            "8 edges stay sharp: the radius is too large for the faces beside them");
}

TEST_F(LeftSharp, edges_do_not_change_what_lies_elsewhere) {
  int rounded = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3d target(mesh_.positions[std::size_t(i) % 8]);
    target += Vec3d(uniform(rng_, -0.3, 0.3), uniform(rng_, -0.3, 0.3), uniform(rng_, -0.3, 0.3));
    const Ray ray = make_ray(target);
    const auto alone = trace(ray, {block_.view(), &block_rounding_});
    const auto hit = trace(ray, {mesh_.view(), &rounding_});
    if (!alone) continue;
    const Vec3d x = ray.origin + ray.direction * alone->t;
    if (std::max(std::abs(x.x), std::abs(x.y)) < 0.5) continue;  // the boss may be before it
    if (hit && hit->t < alone->t - 0.1) continue;
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, alone->t, 1e-5);
    rounded += hit->feature != Feature::face ? 1 : 0;
  }
  EXPECT_GT(rounded, 500);
}

TEST_F(LeftSharp, edges_have_no_holes_beside_them) {
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray =
        make_ray({uniform(rng_, -0.15, 0.15), uniform(rng_, -0.15, 0.15), uniform(rng_, 0.3, 1)});
    const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh_.view());
    if (sharp.empty()) continue;
    const Vec3d x = ray.origin + ray.direction * sharp.front().t;
    if (x.z < 0.05) continue;
    const auto hit = trace(ray, {mesh_.view(), &rounding_});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, sharp.front().t, 1e-6);
    ++hits;
  }
  EXPECT_GT(hits, 1000);
}

// A floor between two pockets that is thinner than the ball: neither of its faces vanishes.
TEST(ThinFloor, stays) {
  TriangleSoup mesh = block_with_boss("thin floor", 0.8, 0.8, -1.4);
  const Rounding rounding = round(mesh);
  ASSERT_EQ(rounding.data().creased.size(), 1U);
  Random rng(5);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d target(uniform(rng, -0.79, 0.79), uniform(rng, -0.79, 0.79), -1.45);
    for (const double side : {-1.0, 1.0}) {
      const Vec3d d = normalize(Vec3d(uniform(rng, -0.3, 0.3), uniform(rng, -0.3, 0.3), side));
      const Ray ray{target - d * 20.0, d};
      const double sharp = intersect_mesh(ray, mesh.view()).front().t;
      if (ray.origin.z + ray.direction.z * sharp > -1.3) continue;  // the block's top
      const auto hit = trace(ray, {mesh.view(), &rounding});
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->t, sharp, 1e-6);
      ++hits;
    }
  }
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace arris::oracle
