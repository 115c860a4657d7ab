#include "geometry/polygon_holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace arris {
namespace {

struct Outline {
  std::vector<Vec3f> points;
  std::vector<std::vector<std::uint32_t>> loops;

  // Counter-clockwise about +z, or clockwise for a hole.
  void add(const std::vector<Vec2f>& corners, bool hole) {
    std::vector<std::uint32_t> loop;
    for (const Vec2f& c : corners) {
      loop.push_back(std::uint32_t(points.size()));
      points.push_back({c.x, c.y, 0});
    }
    if (hole) loop = {loop.rbegin(), loop.rend()};
    loops.push_back(loop);
  }
};

std::vector<Vec2f> circle(float x, float y, float radius, int sides) {
  std::vector<Vec2f> corners;
  for (int i = 0; i < sides; ++i) {
    const auto a = float(2 * kPi * i / sides);
    corners.push_back({x + radius * std::cos(a), y + radius * std::sin(a)});
  }
  return corners;
}

double area_of(const std::vector<Vec3f>& points, std::span<const Triangle> triangles) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const Vec3d a(points[t[0]]), b(points[t[1]]), c(points[t[2]]);
    EXPECT_GE(cross(b - a, c - a).z, -1e-6);
    area += cross(b - a, c - a).z / 2;
  }
  return area;
}

// The loops' edges once, every other edge in both directions.
void expect_closed(const Outline& outline, std::span<const Triangle> triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      walks[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  for (const auto& loop : outline.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      walks[std::minmax(a, b)] -= a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : walks) {
    EXPECT_EQ(count, 0) << edge.first << "-" << edge.second;
  }
}

TEST(PolygonHoles, covers_a_plate_with_a_grid_of_round_holes_exactly) {
  Outline plate;
  plate.add({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, false);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      plate.add(circle(1 + 2 * float(i), 1 + 2 * float(j), 0.8F, 16), true);
    }
  }
  HolePolygonTriangulator triangulator;
  const auto triangles = triangulator.triangulate(plate.points, plate.loops, {0, 0, 1});
  ASSERT_TRUE(triangles);
  const double hole = 16 * 0.5 * 0.64 * std::sin(2 * kPi / 16);
  EXPECT_NEAR(area_of(plate.points, *triangles), 100 - 25 * hole, 1e-4);
  expect_closed(plate, *triangles);
}

TEST(PolygonHoles, covers_random_holes_in_a_star) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  HolePolygonTriangulator triangulator;
  for (int round = 0; round < 200; ++round) {
    Outline star;
    std::vector<Vec2f> corners = circle(0, 0, 10, 24);
    for (std::size_t i = 0; i < corners.size(); i += 2) {
      corners[i].x *= 0.7F;
      corners[i].y *= 0.7F;
    }
    star.add(corners, false);
    double holes = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int sides = 3 + int(uniform(rng) * 6);
        const float radius = 0.2F + 0.8F * uniform(rng);
        star.add(circle(-3.6F + 2.4F * float(i), -3.6F + 2.4F * float(j), radius, sides), true);
        holes += sides * 0.5 * radius * radius * std::sin(2 * kPi / sides);
      }
    }
    const auto triangles = triangulator.triangulate(star.points, star.loops, {0, 0, 1});
    ASSERT_TRUE(triangles) << round;
    const double outer = 24 * 0.5 * 7 * 10 * std::sin(2 * kPi / 24);
    EXPECT_NEAR(area_of(star.points, *triangles), outer - holes, 1e-3) << round;
    expect_closed(star, *triangles);
  }
}

TEST(PolygonHoles, has_no_result_for_two_outlines_or_a_crossing_one) {
  Outline two;
  two.add({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, false);
  two.add({{2, 0}, {3, 0}, {3, 1}, {2, 1}}, false);
  HolePolygonTriangulator triangulator;
  EXPECT_FALSE(triangulator.triangulate(two.points, two.loops, {0, 0, 1}));
  Outline bow;
  bow.add({{0, 0}, {2, 1.5F}, {2, 0}, {0, 1}}, false);
  EXPECT_FALSE(triangulator.triangulate(bow.points, bow.loops, {0, 0, 1}));
}

}  // namespace
}  // namespace arris
