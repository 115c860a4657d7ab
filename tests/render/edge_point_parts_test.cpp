// Parts of the edge-and-point engine by themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

#include "render/point_shader.h"
#include "render/stale_points.h"
#include "render/still_film.h"

namespace arris::test {
namespace {

TEST(StillFilm, what_is_interpolated_loses_its_weight_with_the_square_of_the_paths) {
  constexpr float kInterpolated = 16;
  for (const std::uint32_t paths : {64U, 256U, 1024U}) {
    StillFilm film(1);
    film.add(0, Rgb(0), paths);
    Image picture(1, 1, 3);
    picture.values = {1, 1, 1};
    film.blend_into(picture, kInterpolated, 1);
    const float ratio = kInterpolated / float(paths);
    EXPECT_LT(picture.values[0], 1.05F * ratio * ratio);
    EXPECT_GT(picture.values[0], 0.7F * ratio * ratio);
  }
}

TEST(StillFilm, pixels_that_are_behind_are_wanted_first) {
  StillFilm film(3);
  film.add(0, Rgb(1), 32);
  film.add(1, Rgb(1), 16);
  EXPECT_EQ(film.least_paths(), 0U);
  std::vector<std::uint8_t> wanted(3);
  film.fill_wanted(wanted, 1);
  EXPECT_LT(wanted[0], wanted[1]);
  EXPECT_LT(wanted[1], wanted[2]);
  film.clear();
  EXPECT_EQ(film.paths_of(0), 0U);
}

// Points are stale if the way to the light comes near the blocker: by sampling the way.
TEST(StalePoints, are_those_behind_what_has_moved) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-4, 4);
  const Sphere blocker{{0.3, -0.2, 1}, 0.8};
  const std::vector<ShadowLight> lights[] = {{HomogeneousPoint{{2, 1, 5}, 1}},
                                             {HomogeneousPoint{{0.2, -0.4, 1}, 0}}};
  for (const std::vector<ShadowLight>& light : lights) {
    std::vector<ShadedPoint> points;
    for (int i = 0; i < 2000; ++i) {
      ShadedPoint p;
      p.position.x = float(unit(random));
      p.position.y = float(unit(random));
      p.position.z = float(unit(random));
      p.object = 0;
      points.push_back(p);
    }
    PointCache cache(4000);
    cache.add(points, 9);
    make_shadowed_stale(light, {&blocker, 1}, cache);
    const auto& at = std::get<HomogeneousPoint>(light[0]);
    int stale = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d p(points[i].position), way = at.w > 0 ? at.xyz - p : at.xyz * 20.0;
      double nearest = INFINITY;
      for (int s = 0; s <= 4000; ++s) {
        nearest = std::min(nearest, length(p + way * (s / 4000.0) - blocker.center));
      }
      const bool is_stale = cache.looks()[i].stale > 0;
      stale += is_stale ? 1 : 0;
      if (std::abs(nearest - blocker.radius) < 0.02) continue;
      ASSERT_EQ(is_stale, nearest < blocker.radius) << i << " " << nearest;
    }
    EXPECT_GT(stale, 50);
  }
}

// Changes of light add up, and leave what has moved more urgent.
TEST(StalePoints, grow_staler_with_every_change_of_light) {
  ShadedPoint point;
  point.object = 0;
  PointCache cache(100);
  cache.add({&point, 1}, 1);
  const auto stale = [&] { return int(cache.looks()[0].stale); };
  cache.make_stale(stale_by_light(0.02));
  const int once = stale();
  cache.make_stale(stale_by_light(0.02));
  EXPECT_GT(once, 0);
  EXPECT_EQ(stale(), 2 * once);
  for (int i = 0; i < 1000; ++i) cache.make_stale(stale_by_light(1));
  const int most = stale();
  cache.make_stale(kMovedStale);
  EXPECT_GT(stale(), most);
  const int moved = stale();
  cache.make_stale(stale_by_light(1));
  EXPECT_EQ(stale(), moved);
}

// A ball in the middle of a view along z: pixels within its outline want more, others what they wanted.
TEST(StalePoints, are_looked_for_where_objects_have_moved) {
  constexpr int kSize = 64;
  const Mat3d world_from_pixel{{1.0 / kSize, 0, 0}, {0, 1.0 / kSize, 0}, {-0.5, -0.5, 1}};
  const PixelView view{{0, 0, -10}, inverse(world_from_pixel), kSize, kSize};
  std::vector<std::uint8_t> wanted(std::size_t(kSize * kSize), 10);
  const Sphere ball{{0, 0, 0}, 2};  // 12.8 pixels around the middle
  want_moved(view, {&ball, 1}, wanted);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double from_middle = std::hypot(x + 0.5 - kSize / 2.0, y + 0.5 - kSize / 2.0);
      const int wish = wanted[std::size_t(y * kSize + x)];
      if (from_middle < 11.5) {
        EXPECT_GT(wish, 10) << x << " " << y;
      }
      if (from_middle > 14.5) {
        EXPECT_EQ(wish, 10) << x << " " << y;
      }
    }
  }
  // From within, or behind the eye, nothing is known of the outline.
  const std::vector<std::uint8_t> before = wanted;
  const Sphere behind{{0, 0, -20}, 2}, around{{0, 0, -10}, 2};
  want_moved(view, {&behind, 1}, wanted);
  want_moved(view, {&around, 1}, wanted);
  EXPECT_EQ(wanted, before);
}

TEST(PointShader, a_path_far_brighter_than_the_others_counts_for_less) {
  std::vector<PathSample> paths(16);
  for (PathSample& path : paths) path.radiance = Rgb(0.5F);
  paths[3].radiance = {200, 100, 0};
  paths[3].painted = {100, 0, 0};
  limit_outliers(paths, 1);
  // Twice white is less than eight times the others' mean.
  EXPECT_NEAR(paths[3].radiance.x, 8, 1e-4);
  EXPECT_NEAR(paths[3].radiance.y, 4, 1e-4);
  EXPECT_NEAR(paths[3].painted.x, 4, 1e-4);
  EXPECT_EQ(paths[2].radiance, Rgb(0.5F));
  for (PathSample& path : paths) path.radiance = Rgb(0);
  paths[5].radiance = Rgb(3);
  paths[6].radiance = Rgb(1.9F);
  limit_outliers(paths, 1);
  EXPECT_NEAR(paths[5].radiance.x, 2, 1e-6);
  EXPECT_EQ(paths[6].radiance, Rgb(1.9F));
  paths.resize(3);
  paths[0].radiance = Rgb(1000);
  limit_outliers(paths, 1);
  EXPECT_EQ(paths[0].radiance, Rgb(1000));
}

}  // namespace
}  // namespace arris::test
