#include "io/csg_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/csg_membership.h"

namespace arris {
namespace {

// Inside by the odd number of edges that a ray to the right crosses.
bool is_odd(const std::vector<Outline>& outlines, Vec2d p) {
  bool odd = false;
  for (const Outline& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      if ((a.y <= p.y) == (b.y <= p.y)) continue;
      odd ^= a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x;
    }
  }
  return odd;
}

double distance_to_edges(const std::vector<Outline>& outlines, Vec2d p) {
  double nearest = 1e300;
  for (const Outline& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      nearest =
          std::min(nearest, test::distance_to_segment({a.x, a.y, 0}, {b.x, b.y, 0}, {p.x, p.y, 0}));
    }
  }
  return nearest;
}

void expect_even_odd(const std::vector<Outline>& outlines, std::mt19937& random) {
  const std::optional<CsgRegion> region = make_even_odd_region(outlines);
  ASSERT_TRUE(region);
  std::uniform_real_distribution<double> place(-0.2, 8.2);
  for (int i = 0; i < 300; ++i) {
    const Vec2d p{place(random), place(random)};
    if (distance_to_edges(outlines, p) < 1e-6) continue;
    const int winding = test::winding_number(*region, p);
    ASSERT_EQ(winding, is_odd(outlines, p) ? 1 : 0) << p.x << ' ' << p.y;
    ASSERT_EQ(is_inside(*region, p), winding != 0);
  }
}

TEST(CsgRegion, winds_once_round_what_is_inside_even_odd) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> size(3, 9), count(1, 3), step(0, 8);
  std::uniform_real_distribution<double> anywhere(0, 8);
  for (int round = 0; round < 200; ++round) {
    // Every other round on a grid: corners on edges, edges on edges.
    std::vector<Outline> outlines(std::size_t(count(random)));
    for (Outline& outline : outlines) {
      outline.resize(std::size_t(size(random)));
      for (Vec2d& p : outline) {
        p = round % 2 == 0 ? Vec2d{anywhere(random), anywhere(random)}
                           : Vec2d{double(step(random)), double(step(random))};
      }
    }
    SCOPED_TRACE(round);
    expect_even_odd(outlines, random);
  }
}

TEST(CsgRegion, is_nothing_without_area) {
  EXPECT_TRUE(make_even_odd_region({{{0, 0}, {1, 1}, {2, 2}}})->outlines.empty());
  EXPECT_TRUE(make_even_odd_region({{{0, 0}, {1, 0}}})->outlines.empty());
  EXPECT_TRUE(make_even_odd_region({})->outlines.empty());
  // Twice the same square cancels.
  const Outline square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_TRUE(make_even_odd_region({square, square})->outlines.empty());
}

TEST(CsgRegion, gives_up_on_too_much_work) {
  Outline zigzag;
  for (int i = 0; i < 60'000; ++i) zigzag.push_back({double(i % 2) * 8, i * 1e-4});
  EXPECT_FALSE(make_even_odd_region({zigzag}));
}

TEST(CsgRegion, triangulates_outlines_with_holes) {
  const auto region = make_even_odd_region({{{0, 0}, {8, 0}, {8, 8}, {0, 8}},
                                            {{1, 1}, {3, 1}, {3, 3}, {1, 3}},
                                            {{5, 5}, {7, 5}, {6, 7}},
                                            {{5.5, 5.2}, {6.5, 5.2}, {6, 6}}});
  ASSERT_TRUE(region);
  const auto triangles = triangulate(*region);
  ASSERT_TRUE(triangles);
  std::vector<Vec2d> points;
  for (const Outline& o : region->outlines) points.insert(points.end(), o.begin(), o.end());
  double area = 0;
  for (const Triangle& t : *triangles)
    area += cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) / 2;
  EXPECT_NEAR(area, 64 - 4 - 2 + 0.4, 1e-9);
}

TEST(CsgRegion, keeps_what_is_right_of_the_axis) {
  const CsgRegion right =
      clip_to_right({{{{-2, 0}, {2, 0}, {2, 1}, {-1, 1}, {-1, 2}, {2, 2}, {2, 3}, {-2, 3}}}});
  for (const double y : {0.5, 1.5, 2.5}) {
    EXPECT_EQ(is_inside(right, {1, y}), y != 1.5);
    EXPECT_FALSE(is_inside(right, {-1.5, y}));
  }
  EXPECT_TRUE(clip_to_right({{{{-2, 0}, {-1, 0}, {-1, 1}}}}).outlines.empty());
}

}  // namespace
}  // namespace arris
