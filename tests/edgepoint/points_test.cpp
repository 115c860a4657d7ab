// Points: kept, projected, found to be hidden, and made into colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "edgepoint/classify.h"
#include "edgepoint/complex_pixel.h"
#include "edgepoint/edge_raster.h"
#include "edgepoint/hidden_points.h"
#include "edgepoint/hole_filler.h"
#include "edgepoint/interpolate.h"
#include "edgepoint/kernel.h"
#include "edgepoint/point_cache.h"
#include "edgepoint/point_raster.h"
#include "edgepoint/reach_planes.h"
#include "edgepoint/sample_plan.h"

namespace arris {
namespace {

constexpr int kWidth = 90, kHeight = 50;

// x right, y down, z forward.
PixelView make_view() {
  PixelView view;
  view.eye = {0.3, -0.2, -4};
  view.width_px = kWidth;
  view.height_px = kHeight;
  view.pixel_from_world = Mat3d{{60, 0, 0}, {0, 60, 0}, {kWidth / 2.0, kHeight / 2.0, 1}};
  return view;
}

std::vector<ShadedPoint> random_points(std::mt19937& random, int count) {
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<ShadedPoint> points;
  for (int i = 0; i < count; ++i) {
    ShadedPoint p;
    p.position.x = 4 * unit(random);
    p.position.y = 3 * unit(random);
    p.position.z = 5 * unit(random);
    p.radiance = Rgb(float(i % 7) + 1);
    p.object = std::uint32_t(i % 3);
    if (i % 10 == 0) {
      p.object = kFarObject;
      p.position = normalize(p.position + Vec3f{0, 0, 6});
    }
    points.push_back(p);
  }
  return points;
}

TEST(PointCache, radiance_keeps_nine_bits_of_its_largest_channel) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-12, 15), unit(0, 1);
  for (int i = 0; i < 20'000; ++i) {
    Rgb c;
    const float scale = std::exp2(exponent(random));
    c.x = scale * unit(random);
    c.y = scale * unit(random);
    c.z = scale * unit(random);
    const Rgb back = unpack_radiance(pack_radiance(c));
    const float step = max_component(c) / 256;
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(back[k], c[k], 0.5F * step * 1.001F + 1e-8F);
  }
  EXPECT_EQ(unpack_radiance(pack_radiance({})), Rgb());
  EXPECT_EQ(unpack_radiance(pack_radiance({-1, NAN, 0})), Rgb());
  EXPECT_EQ(max_component(unpack_radiance(pack_radiance(Rgb(1e9F)))), 65408);
  // With an exposure the range is that which it shows.
  for (const int stops : {-64, -7, 20, 64}) {
    const float unit_of_it = std::ldexp(1.0F, -stops);
    EXPECT_EQ(unpack_radiance(pack_radiance(Rgb(0.75F) * unit_of_it, stops), stops),
              Rgb(0.75F) * unit_of_it);
    EXPECT_EQ(max_component(unpack_radiance(pack_radiance(Rgb(1e9F) * unit_of_it, stops), stops)),
              65408 * unit_of_it);
  }
}

TEST(PointCache, replaces_points_where_they_are_and_makes_room_when_full) {
  std::mt19937 random(2);
  PointCache cache(1000);
  for (std::uint32_t frame = 0; frame < 40; ++frame) cache.add(random_points(random, 100), frame);
  const std::size_t full = cache.size();
  EXPECT_GE(full, 1000U);
  EXPECT_LE(full, 1000U + 3 * kPointBlock);
  ShadedPoint point = random_points(random, 2)[1];
  point.replaces = 3;
  point.object = cache.blocks()[0].is_far ? kFarObject : 1;
  cache.add({&point, 1}, 2 * kFramesOfAge + 8);
  EXPECT_EQ(cache.size(), full);
  EXPECT_EQ(cache.x()[3], point.position.x);
  EXPECT_EQ(cache.looks()[3].born, 2);
}

