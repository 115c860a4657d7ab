// Parts of the edge-and-point engine by themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

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
    make_shadowed_old(light, {&blocker, 1}, 10, cache);
    const auto& at = std::get<HomogeneousPoint>(light[0]);
    int stale = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d p(points[i].position), way = at.w > 0 ? at.xyz - p : at.xyz * 20.0;
      double nearest = INFINITY;
      for (int s = 0; s <= 4000; ++s) {
        nearest = std::min(nearest, length(p + way * (s / 4000.0) - blocker.center));
      }
      const bool is_stale = std::uint16_t(10 - cache.looks()[i].born) == kStaleAge;
      stale += is_stale ? 1 : 0;
      if (std::abs(nearest - blocker.radius) < 0.02) continue;
      ASSERT_EQ(is_stale, nearest < blocker.radius) << i << " " << nearest;
    }
    EXPECT_GT(stale, 50);
  }
}

}  // namespace
}  // namespace arris::test
