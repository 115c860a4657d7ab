#include "geometry/polygon.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace arris {
namespace {

double doubled_area(Vec3f a, Vec3f b, Vec3f c, Vec3d normal) {
  return dot(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)), normal);
}

struct Cover {
  double area = 0;      // sum of the triangles' areas
  double least = 0;     // of the smallest triangle: negative if one is turned over
  bool closed = false;  // the polygon's edges once each, every other edge in both directions
  std::size_t triangles = 0;
};

Cover cover_of(const std::vector<Vec3f>& corners, Vec3d unit_normal) {
  PolygonTriangulator triangulator;
  Cover cover;
  cover.least = 1e30;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
  for (const Triangle& t : triangulator.triangulate(corners)) {
    const double area = doubled_area(corners[t[0]], corners[t[1]], corners[t[2]], unit_normal) / 2;
    cover.area += area;
    cover.least = std::min(cover.least, area);
    ++cover.triangles;
    for (std::size_t k = 0; k < 3; ++k) ++walks[{t[k], t[(k + 1) % 3]}];
  }
  const auto count = std::uint32_t(corners.size());
  cover.closed = true;
  for (const auto& [edge, times] : walks) {
    const bool outline = edge.second == (edge.first + 1) % count;
    const bool has_twin = walks.contains({edge.second, edge.first});
    if (times != 1 || has_twin == outline) cover.closed = false;
  }
  return cover;
}

void expect_exact_cover(const std::vector<Vec3f>& corners, Vec3d unit_normal, double area) {
  const Cover cover = cover_of(corners, unit_normal);
  EXPECT_EQ(cover.triangles, corners.size() - 2);
  EXPECT_NEAR(cover.area, area, 1e-6 * area);
  EXPECT_GT(cover.least, 0);
  EXPECT_TRUE(cover.closed);
}

const Vec3d kUp(0, 0, 1);

TEST(Polygon, covers_a_convex_one) {
  expect_exact_cover({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, kUp, 2);
  expect_exact_cover({{0, 1, 0}, {2, 1, 0}, {2, 0, 0}, {0, 0, 0}}, -kUp, 2);
}

TEST(Polygon, covers_a_concave_quad_whichever_corner_is_first) {
  std::vector<Vec3f> arrow = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  for (int i = 0; i < 4; ++i) {
    expect_exact_cover(arrow, kUp, 4);
    std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
  }
}

TEST(Polygon, covers_letters_in_any_plane) {
  const std::vector<Vec2f> letter_e = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {2, 2},
                                       {2, 3}, {1, 3}, {1, 4}, {3, 4}, {3, 5}, {0, 5}};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3f> corners;
    for (const Vec2f p : letter_e) {
      Vec3f corner(7.0F);
      corner[(axis + 1) % 3] = p.x;
      corner[(axis + 2) % 3] = p.y;
      corners.push_back(corner);
    }
    Vec3d normal(0.0);
    normal[axis] = 1;
    expect_exact_cover(corners, normal, 10);
    std::reverse(corners.begin(), corners.end());
    expect_exact_cover(corners, -normal, 10);
  }
}

TEST(Polygon, keeps_collinear_corners_without_flat_triangles) {
  expect_exact_cover({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}, kUp, 4);
}

TEST(Polygon, covers_a_hole_that_a_bridge_joins) {
  // A square of 4 with a square hole of 2, cut open from (0,0) to (1,1).
  expect_exact_cover({{0, 0, 0},
                      {4, 0, 0},
                      {4, 4, 0},
                      {0, 4, 0},
                      {0, 0, 0},
                      {1, 1, 0},
                      {1, 3, 0},
                      {3, 3, 0},
                      {3, 1, 0},
                      {1, 1, 0}},
                     kUp, 12);
}

TEST(Polygon, uses_every_corner_of_flat_and_crossing_ones) {
  const std::vector<Vec3f> bow_tie = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(cover_of(bow_tie, kUp).triangles, 2U);
  const std::vector<Vec3f> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5F, 0, 0}};
  EXPECT_EQ(cover_of(line, kUp).triangles, 3U);
  EXPECT_EQ(cover_of(std::vector<Vec3f>(6, Vec3f(1, 2, 3)), kUp).triangles, 4U);
}

TEST(Polygon, gives_up_on_endless_work) {
  // A comb whose teeth hinder each other's ears.
  std::vector<Vec3f> comb;
  constexpr int kTeeth = 15'000;
  for (int i = 0; i < kTeeth; ++i) comb.emplace_back(float(i), i % 2 == 0 ? 0.0F : 1.0F, 0.0F);
  comb.emplace_back(float(kTeeth), 10.0F, 0.0F);
  comb.emplace_back(-1.0F, 10.0F, 0.0F);
  PolygonTriangulator impatient(10'000'000);
  EXPECT_TRUE(impatient.triangulate(comb).empty());
  PolygonTriangulator patient;
  EXPECT_EQ(patient.triangulate(comb).size(), comb.size() - 2);
}

// Star-shaped about the origin, so simple; radii and angles at random.
RC_GTEST_PROP(Polygon, covers_any_star_shaped_one, ()) {
  const int count = *rc::gen::inRange(4, 60);
  std::vector<Vec3f> corners;
  double area = 0;
  for (int i = 0; i < count; ++i) {
    const double jitter = 0.8 * *rc::gen::inRange(0, 1000) / 1000.0;
    const double angle = 2 * kPi * (i + jitter) / count;
    const double radius = *rc::gen::inRange(10, 1000) / 100.0;
    corners.emplace_back(float(radius * std::cos(angle)), float(radius * std::sin(angle)), 3.0F);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3f a = corners[i], b = corners[(i + 1) % corners.size()];
    area += (double(a.x) * double(b.y) - double(b.x) * double(a.y)) / 2;
  }
  const Cover cover = cover_of(corners, kUp);
  RC_ASSERT(cover.closed);
  RC_ASSERT(cover.least > 0);
  RC_ASSERT(std::abs(cover.area - area) < 1e-6 * area);
}

}  // namespace
}  // namespace arris