TEST(PointCache, moves_the_points_of_an_object_only) {
  std::mt19937 random(3);
  PointCache cache(1000), moved(1000);
  const std::vector<ShadedPoint> points = random_points(random, 500);
  cache.add(points, 1);
  moved.add(points, 1);
  std::vector<std::optional<Affine3d>> to_from(3);
  to_from[1] = Affine3d{{}, {1, 2, 3}};
  moved.move(to_from);
  int count = 0;
  for (std::size_t b = 0; b < cache.blocks().size(); ++b) {
    for (std::size_t i = b * kPointBlock; i < b * kPointBlock + cache.blocks()[b].count; ++i) {
      const bool is_moved = moved.x()[i] != cache.x()[i];
      count += is_moved ? 1 : 0;
      if (!is_moved) continue;
      EXPECT_FLOAT_EQ(moved.z()[i], cache.z()[i] + 3);
      EXPECT_EQ(moved.looks()[i].stale, 256 * kMovedStale.add);
      EXPECT_LE(moved.blocks()[b].lower.x, moved.x()[i]);
      EXPECT_GE(moved.blocks()[b].upper.x, moved.x()[i]);
    }
  }
  EXPECT_EQ(count, std::count_if(points.begin(), points.end(),
                                 [](const ShadedPoint& p) { return p.object == 1; }));
}

TEST(PointCache, objects_have_numbers_of_24_bits) {
  std::vector<ShadedPoint> points;
  for (const std::uint32_t object : {0U, 0xffffU, 0x10000U, 0xabcdefU, kFarObject - 1}) {
    points.push_back({{1, 2, 3}, Rgb(1), 0, {}, object, kNoPoint});
  }
  PointCache cache(points.size());
  cache.add(points, 0);
  for (std::uint32_t i = 0; i < points.size(); ++i) EXPECT_EQ(cache.objects()[i], points[i].object);
}

TEST(PointCache, points_that_turn_are_seen_from_all_sides) {
  ShadedPoint point;
  point.object = 0;
  point.normal = {0, 0, 1};
  for (const bool turns : {false, true}) {
    PointCache cache(1);
    cache.add({&point, 1}, 0);
    std::vector<std::optional<Affine3d>> to_from(1);
    to_from[0] = Affine3d{{}, {1, 2, 3}};
    if (turns) to_from[0]->linear = {{0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}};
    cache.move(to_from);
    EXPECT_EQ(cache.normals()[0] == kNoNormal, turns);
  }
}

Vec3f random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  Vec3f v;
  v.x = normal(random);
  v.y = normal(random);
  v.z = normal(random);
  return normalize(v);
}

TEST(PackedNormal, is_off_by_its_error_at_most_and_exact_along_axes) {
  std::mt19937 random(14);
  float worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3f n = random_direction(random), back = unpack_normal(pack_normal(n));
    worst = std::max(worst, length(cross(n, back)) / length(back));
    ASSERT_GT(dot(n, back), 0) << i;
    ASSERT_LE(length(back), kNormalSteps * 1.0001F);
    ASSERT_NE(pack_normal(n), kNoNormal);
  }
  EXPECT_LE(worst, kNormalError);
  EXPECT_GT(worst, 0.7F * kNormalError);
  for (const Vec3f axis : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}}) {
    EXPECT_EQ(unpack_normal(pack_normal(axis)), axis * kNormalSteps);
    EXPECT_EQ(unpack_normal(pack_normal(-axis)), axis * -kNormalSteps);
  }
  EXPECT_EQ(pack_normal({}), kNoNormal);
}

TEST(PointRaster, leaves_out_points_of_the_side_that_is_not_seen) {
  std::mt19937 random(15);
  const PixelView view = make_view();
  std::vector<ShadedPoint> given = random_points(random, 6000);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (i % 4 != 0) given[i].normal = random_direction(random);
  }
  PointCache cache(8000), facing(8000);
  cache.add(given, 0);
  // How far they are turned away, as a sine; far points never are.
  const auto turned = [&](const ShadedPoint& p) {
    if (p.object == kFarObject) return -1.0;
    const Vec3d to = Vec3d(p.position) - view.eye;
    return dot(Vec3d(p.normal), to) / length(to);
  };
  std::erase_if(given, [&](const ShadedPoint& p) { return turned(p) > 0; });
  facing.add(given, 0);
  const auto depths = [&](const PointCache& points) {
    std::vector<PointKey> keys(std::size_t(kWidth) * kHeight);
    const std::vector<RowBand> rows = find_block_rows(view, points, 1);
    std::vector<std::uint32_t> seen(rows.size() + 1);
    project_points(view, points, rows, {0, kHeight}, keys, seen);
    return keys;
  };
  const std::vector<PointKey> all = depths(cache), wanted = depths(facing);
  int same = 0, grazing = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].is_none() && wanted[i].is_none()) continue;
    ASSERT_FALSE(all[i].is_none());
    if (!wanted[i].is_none() && all[i].depth() == wanted[i].depth()) {
      ++same;
      continue;
    }
    // Only what is seen along its surface may be there besides.
    ++grazing;
    const PointNumber number = all[i].point();
    ShadedPoint shown;
    shown.object = 0;
    shown.position = {cache.x()[number], cache.y()[number], cache.z()[number]};
    shown.normal = normalize(unpack_normal(cache.normals()[number]));
    ASSERT_LT(turned(shown), 4 * kNormalError);
  }
  EXPECT_GT(same, 500);
  EXPECT_LT(grazing, same / 20);
}

