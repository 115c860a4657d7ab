#include "edgepoint/edge_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace arris {
namespace {

constexpr int kWidth = 70, kHeight = 45;

DepthCells open_depth() {
  DepthCells depth(kWidth, kHeight);
  const std::vector<PointKey> none(std::size_t(kWidth) * kHeight);
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(none, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.01F);
  return depth;
}

Crossings rasterize(const std::vector<ScreenEdge>& edges, int bands) {
  const DepthCells depth = open_depth();
  Crossings crossings(kWidth, kHeight);
  for (int b = 0; b < bands; ++b) {
    const RowBand band{kHeight * b / bands, kHeight * (b + 1) / bands};
    clear_crossings(band, kHeight, crossings);
    rasterize_edges(edges, depth, band, kWidth, kHeight, crossings);
  }
  return crossings;
}

float on_grid(double v) {
  return float(std::round(v * 256) / 256);
}

std::vector<ScreenEdge> random_edges(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<ScreenEdge> edges;
  for (int i = 0; i < count; ++i) {
    ScreenEdge e;
    e.x0 = on_grid(unit(random) * (kWidth + 4) - 2);
    e.y0 = on_grid(unit(random) * (kHeight + 4) - 2);
    e.x1 = on_grid(unit(random) * (kWidth + 4) - 2);
    e.y1 = on_grid(unit(random) * (kHeight + 4) - 2);
    if (i % 5 == 0) {  // through corners
      e.x0 = std::round(e.x0);
      e.y0 = std::round(e.y0);
      e.x1 = e.x0 + 20;
      e.y1 = e.y0 + (i % 2 == 0 ? 20.0F : -20.0F);
    }
    if (i % 7 == 0) e.x1 = e.x0;
    if (i % 11 == 0) e.y1 = e.y0;
    e.inverse_depth0 = e.inverse_depth1 = 1;
    edges.push_back(e);
  }
  return edges;
}

bool bit(std::uint8_t mask, int at) {
  return (mask >> unsigned(at) & 1U) != 0;
}

TEST(EdgeRaster, marks_where_lines_are_crossed) {
  for (const ScreenEdge& e : random_edges(3, 400)) {
    const Crossings crossings = rasterize({e}, 1);
    const auto y_at = [&](double x) {
      return e.y0 + (x - e.x0) * (double(e.y1) - e.y0) / (double(e.x1) - e.x0);
    };
    const auto x_at = [&](double y) {
      return e.x0 + (y - e.y0) * (double(e.x1) - e.x0) / (double(e.y1) - e.y0);
    };
    int expected = 0, found = 0;
    for (int k = 0; k <= kWidth; ++k) {
      if (std::floor(std::min(e.x0, e.x1)) >= float(k) ||
          std::floor(std::max(e.x0, e.x1)) < float(k))
        continue;
      const double y = y_at(k);
      const int row = int(std::floor(y));
      if (y <= 0 || y >= kHeight) continue;
      ++expected;
      const int eighth = int((y - row) * 8);
      // Exactly between two places, either will do.
      const bool there = bit(crossings.left.row(row)[k], eighth) ||
                         (y * 8 == std::floor(y * 8) &&
                          (eighth > 0 ? bit(crossings.left.row(row)[k], eighth - 1)
                                      : row > 0 && bit(crossings.left.row(row - 1)[k], 7)));
      found += there ? 1 : 0;
    }
    for (int k = 0; k <= kHeight; ++k) {
      if (std::floor(std::min(e.y0, e.y1)) >= float(k) ||
          std::floor(std::max(e.y0, e.y1)) < float(k))
        continue;
      const double x = x_at(k);
      const int column = int(std::floor(x));
      if (x < 0 || x >= kWidth) continue;
      ++expected;
      found += bit(crossings.upper.row(k)[column], int((x - column) * 8)) ? 1 : 0;
    }
    EXPECT_EQ(found, expected);
  }
}

// One edge that passes a pixel crosses its boundary twice, wherever it runs: no pixel on its way is left with one.
TEST(EdgeRaster, tells_one_way_through_the_pixels) {
  for (ScreenEdge e : random_edges(4, 600)) {
    // From outside to outside.
    const float dx = e.x1 - e.x0, dy = e.y1 - e.y0;
    if (dx == 0 && dy == 0) continue;
    const float far = 200 / std::max(std::abs(dx), std::abs(dy));
    const float steps = std::ceil(far);
    e.x0 -= dx * steps;
    e.y0 -= dy * steps;
    e.x1 += dx * steps;
    e.y1 += dy * steps;
    const Crossings crossings = rasterize({e}, 1);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const int count = std::popcount(boundary_mask(crossings.of_pixel(x, y)));
        ASSERT_TRUE(count == 0 || count == 2)
            << count << " at " << x << " " << y << " from " << e.x0 << " " << e.y0 << " to " << e.x1
            << " " << e.y1;
      }
    }
  }
}

// A chain of segments crosses every line as often as it changes sides.
TEST(EdgeRaster, ends_in_common_are_crossed_once) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const float y0 = on_grid(5 + unit(random) * 30);
    std::vector<ScreenEdge> chain;
    float x = -1, y = y0;
    while (x < kWidth + 1) {
      const float nx = i % 2 == 0 ? x + 1 : on_grid(x + 0.2 + unit(random) * 3);
      const float ny = on_grid(y0 + unit(random) * 4);
      chain.push_back({x, y, 1, nx, ny, 1});
      x = nx;
      y = ny;
    }
    const Crossings crossings = rasterize(chain, 1);
    for (int k = 0; k <= kWidth; ++k) {
      int count = 0;
      for (int row = 0; row < kHeight; ++row) count += std::popcount(crossings.left.row(row)[k]);
      ASSERT_EQ(count, 1) << k;
    }
  }
}

