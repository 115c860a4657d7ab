#include "edgepoint/edge_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "arris/math.h"

namespace arris {
namespace {

Vec2d place_on_boundary(double along) {
  const double t = along - std::floor(along);
  switch (int(along) & 3) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

// Region A is to the left of the way from the first end to the last, with y down.
bool in_a(Vec2d first, Vec2d last, Vec2d p) {
  return (last.x - first.x) * (p.y - first.y) - (last.y - first.y) * (p.x - first.x) < 0;
}

template <class Call>
void for_codes(const Call& call) {
  for (std::uint32_t first = 0; first < 32; ++first) {
    for (std::uint32_t last = first + 1; last < 32; ++last) {
      if (first / 8 != last / 8) call(first, last);
    }
  }
}

TEST(EdgeCode, segments_go_clockwise_from_the_upper_left) {
  EXPECT_EQ(boundary_mask({.top = 1}), 1U);
  EXPECT_EQ(boundary_mask({.top = 0x80}), 1U << 7U);
  EXPECT_EQ(boundary_mask({.right = 1}), 1U << 8U);
  EXPECT_EQ(boundary_mask({.right = 0x80}), 1U << 15U);
  EXPECT_EQ(boundary_mask({.bottom = 0x80}), 1U << 16U);
  EXPECT_EQ(boundary_mask({.bottom = 1}), 1U << 23U);
  EXPECT_EQ(boundary_mask({.left = 0x80}), 1U << 24U);
  EXPECT_EQ(boundary_mask({.left = 1}), 1U << 31U);
}

TEST(EdgeCode, two_crossings_on_two_sides_are_simple) {
  for (std::uint32_t i = 0; i < 32; ++i) {
    EXPECT_EQ(classify_boundary(1U << i), kComplexEdge);
    for (std::uint32_t j = i + 1; j < 32; ++j) {
      const std::uint32_t code = classify_boundary(1U << i | 1U << j);
      EXPECT_EQ(code, i / 8 == j / 8 ? kComplexEdge : edge_code(i, j));
      EXPECT_EQ(is_simple(code), i / 8 != j / 8);
    }
  }
  EXPECT_EQ(classify_boundary(0), kEmptyEdge);
  EXPECT_EQ(classify_boundary(1U | 1U << 9U | 1U << 18U), kComplexEdge);
}

// Every pair of crossings, each doubled or not, in segments beside each other.
TEST(EdgeCode, edges_side_by_side_are_one) {
  for (std::uint32_t i = 0; i < 31; ++i) {
    for (std::uint32_t j = i + 1; j < 32; ++j) {
      if (i / 8 == j / 8) continue;
      const std::uint32_t one = classify_boundary(1U << i | 1U << j);
      const std::uint32_t doubled = 1U << i | 2U << i | 1U << j;
      if (i % 8 < 7) {
        EXPECT_EQ(classify_boundary(doubled), one);
      }
      if (i % 8 < 7 && j % 8 < 7) {
        EXPECT_EQ(classify_boundary(doubled | 2U << j), one);
      }
      // Sides end at corners; three segments and gaps are two edges.
      if (i % 8 == 7 && j > i + 2) {
        EXPECT_EQ(classify_boundary(doubled), kComplexEdge);
      }
      if (i % 8 < 6) {
        EXPECT_EQ(classify_boundary(doubled | 4U << i), kComplexEdge);
      }
      if (i % 8 < 6) {
        EXPECT_EQ(classify_boundary((doubled ^ 2U << i) | 4U << i), kComplexEdge);
      }
    }
  }
}

TEST(EdgeCode, areas_and_corners_are_those_of_the_edge) {
  const EdgeTables& tables = edge_tables();
  for_codes([&](std::uint32_t first, std::uint32_t last) {
    const std::uint32_t code = edge_code(first, last);
    const Vec2d a = place_on_boundary((first + 0.5) / 8), b = place_on_boundary((last + 0.5) / 8);
    constexpr int kSide = 64;
    int inside = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      inside += in_a(a, b, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}) ? 1 : 0;
    }
    EXPECT_NEAR(tables.area_a[code], double(inside) / (kSide * kSide), 0.01)
        << first << " " << last;
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      EXPECT_EQ((tables.corners_a[code] >> corner & 1U) != 0,
                in_a(a, b, place_on_boundary(corner)));
    }
  });
}

// Wherever in its two segments the edge ends, a cell that is not ambiguous lies wholly on the side it is said to.
TEST(EdgeCode, cells_are_on_their_side_of_every_edge_of_the_code) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const EdgeTables& tables = edge_tables();
  int decided = 0, all = 0;
  for_codes([&](std::uint32_t first, std::uint32_t last) {
    for (int i = 0; i < 50; ++i) {
      const double from = unit(random), to = unit(random);
      const Vec2d a = place_on_boundary((first + from) / 8), b = place_on_boundary((last + to) / 8);
      const double x = unit(random), y = unit(random);
      const auto cell = std::uint32_t(int(y * 4) * 4 + int(x * 4));
      const RegionOf region = tables.region_of(edge_code(first, last), cell);
      ++all;
      if (region == RegionOf::ambiguous) continue;
      ++decided;
      EXPECT_EQ(region == RegionOf::a, in_a(a, b, {x, y})) << first << " " << last << " " << cell;
    }
  });
  // An edge crosses about five cells of sixteen.
  EXPECT_GT(double(decided) / all, 0.6);
}

TEST(EdgeCode, sides_of_a_region_are_those_it_touches) {
  const EdgeTables& tables = edge_tables();
  // From the middle of the top to the middle of the right side: A is the upper right corner.
  const std::uint32_t code = edge_code(4, 12);
  EXPECT_EQ(tables.sides_a[code].count, 2);
  EXPECT_EQ(tables.sides_b[code].count, 4);
  EXPECT_EQ(tables.sides_b[code].order & 3U, 2U);
}

}  // namespace
}  // namespace arris