TEST(PointRaster, keeps_the_nearest_point_of_each_pixel) {
  std::mt19937 random(4);
  const PixelView view = make_view();
  PointCache cache(8000);
  cache.add(random_points(random, 6000), 0);
  std::vector<PointKey> points(std::size_t(kWidth) * kHeight), banded(points.size());
  const std::vector<RowBand> rows = find_block_rows(view, cache, 0);
  std::vector<std::uint32_t> seen(rows.size() + 1), banded_seen(rows.size() + 1);
  project_points(view, cache, rows, {0, kHeight}, points, seen);
  for (const RowBand band : {RowBand{0, 7}, RowBand{7, 30}, RowBand{30, kHeight}}) {
    project_points(view, cache, rows, band, banded, banded_seen);
  }
  std::vector<double> nearest(points.size(), INFINITY);
  int near_border = 0;
  for (std::size_t b = 0; b < cache.blocks().size(); ++b) {
    const PointBlock& block = cache.blocks()[b];
    for (std::size_t i = b * kPointBlock; i < b * kPointBlock + block.count; ++i) {
      const Vec3d p(cache.x()[i], cache.y()[i], cache.z()[i]);
      const Vec3d q = view.pixel_from_world * (block.is_far ? p : p - view.eye);
      if (q.z <= 0) continue;
      const double x = q.x / q.z, y = q.y / q.z;
      if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
      // Float and double may disagree about the pixel there.
      const double slack = 1e-3;
      if (std::abs(x - std::round(x)) < slack || std::abs(y - std::round(y)) < slack) {
        ++near_border;
        continue;
      }
      double& depth = nearest[std::size_t(y) * kWidth + std::size_t(x)];
      depth = std::min(depth, block.is_far ? 1e30 : q.z);
    }
  }
  int compared = 0, found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_FALSE(points[i] < banded[i] || banded[i] < points[i]);
    found += points[i].is_none() ? 0 : 1;
    if (!points[i].is_none()) --seen[points[i].point() / kPointBlock];
    if (!banded[i].is_none()) --banded_seen[banded[i].point() / kPointBlock];
    if (std::isinf(nearest[i])) continue;
    ASSERT_FALSE(points[i].is_none());
    if (nearest[i] > 1e20) continue;
    ASSERT_LE(points[i].depth(), nearest[i] * (1 + 1e-5));
    compared += std::abs(points[i].depth() / nearest[i] - 1) < 1e-5 ? 1 : 0;
  }
  EXPECT_GT(compared, 300);
  EXPECT_GE(compared + near_border + 200, found);
  // Those of each block were counted.
  for (std::size_t b = 0; b < rows.size(); ++b) EXPECT_TRUE(seen[b] == 0 && banded_seen[b] == 0);
}

// Depths of points by pixel; 0: none. No edges.
EdgePointImage image_of_depths(const std::vector<float>& depths,
                               const std::vector<ScreenEdge>& edges = {}) {
  EdgePointImage image(kWidth, kHeight);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (depths[i] <= 0) continue;
    image.points[i] = PointKey(std::bit_cast<std::uint32_t>(depths[i]), std::uint32_t(i), 5);
  }
  DepthCells depth(kWidth, kHeight);
  const std::vector<PointKey> none(image.points.size());
  for (int i = 0; i < depth.cell_rows(); ++i) depth.fill_cells(none, i);
  for (int i = 0; i < depth.limit_rows(); ++i) depth.fill_limits(i, 0.01F);
  clear_crossings({0, kHeight}, kHeight, image.crossings);
  rasterize_edges(edges, depth, {0, kHeight}, kWidth, kHeight, image.crossings);
  classify_pixels({0, kHeight}, image);
  find_reach(image.corners, {0, kHeight}, image.reach);
  return image;
}