TEST(EdgeRaster, bands_agree) {
  const std::vector<ScreenEdge> edges = random_edges(6, 300);
  const Crossings one = rasterize(edges, 1), four = rasterize(edges, 4);
  for (int y = 0; y <= kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(one.upper.row(y)[x], four.upper.row(y)[x]);
  }
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(one.left.row(y)[x], four.left.row(y)[x]);
      ASSERT_EQ(one.mid_row.row(y)[x], four.mid_row.row(y)[x]);
      ASSERT_EQ(one.mid_column.row(y)[x], four.mid_column.row(y)[x]);
    }
  }
}

TEST(EdgeRaster, edges_behind_the_eye_are_cut_off) {
  PixelView view;
  view.width_px = view.height_px = 100;
  // x right, y down, z forward; 90 degrees.
  view.pixel_from_world = Mat3d{{50, 0, 0}, {0, 50, 0}, {50, 50, 1}};
  const ScreenEdge behind = project_edge(view, {{0, 0, -1}, {1, 0, -2}});
  EXPECT_EQ(behind.x0, behind.x1);
  const ScreenEdge across = project_edge(view, {{0.5F, 0, 1}, {0.5F, 0, -1}});
  EXPECT_NEAR(across.x0, 75, 0.01);
  EXPECT_GT(across.x1, 100);
  EXPECT_NEAR(across.y1, 50, 0.01);
  const ScreenEdge beside = project_edge(view, {{-5, 0, 1}, {-4, 0.1F, 1}});
  EXPECT_EQ(beside.x0, beside.x1);
}

TEST(EdgeRaster, edges_of_wide_penumbras_and_inner_ones_of_narrow_ones_are_left_out) {
  PixelView view;
  view.width_px = view.height_px = 100;
  view.pixel_from_world = Mat3d{{50, 0, 0}, {0, 50, 0}, {50, 50, 1}};
  // 50 pixels a unit; from x = 60 to 80 at y = 50, slanted by as many pixels as it is long.
  const WorldEdge edge{{0.2F, 0, 1}, {0.6F, 0.4F, 1}};
  const auto drawn = [&](Vec3f penumbra, bool is_umbra) {
    const ScreenEdge e = project_edge(view, SoftEdge{edge, penumbra, is_umbra});
    return e.x0 != e.x1;
  };
  // Across, in pixels: 50 · 0.7071 · √2 of the second argument.
  const auto across = [](double pixels) {
    const auto d = float(pixels / 50 / std::sqrt(2.0));
    return Vec3f{d, -d, 0};
  };
  for (const bool is_umbra : {false, true}) {
    EXPECT_TRUE(drawn({}, is_umbra));
    EXPECT_TRUE(drawn(across(1.9), is_umbra));
    EXPECT_TRUE(drawn(across(-1.9), is_umbra));
    EXPECT_FALSE(drawn(across(2.1), is_umbra));
    // Along the edge it has no width.
    EXPECT_TRUE(drawn(across(1.5) + Vec3f{0.3F, 0.3F, 0}, is_umbra));
    EXPECT_FALSE(drawn({0, 0, -2}, is_umbra));  // ends behind the eye
    EXPECT_EQ(drawn(across(0.5), is_umbra), !is_umbra);
  }
}

TEST(EdgeRaster, hidden_edges_leave_no_mark) {
  std::vector<PointKey> points(std::size_t(kWidth) * kHeight);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 3 == 0) points[i] = PointKey(std::bit_cast<std::uint32_t>(2.0F), std::uint32_t(i), 0);
  }
  DepthCells depth(kWidth, kHeight);
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(points, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.001F);
  for (const float distance : {1.0F, 2.0F, 3.0F}) {
    const ScreenEdge edge{5, 5, 1 / distance, 60, 40, 1 / distance};
    Crossings crossings(kWidth, kHeight);
    clear_crossings({0, kHeight}, kHeight, crossings);
    rasterize_edges({&edge, 1}, depth, {0, kHeight}, kWidth, kHeight, crossings);
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) count += std::popcount(crossings.left.row(y)[x]);
    }
    EXPECT_EQ(count, distance > 2.5F ? 0 : 55) << distance;
  }
}

// Where an object has moved, nothing may be known yet of what it uncovered: its border is no less an edge.
TEST(EdgeRaster, edges_with_points_on_one_side_alone_are_seen) {
  constexpr int kBorder = 18;
  std::vector<PointKey> points(std::size_t(kWidth) * kHeight);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % kWidth >= kBorder)
      points[i] = PointKey(std::bit_cast<std::uint32_t>(2.0F), std::uint32_t(i), 0);
  }
  DepthCells depth(kWidth, kHeight);
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(points, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.001F);
  const ScreenEdge beside{kBorder - 1.5F, -1, 0.4F, kBorder - 1.5F, kHeight + 1, 0.4F};
  const ScreenEdge behind{kBorder + 8.5F, 0, 0.4F, kBorder + 8.5F, kHeight, 0.4F};
  for (const ScreenEdge& edge : {beside, behind}) {
    Crossings crossings(kWidth, kHeight);
    clear_crossings({0, kHeight}, kHeight, crossings);
    rasterize_edges({&edge, 1}, depth, {0, kHeight}, kWidth, kHeight, crossings);
    int count = 0;
    for (int y = 0; y < kHeight; ++y) count += crossings.upper.row(y)[int(edge.x0)] != 0;
    EXPECT_EQ(count, edge.x0 == beside.x0 ? kHeight : 0);
  }
}

}  // namespace
}  // namespace arris
