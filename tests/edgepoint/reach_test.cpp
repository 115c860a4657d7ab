#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "edgepoint/classify.h"
#include "edgepoint/edge_code.h"
#include "edgepoint/edge_raster.h"
#include "edgepoint/reach_planes.h"

namespace arris {
namespace {

// The paper's way: pixel by pixel, from the regions at the corners.
class SlowReach {
 public:
  explicit SlowReach(const EdgePointImage& image) : image_(image) {}

  [[nodiscard]] bool reaches(int x, int y, int dx, int dy) const {
    return between(x, y, dx, dy)[0][0];
  }

 private:
  using Matrix = std::array<std::array<bool, 2>, 2>;

  [[nodiscard]] bool inside(int x, int y) const {
    return x >= 0 && y >= 0 && x < image_.width_px && y < image_.height_px;
  }
  // 0: primary, 1: secondary, -1: none, of a corner, clockwise from the upper left.
  [[nodiscard]] int region(int x, int y, unsigned corner) const {
    if (!inside(x, y)) return -1;
    const PixelCode code = image_.codes[image_.offset(x, y)];
    if (code.is_complex()) return -1;
    if (code.is_empty()) return 0;
    const bool in_a = (edge_tables().corners_a[code.edge()] >> corner & 1U) != 0;
    return in_a == code.primary_is_a() ? 0 : 1;
  }
  // Over a common side.
  [[nodiscard]] Matrix step(int x, int y, int dx, int dy) const {
    constexpr unsigned kEnds[4][4] = {{1, 2, 0, 3}, {0, 3, 1, 2}, {3, 2, 0, 1}, {0, 1, 3, 2}};
    const auto& ends = kEnds[dx > 0 ? 0 : dx < 0 ? 1 : dy > 0 ? 2 : 3];
    Matrix m{};
    for (unsigned i = 0; i < 2; ++i) {
      const int a = region(x, y, ends[i]), b = region(x + dx, y + dy, ends[2 + i]);
      if (a >= 0 && b >= 0) m[std::size_t(a)][std::size_t(b)] = true;
    }
    return m;
  }
  static Matrix chain(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) m[i][j] = (a[i][0] && b[0][j]) || (a[i][1] && b[1][j]);
    }
    return m;
  }
  [[nodiscard]] Matrix between(int x, int y, int dx, int dy) const {
    const int sx = dx > 0 ? 1 : -1, sy = dy > 0 ? 1 : -1;
    if (std::abs(dx) + std::abs(dy) == 1) return step(x, y, dx, dy);
    Matrix m{};
    const auto combine = [&](const Matrix& other) {
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) m[i][j] = m[i][j] || other[i][j];
      }
    };
    if (dx != 0) combine(chain(between(x, y, dx - sx, dy), step(x + dx - sx, y + dy, sx, 0)));
    if (dy != 0) combine(chain(between(x, y, dx, dy - sy), step(x + dx, y + dy - sy, 0, sy)));
    return m;
  }

  const EdgePointImage& image_;
};

// Random segments, also short ones.
EdgePointImage random_image(int width, int height, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto between = [&](float a, float b) { return a + (b - a) * unit(random); };
  std::vector<ScreenEdge> edges;
  for (int i = 0; i < width * height / 30; ++i) {
    ScreenEdge edge;
    edge.x0 = between(-5, float(width) + 5);
    edge.y0 = between(-5, float(height) + 5);
    edge.x1 = edge.x0 + between(-12, 12);
    edge.y1 = edge.y0 + between(-12, 12);
    edge.inverse_depth0 = edge.inverse_depth1 = 1;
    edges.push_back(edge);
  }
  EdgePointImage image(width, height);
  DepthCells depth(width, height);
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(image.points, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.01F);
  clear_crossings({0, height}, height, image.crossings);
  rasterize_edges(edges, depth, {0, height}, width, height, image.crossings);
  classify_pixels({0, height}, image);
  return image;
}

TEST(Reach, planes_agree_with_chains_of_pixels) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    // Also pictures that end within a word, and narrow ones.
    const int width = seed == 1 ? 200 : seed == 2 ? 64 : seed == 3 ? 65 : 3, height = 40;
    EdgePointImage image = random_image(width, height, seed);
    find_reach(image.corners, {0, 17}, image.reach);
    find_reach(image.corners, {17, height}, image.reach);
    const SlowReach slow(image);
    int reached = 0, kept_apart = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (std::size_t k = 0; k < kReachOffsets; ++k) {
          const auto [dx, dy] = kReachOffset[k];
          const bool expected = slow.reaches(x, y, dx, dy);
          ASSERT_EQ(image.reach.at(k, x, y), expected) << x << " " << y << " " << dx << " " << dy;
          (expected ? reached : kept_apart) += 1;
        }
      }
    }
    EXPECT_GT(reached, 100);
    EXPECT_GT(kept_apart, 100);
  }
}

TEST(Reach, is_symmetric) {
  EdgePointImage image = random_image(100, 30, 9);
  const SlowReach slow(image);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 100; ++x) {
      for (const auto& [dx, dy] : kReachOffset) {
        ASSERT_EQ(slow.reaches(x, y, dx, dy), slow.reaches(x + dx, y + dy, -dx, -dy));
      }
    }
  }
}

// A line across the whole picture parts it: nothing above reaches anything below.
TEST(Reach, a_line_parts_the_picture) {
  constexpr int kSize = 50;
  for (int i = 0; i < 40; ++i) {
    const float at = 10 + 0.37F * float(i), slope = -0.6F + 0.03F * float(i);
    const ScreenEdge edge{-2, at - 2 * slope, 1, kSize + 2, at + slope * (kSize + 2), 1};
    EdgePointImage image(kSize, kSize);
    DepthCells depth(kSize, kSize);
    for (int r = 0; r < depth.cell_rows(); ++r) depth.fill_cells(image.points, r);
    for (int r = 0; r < depth.limit_rows(); ++r) depth.fill_limits(r, 0.01F);
    clear_crossings({0, kSize}, kSize, image.crossings);
    rasterize_edges({&edge, 1}, depth, {0, kSize}, kSize, kSize, image.crossings);
    const PixelClasses classes = classify_pixels({0, kSize}, image);
    EXPECT_EQ(classes.complex, 0U);
    EXPECT_GE(classes.simple, 20U);
    find_reach(image.corners, {0, kSize}, image.reach);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        for (std::size_t k = 0; k < kReachOffsets; ++k) {
          const int tx = x + kReachOffset[k].dx, ty = y + kReachOffset[k].dy;
          if (tx < 0 || tx >= kSize || ty >= kSize) continue;
          const auto above = [&](int px, int py) {
            return float(py) + 1 < at + slope * (float(px) + 0.5F) - std::abs(slope);
          };
          const auto below = [&](int px, int py) {
            return float(py) > at + slope * (float(px) + 0.5F) + std::abs(slope);
          };
          if (above(x, y) && below(tx, ty)) {
            EXPECT_FALSE(image.reach.at(k, x, y));
          } else if (above(x, y) && above(tx, ty)) {
            EXPECT_TRUE(image.reach.at(k, x, y));
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace arris