// objects: by pixel; none: all of one.
std::vector<std::uint32_t> hidden_in(const EdgePointImage& image, float pixel_size,
                                     std::vector<std::uint32_t> objects = {}) {
  objects.resize(image.points.size());
  std::vector<ShadedPoint> points(objects.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].object = objects[i];
  PointCache cache(points.size());
  cache.add(points, 0);
  DepthCells cells(kWidth, kHeight);
  for (int i = 0; i < cells.cell_rows(); ++i) cells.fill_cells(image.points, i);
  for (int i = 0; i < cells.limit_rows(); ++i) cells.fill_limits(i, pixel_size);
  std::vector<std::uint32_t> hidden;
  for (const RowBand band : {RowBand{0, 20}, RowBand{20, kHeight}}) {
    const auto part = find_hidden_points(image, cache.objects(), cells, band, pixel_size);
    hidden.insert(hidden.end(), part.begin(), part.end());
  }
  return hidden;
}

TEST(HiddenPoints, points_of_one_plane_hide_none_of_each_other) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int run = 0; run < 30; ++run) {
    std::vector<float> depths(std::size_t(kWidth) * kHeight);
    std::vector<std::uint32_t> cells(depths.size());
    // Inverse depth is linear in the picture; the last runs are seen at a grazing angle.
    const float slope = run < 20 ? 0.02F * unit(random) : 0.019F;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (unit(random) > 0.4F) continue;
        const float within = unit(random);
        const std::size_t at = std::size_t(y) * kWidth + std::size_t(x);
        depths[at] = 1 / (0.05F + slope * (float(y) + within));
        cells[at] = 4 * std::uint32_t(4 * within) + std::uint32_t(x % 4);
      }
    }
    EdgePointImage image = image_of_depths(depths);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      if (depths[i] <= 0) continue;
      image.points[i] =
          PointKey(std::bit_cast<std::uint32_t>(depths[i]), std::uint32_t(i), cells[i]);
    }
    EXPECT_TRUE(hidden_in(image, 0.003F).empty()) << run << " " << slope;
  }
}

TEST(HiddenPoints, what_shows_through_a_wall_is_found_but_not_beyond_an_edge) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> depths(std::size_t(kWidth) * kHeight);
  int through = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float u = unit(random);
      float& depth = depths[std::size_t(y) * kWidth + std::size_t(x)];
      // On the left a wall at 2 with some points at 5 between; on the right the room behind it.
      depth = x < 45 ? (u < 0.4F ? 2.0F : u < 0.46F ? 5.0F : 0.0F) : u < 0.4F ? 5.0F : 0.0F;
      through += x < 45 && depth == 5 ? 1 : 0;
    }
  }
  const ScreenEdge edge{45.5F, -1, 1, 45.5F, kHeight + 1, 1};
  const EdgePointImage image = image_of_depths(depths, {edge});
  const std::vector<std::uint32_t> hidden = hidden_in(image, 0.003F);
  int right = 0;
  for (const std::uint32_t at : hidden) {
    ASSERT_EQ(depths[at], 5);
    right += at % kWidth > 45 ? 1 : 0;
  }
  EXPECT_EQ(right, 0);
  EXPECT_GT(double(hidden.size()), 0.9 * through);
}

// What has come out from under an outline in a new view lies in a strip beside it, where it is half of all there is.
TEST(HiddenPoints, points_of_another_object_are_hidden_by_a_single_nearer_one) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> depths(std::size_t(kWidth) * kHeight);
  std::vector<std::uint32_t> objects(depths.size());
  int through = 0, found = 0;
  for (int run = 0; run < 20; ++run) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t at = std::size_t(y) * kWidth + std::size_t(x);
        const bool is_far = x < 30;
        depths[at] = unit(random) > 0.2F ? 0.0F : is_far ? 5.0F : 4.0F;
        objects[at] = is_far ? 1 : 0;
        through += x == 29 && depths[at] > 0 ? 1 : 0;
      }
    }
    const ScreenEdge edge{27.5F, -1, 1, 27.5F, kHeight + 1, 1};
    const EdgePointImage image = image_of_depths(depths, {edge});
    for (const std::uint32_t at : hidden_in(image, 0.003F, objects)) {
      const int x = int(at % kWidth);
      EXPECT_TRUE(x == 28 || x == 29) << x;
      found += x == 29 ? 1 : 0;
    }
  }
  // A nearer sample is within reach unless none of ten pixels has one: 1 − 0.8¹⁰ = 0.89.
  EXPECT_GT(found, 0.8 * through);
}

