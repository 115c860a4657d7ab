#include "beam/convex_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "beam/outline_parts.h"
#include "support/csg_oracle.h"

namespace arris::test {
namespace {

constexpr int kPrism = 6, kUnevenPrism = 7, kRevolution = 8, kRounded = 9;

bool is_convex_only(const CsgSolid& solid) {
  return std::ranges::all_of(solid.root().leaves(), [&](std::uint32_t i) {
    return std::holds_alternative<ConvexLeaf>(solid.leaf(i).shape);
  });
}

class ConvexSolid : public testing::TestWithParam<int> {};

TEST_P(ConvexSolid, holds_the_same_points) {
  CsgRandom random(7);
  for (int i = 0; i < 60; ++i) {
    const CsgTree tree =
        one_leaf(random_primitive(random, GetParam()), random_placement(random, 1));
    const CsgSolid solid = make_convex_solid(tree);
    ASSERT_TRUE(is_convex_only(solid)) << i;
    for (int k = 0; k < 300; ++k) {
      const Vec3d p = random_vector(random, 2.5);
      ASSERT_EQ(solid.contains(solid.root(), p), tree_holds(tree, p)) << i << ", " << k;
    }
  }
}

// Walls that are left between pieces would be met, and so would gaps.
TEST_P(ConvexSolid, is_met_where_the_leaf_is) {
  CsgRandom random(11);
  int rays = 0, differ = 0;
  for (int i = 0; i < 60; ++i) {
    const CsgTree tree =
        one_leaf(random_primitive(random, GetParam()), random_placement(random, 1));
    const CsgSolid convex = make_convex_solid(tree), exact(tree);
    BoundarySearch search;
    for (int k = 0; k < 200; ++k) {
      const Vec3d from = random_unit(random) * 6, to = random_vector(random, 1);
      const Ray ray{from, to - from};
      const std::vector<CsgBoundary> want = search.find(exact, view_of(exact.root()), ray);
      const std::vector<CsgBoundary> got = search.find(convex, view_of(convex.root()), ray);
      ++rays;
      if (!std::ranges::equal(want, got, [](const CsgBoundary& a, const CsgBoundary& b) {
            return std::abs(a.t - b.t) < 1e-5 && a.entering == b.entering;
          })) {
        ++differ;
      }
    }
  }
  EXPECT_LE(differ, rays / 1000);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ConvexSolid, testing::Values(kPrism, kRevolution, kRounded));

TEST(ConvexSolidOf, keeps_what_it_can_not_cut) {
  CsgRandom random(3);
  EXPECT_FALSE(is_convex_only(make_convex_solid(one_leaf(random_primitive(random, kUnevenPrism)))));
  EXPECT_FALSE(is_convex_only(make_convex_solid(one_leaf(CsgTorus{}))));
}

// A gear is its hull and a pocket for each gap.
TEST(OutlineParts, are_few) {
  CsgRegion region;
  std::vector<Vec2d> gear;
  for (int i = 0; i < 80; ++i) {
    const double angle = 2 * kPi * i / 80, r = i / 2 % 2 == 0 ? 1 : 0.8;
    gear.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  region.outlines.push_back(gear);
  const auto parts = find_outline_parts(region);
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 1U);
  EXPECT_EQ((*parts)[0].pockets.size(), 20U);
}

TEST(OutlineParts, islands_lie_in_holes) {
  const auto square = [](double r, bool turned) {
    std::vector<Vec2d> p{{-r, -r}, {r, -r}, {r, r}, {-r, r}};
    if (turned) std::ranges::reverse(p);
    return p;
  };
  const auto parts = find_outline_parts({{square(3, false), square(2, true), square(1, false)}});
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 2U);
  EXPECT_EQ((*parts)[0].pockets.size(), 1U);
  EXPECT_TRUE((*parts)[1].pockets.empty());
}

TEST(OutlineParts, none_of_outlines_that_cross) {
  EXPECT_FALSE(find_outline_parts({{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}}));
}

}  // namespace
}  // namespace arris::test
