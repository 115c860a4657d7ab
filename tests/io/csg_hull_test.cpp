#include "io/csg_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/csg_membership.h"

namespace arris {
namespace {

class Points {
 public:
  Vec3d operator()() { return {at_(random_), at_(random_), at_(random_)}; }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> at_{-1, 1};
};

TEST(CsgHull, holds_every_point_and_touches_three_a_face) {
  Points next;
  for (const double size : {1e-3, 1.0, 1e5}) {
    std::vector<Vec3d> points;
    for (int i = 0; i < 40; ++i) points.push_back(Vec3d(3, -2, 5) * size + next() * size);
    const std::optional<CsgPolyhedron> hull = hull_polyhedron(points);
    ASSERT_TRUE(hull);
    for (const CsgHalfSpace& face : hull->faces) {
      int touching = 0;
      for (const Vec3d& p : points) {
        ASSERT_LE(dot(face.normal, p), face.d + 1e-12 * size);
        if (dot(face.normal, p) > face.d - 1e-9 * size) ++touching;
      }
      EXPECT_GE(touching, 3);
    }
  }
}

TEST(CsgHull, merges_faces_that_six_digits_bend) {
  std::vector<Vec3d> cube;
  for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1, (i & 2) / 2, (i & 4) / 4);
  cube[7].x += 5e-7;
  cube[2].z -= 5e-7;
  EXPECT_EQ(hull_polyhedron(cube)->faces.size(), 6U);
  cube[7].x += 1e-2;
  EXPECT_GT(hull_polyhedron(cube)->faces.size(), 6U);
}

TEST(CsgHull, many_faces_are_a_closed_mesh) {
  Points next;
  std::vector<Vec3d> points;
  for (int i = 0; i < 500; ++i) points.push_back(normalize(next()));
  const std::optional<CsgPrimitive> hull = hull_of_points(points);
  ASSERT_TRUE(hull);
  const auto& mesh = std::get<CsgMesh>(*hull);
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.vertices.size() - 4);  // Euler
  EXPECT_NEAR(test::winding_number(mesh, {0.1, 0.2, 0.3}), 1, 1e-9);
}

TEST(CsgHull, flat_and_few_points_have_none) {
  EXPECT_FALSE(hull_polyhedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_FALSE(hull_polyhedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_FALSE(hull_polyhedron({{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}}));
}

// A point is in the hull of discs if no line parts it from all of them.
TEST(CsgHull, hull_of_discs_agrees_with_support_lines) {
  Points next;
  for (int round = 0; round < 60; ++round) {
    std::vector<Disc2d> discs;
    for (int i = 0; i < 2 + round % 7; ++i) {
      const Vec3d p = next();
      discs.push_back({{p.x, p.y}, i % 3 == 0 ? 0.0 : std::abs(p.z) / 2, 30});
    }
    const std::optional<FlatShape> hull = hull_of_discs(discs);
    ASSERT_TRUE(hull);
    for (int k = 0; k < 40; ++k) {
      const Vec3d r = next() * 1.6;
      double beyond = -1e300;  // the most that p is past a support line
      for (int i = 0; i < 2000; ++i) {
        const Vec2d u{std::cos(2 * kPi * i / 2000), std::sin(2 * kPi * i / 2000)};
        double reach = -1e300;
        for (const Disc2d& d : discs)
          reach = std::max(reach, u.x * d.center.x + u.y * d.center.y + d.radius);
        beyond = std::max(beyond, u.x * r.x + u.y * r.y - reach);
      }
      if (std::abs(beyond) < 1e-4) continue;
      ASSERT_EQ(is_inside(*hull, {r.x, r.y}), beyond < 0) << round;
    }
  }
}

TEST(CsgHull, two_unlike_balls_have_a_tangent_sleeve) {
  const std::optional<SolidShape> hull =
      hull_of_balls({{{0, 0, 0}, 1}, {{3, 1, 0}, 0.4}}, LeafMaker{});
  ASSERT_TRUE(hull);
  const CsgTree tree = make_tree(*hull, "");
  Points next;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p = Vec3d(1.5, 0.5, 0) + next() * 2.2;
    double beyond = 1e300;  // of the nearest ball between the two
    for (int k = 0; k <= 1000; ++k) {
      const double s = k / 1000.0;
      beyond = std::min(beyond, length(p - Vec3d(3, 1, 0) * s) - (1 - 0.6 * s));
    }
    if (std::abs(beyond) < 1e-4) continue;
    ASSERT_EQ(test::is_inside(tree, p), beyond < 0);
  }
}

}  // namespace
}  // namespace arris