std::vector<ScreenEdge> random_edges(std::mt19937& random, int count) {
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<ScreenEdge> edges;
  for (int i = 0; i < count; ++i) {
    ScreenEdge e;
    e.x0 = unit(random) * kWidth;
    e.y0 = unit(random) * kHeight;
    e.x1 = e.x0 + 30 * unit(random) - 15;
    e.y1 = e.y0 + 30 * unit(random) - 15;
    e.inverse_depth0 = e.inverse_depth1 = 1;
    edges.push_back(e);
  }
  return edges;
}

// One fresh sample among stale ones, in a picture without edges: it alone counts where it is within reach.
TEST(Interpolate, takes_stale_samples_only_where_no_fresh_one_is) {
  EdgePointImage image = image_of_depths(std::vector<float>(std::size_t(kWidth) * kHeight, 1), {});
  image.some_are_stale = true;
  constexpr int kX = 30, kY = 20;
  image.fresh.row(kY)[0] = std::uint64_t{1} << unsigned(kX);
  ColorRows colors(8, kWidth);
  for (int y = 0; y < 8; ++y) std::fill_n(colors.row(y).r, kWidth, 1.0F);
  colors.row(kY).r[kX] = 0.25F;
  ColorRows out(1, kWidth);
  std::vector<float> weight(kWidth + 64);
  std::vector<std::uint64_t> lacking(kWidth / 64 + 1 + kVectorWords);
  for (int y = kY - 3; y <= kY + 3; ++y) {
    interpolate_row(image, y, colors, {out.row(0), weight.data(), lacking.data()});
    for (int x = kX - 4; x <= kX + 4; ++x) {
      const bool reached = std::abs(x - kX) <= 2 && std::abs(y - kY) <= 2;
      EXPECT_NEAR(out.row(0).r[x], reached ? 0.25F : 1.0F, 1e-6F) << x << ", " << y;
      EXPECT_EQ(lacking[0] >> unsigned(x) & 1U, reached ? 0U : 1U);
    }
  }
}

TEST(Interpolate, takes_the_weighted_mean_of_what_is_reached) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> depths(std::size_t(kWidth) * kHeight);
  for (float& depth : depths) depth = unit(random) < 0.3F ? 1.0F : 0.0F;
  const EdgePointImage image = image_of_depths(depths, random_edges(random, 40));
  ColorRows colors(kHeight + 8, kWidth);
  std::vector<Rgb> values(depths.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i].x = unit(random);
    values[i].y = unit(random);
    values[i].z = unit(random);
    const ColorRow row = colors.row(int(i / kWidth));
    row.r[i % kWidth] = values[i].x;
    row.g[i % kWidth] = values[i].y;
    row.b[i % kWidth] = values[i].z;
  }
  ColorRows out(1, kWidth);
  std::vector<float> weight(kWidth + 64);
  int apart = 0;
  for (int y = 0; y < kHeight; ++y) {
    interpolate_row(image, y, colors, {out.row(0), weight.data(), nullptr});
    for (int x = 0; x < kWidth; ++x) {
      const bool complex = image.codes[image.offset(x, y)].is_complex();
      Rgb sum;
      float total = 0;
      const auto add = [&](int dx, int dy, bool reached) {
        const int px = x + dx, py = y + dy;
        if (px < 0 || py < 0 || px >= kWidth || py >= kHeight) return;
        if (!(complex ? image.occupied : image.samples).at(px, py)) return;
        apart += reached || complex ? 0 : 1;
        if (!reached && !complex) return;
        sum += values[image.offset(px, py)] * kernel_weight(dx, dy);
        total += kernel_weight(dx, dy);
      };
      add(0, 0, true);
      for (std::size_t k = 0; k < kReachOffsets; ++k) {
        const auto [dx, dy] = kReachOffset[k];
        add(dx, dy, image.reach.at(k, x, y));
        const bool inside = x - dx >= 0 && x - dx < kWidth && y - dy >= 0;
        add(-dx, -dy, inside && image.reach.at(k, x - dx, y - dy));
      }
      ASSERT_NEAR(weight[std::size_t(x)], total, 1e-5);
      if (!(total > 0)) continue;
      ASSERT_NEAR(out.row(0).r[x], sum.x / total, 1e-5) << x << " " << y;
      ASSERT_NEAR(out.row(0).b[x], sum.z / total, 1e-5) << x << " " << y;
    }
  }
  EXPECT_GT(apart, 1000);
}

