#include "edgepoint/edge_projection.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <vector>

namespace arris {
namespace {

constexpr int kWidth = 70, kHeight = 45;

// 50 pixels a unit at depth 1; x right, y down, z forward, turned a little so that nothing is 0 or 1.
PixelView make_view() {
  PixelView view;
  view.width_px = kWidth;
  view.height_px = kHeight;
  view.eye = {0.1, -0.2, 0.05};
  view.pixel_from_world = Mat3d{{50, 0.3, 0.01}, {-0.2, 50, 0.02}, {35.5, 22.3, 1}};
  return view;
}

// A surface with a step: near on the left, far on the right, points in a third of the pixels.
DepthCells step_of_depth() {
  std::vector<PointKey> points(std::size_t(kWidth) * kHeight);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float depth = i % kWidth < 30 ? 1.0F : 3.0F;
    if (i % 3 == 0) points[i] = PointKey(std::bit_cast<std::uint32_t>(depth), std::uint32_t(i), 0);
  }
  DepthCells depth(kWidth, kHeight);
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(points, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.001F);
  return depth;
}

// Short and long ones, before and behind the surface, beside the picture, through and behind the eye.
std::vector<SoftEdge> random_edges(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<SoftEdge> edges;
  for (int i = 0; i < count; ++i) {
    const float size = i % 8 == 0 ? 1.0F : 0.03F, z = 1.7F + 2 * unit(random);
    const Vec3f a{unit(random) * z, unit(random) * z, z};
    const Vec3f b = a + Vec3f{unit(random), unit(random), unit(random)} * size;
    const Vec3f penumbra = i % 3 == 0 ? Vec3f{} : Vec3f{unit(random), unit(random), 0} * 0.06F;
    edges.push_back({{a, b}, penumbra, i % 2 == 0});
  }
  return edges;
}

Crossings rasterize(const std::vector<ScreenEdge>& edges, const DepthCells& depth) {
  Crossings crossings(kWidth, kHeight);
  clear_crossings({0, kHeight}, kHeight, crossings);
  rasterize_edges(edges, depth, {0, kHeight}, kWidth, kHeight, crossings);
  return crossings;
}

int count_different(const CrossingRows& a, const CrossingRows& b, int rows) {
  int different = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < kWidth; ++x) different += a.row(y)[x] != b.row(y)[x] ? 1 : 0;
  }
  return different;
}

template <class Edge>
void expect_same_marks(const std::vector<Edge>& edges) {
  const PixelView view = make_view();
  const DepthCells depth = step_of_depth();
  std::vector<ScreenEdge> all, seen;
  for (const Edge& edge : edges) all.push_back(project_edge(view, edge));
  project_seen(view, edges, depth, seen);
  EXPECT_GT(seen.size(), edges.size() / 8);
  EXPECT_LT(seen.size(), edges.size() / 2);
  const Crossings of_all = rasterize(all, depth), of_seen = rasterize(seen, depth);
  EXPECT_EQ(count_different(of_all.upper, of_seen.upper, kHeight + 1), 0);
  EXPECT_EQ(count_different(of_all.left, of_seen.left, kHeight), 0);
  EXPECT_EQ(count_different(of_all.mid_row, of_seen.mid_row, kHeight), 0);
  EXPECT_EQ(count_different(of_all.mid_column, of_seen.mid_column, kHeight), 0);
  EXPECT_GT(count_different(of_all.left, Crossings(kWidth, kHeight).left, kHeight), 300);
}

TEST(EdgeProjection, leaves_out_only_edges_that_mark_nothing) {
  const std::vector<SoftEdge> soft = random_edges(2003);
  std::vector<WorldEdge> hard;
  for (const SoftEdge& edge : soft) hard.push_back(edge.edge);
  expect_same_marks(hard);
  expect_same_marks(soft);
}

// Many at once as one by one.
TEST(EdgeProjection, is_that_of_single_edges_to_the_bit) {
  const PixelView view = make_view();
  DepthCells open(kWidth, kHeight);
  const std::vector<PointKey> none(std::size_t(kWidth) * kHeight);
  for (int i = 0; i < open.cell_rows(); ++i) open.fill_cells(none, i);
  for (int i = 0; i < open.limit_rows(); ++i) open.fill_limits(i, 0.001F);
  std::vector<WorldEdge> edges;
  for (const SoftEdge& edge : random_edges(1001)) edges.push_back(edge.edge);
  std::vector<ScreenEdge> seen;
  project_seen(view, edges, open, seen);
  std::size_t next = 0;
  for (const WorldEdge& edge : edges) {
    const ScreenEdge e = project_edge(view, edge);
    if (next == seen.size()) break;
    const ScreenEdge& s = seen[next];
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    const bool same = s.x0 == e.x0 && s.y0 == e.y0 && s.x1 == e.x1 && s.y1 == e.y1 &&
                      bits(s.inverse_depth0) == bits(e.inverse_depth0) &&
                      bits(s.inverse_depth1) == bits(e.inverse_depth1);
    next += same ? 1 : 0;
  }
  EXPECT_EQ(next, seen.size());
  EXPECT_GT(next, 200U);
}

}  // namespace
}  // namespace arris