// Two colours on the two sides of a wire thinner than a pixel: the pixel is a mixture of the sides and never of
// anything beyond them; where all is of one colour, so is it.
TEST(ComplexPixel, mixes_the_colours_around_it) {
  std::vector<float> depths(std::size_t(kWidth) * kHeight, 1.0F);
  const ScreenEdge left{40.3F, -1, 1, 40.35F, kHeight + 1, 1},
      right{40.6F, -1, 1, 40.65F, kHeight + 1, 1};
  const EdgePointImage image = image_of_depths(depths, {left, right});
  ColorRows colors(kHeight, kWidth);
  for (int y = 0; y < kHeight; ++y) {
    const ColorRow row = colors.row(y);
    for (int x = 0; x < kWidth; ++x) {
      row.r[x] = x <= 40 ? 1 : 0;
      row.g[x] = x <= 40 ? 0 : 1;
      row.b[x] = 0.25F;
    }
  }
  // What stands in for the wire.
  for (int y = 0; y < kHeight; ++y) colors.row(y).r[40] = colors.row(y).g[40] = 0.5F;
  // What is interpolated around it: the sides' own colours, or nothing.
  const std::vector<float> known(kWidth, 1.0F), unknown(kWidth, 0.0F);
  for (int y = 5; y < 40; ++y) {
    ASSERT_TRUE(image.codes[image.offset(40, y)].is_complex());
    const std::vector<float>& weights = y % 2 == 0 ? known : unknown;
    const PrimaryNeighborhood around{{colors.row(y - 1), weights.data()},
                                     {colors.row(y), weights.data()},
                                     {colors.row(y + 1), weights.data()}};
    ComplexPixels pixels(image);
    std::vector<float> out(3 * std::size_t(kWidth));
    pixels.reconstruct_row(y, {colors, around}, out.data());
    const Rgb c{out[120], out[121], out[122]};
    EXPECT_NEAR(c.x + c.y, 1, 1e-5);
    EXPECT_NEAR(c.z, 0.25F, 1e-6);
    // 0.3 of the left, 0.4 of the right, and the wire between, of which nothing is known.
    EXPECT_GT(c.x, 0.25F);
    EXPECT_GT(c.y, 0.35F);
  }
}

// The same wire without any point near it: what is interpolated of the pixels beside it is known all the same.
TEST(ComplexPixel, takes_what_its_neighbours_are_known_to_be) {
  const std::vector<float> depths(std::size_t(kWidth) * kHeight, 0.0F);
  const ScreenEdge left{40.2F, -1, 1, 40.2F, kHeight + 1, 1},
      right{40.7F, -1, 1, 40.7F, kHeight + 1, 1};
  const EdgePointImage image = image_of_depths(depths, {left, right});
  ColorRows colors(3, kWidth);
  const std::vector<float> known(kWidth, 1.0F);
  for (int y = 0; y < 3; ++y) {
    const ColorRow row = colors.row(y);
    for (int x = 0; x < kWidth; ++x) row.r[x] = x < 40 ? 1 : 0.5F;
  }
  // What stands in.
  colors.row(0).r[40] = 0;
  colors.row(0).b[40] = 1;
  ASSERT_TRUE(image.codes[image.offset(40, 11)].is_complex());
  const PrimaryRows rows{colors.row(0), known.data()};
  std::vector<float> out(3 * std::size_t(kWidth));
  ComplexPixels(image).reconstruct_row(11, {colors, {rows, rows, rows}}, out.data());
  const Rgb c{out[120], out[121], out[122]};
  // 0.2 of the left, 0.3 of the right; of the wire between nothing is known.
  EXPECT_NEAR(c.x, 0.2F + 0.3F * 0.5F, 0.07F);
  EXPECT_NEAR(c.z, 0.5F, 0.07F);
}

// A line across the picture, points far from it on the left alone: holes on the left take its colours and no others.
TEST(HoleFiller, colours_cross_no_edge) {
  std::vector<float> depths(std::size_t(kWidth) * kHeight, 1.0F);
  const ScreenEdge edge{40.5F, -1, 1, 40.5F, kHeight + 1, 1};
  const EdgePointImage image = image_of_depths(depths, {edge});
  Image picture(kWidth, kHeight, 3);
  std::vector<std::uint32_t> holes;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      picture.at(x, y, x <= 40 ? 0 : 1) = 1;
      if (x < 30 || x > 52) continue;
      holes.push_back(std::uint32_t(image.offset(x, y)));
      picture.at(x, y, 2) = 7;  // what no hole keeps
    }
  }
  HoleFiller(kWidth, kHeight).fill(image, holes, {}, picture);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 30; x <= 52; ++x) {
      EXPECT_EQ(picture.at(x, y, 2), 0);
      if (x == 40) {  // the edge's own pixels show both sides
        EXPECT_NEAR(picture.at(x, y, 0), 0.5F, 0.1F) << y;
        EXPECT_NEAR(picture.at(x, y, 1), 0.5F, 0.1F) << y;
        continue;
      }
      EXPECT_FLOAT_EQ(picture.at(x, y, 0), x < 40 ? 1 : 0) << x;
      EXPECT_FLOAT_EQ(picture.at(x, y, 1), x < 40 ? 0 : 1) << x;
    }
  }
}

// Red, a green gap of about a pixel, blue: where nothing of the gap is known it goes on as it is known to be elsewhere.
TEST(HoleFiller, narrow_gaps_between_two_edges_stay_whole) {
  constexpr int kKnown = 6;  // rows
  const std::vector<float> depths(std::size_t(kWidth) * kHeight, 0.0F);
  const ScreenEdge left{40.2F, -1, 1, 40.2F, kHeight + 1, 1},
      right{41.3F, -1, 1, 41.3F, kHeight + 1, 1};
  const EdgePointImage image = image_of_depths(depths, {left, right});
  Image picture(kWidth, kHeight, 3);
  std::vector<std::uint32_t> holes;
  const auto set = [&](int x, int y, Rgb color) {
    for (int c = 0; c < 3; ++c) picture.at(x, y, c) = c == 0 ? color.x : c == 1 ? color.y : color.z;
  };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) set(x, y, x <= 40 ? Rgb{1, 0, 0} : Rgb{0, 0, 1});
    if (y < kKnown) {
      set(40, y, {0.2F, 0.8F, 0});
      set(41, y, {0, 0.3F, 0.7F});
    } else {
      holes.push_back(std::uint32_t(image.offset(40, y)));
    }
  }
  HoleFiller(kWidth, kHeight).fill(image, holes, {}, picture);
  for (int y = kKnown; y < kKnown + 12; ++y) {
    EXPECT_NEAR(picture.at(40, y, 0), 0.2F, 1e-3F) << y;
    EXPECT_NEAR(picture.at(40, y, 1), 0.8F, 1e-3F) << y;
    EXPECT_NEAR(picture.at(41, y, 1), 0.25F, 0.05F) << y;
    EXPECT_NEAR(picture.at(41, y, 2), 0.7F, 0.05F) << y;
  }
}

TEST(SamplePlan, asks_in_proportion_to_squares_and_about_as_often_as_told) {
  std::vector<std::uint8_t> wanted(200UL * 100UL);
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i % 200 < 100 ? 20 : 40;
  std::size_t left = 0, all = 0;
  for (std::uint32_t frame = 0; frame < 64; ++frame) {
    const auto plan = plan_samples(wanted, {200, 100, 500, frame});
    EXPECT_NEAR(double(plan.size()), 500, 120);
    EXPECT_EQ(plan, plan_samples(wanted, {200, 100, 500, frame, 1}));
    all += plan.size();
    for (const std::uint32_t at : plan) left += at % 200 < 100 ? 1 : 0;
  }
  EXPECT_NEAR(double(all), 64 * 500, 0.03 * 64 * 500);
  EXPECT_NEAR(double(left) / double(all), 0.2, 0.01);
}

}  // namespace
}  // namespace arris
