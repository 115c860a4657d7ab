// Certain shadows against shadow rays.
#include "beam/beam_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

bool is_blocked(const BeamScene& scene, Vec3d from, Vec3d to) {
  BoundarySearch search;
  for (const BeamSolid& s : scene.placed) {
    const Vec3d a = transform_point(s.object_from_world, from);
    const Vec3d b = transform_point(s.object_from_world, to);
    for (const CsgBoundary& boundary :
         search.find(s.shape->csg(), view_of(s.shape->csg().root()), {a, b - a})) {
      if (boundary.t > 1e-9 && boundary.t < 1 - 1e-9) return true;
    }
  }
  return false;
}

// A floor, and what stands on it.
BeamScene shadow_scene(CsgRandom& random, int count) {
  BeamScene scene;
  scene.width = scene.height = 4;
  scene.add(one_leaf(CsgBox{{-6, -6, -1}, {6, 6, 0}}));
  CsgTree things;
  for (int i = 0; i < count; ++i) {
    CsgLeaf leaf{random_convex(random), random_placement(random, 1), {}};
    if (i % 2 == 0) leaf.primitive = CsgCone{-1, 1, 0.02, 0.02};
    things = flat_tree(CsgOperation::intersect,
                       {{CsgBox{Vec3d(-2), Vec3d(2)}, {}, {}}, std::move(leaf)});
    scene.add(things, {{}, {uniform(random, -1, 1), uniform(random, -1, 1), 2.5}});
  }
  scene.eye = look_at(Vec3d(uniform(random, -3, 3), -7, 6), {0, 0, 0}, 40, 4, 4);
  return scene;
}

constexpr int kGrid = 24;

// Of the floor, in parts of the pixel, by rays.
double lit_share(const BeamScene& scene, const LightPlace& light, int x_px, int y_px) {
  double lit = 0;
  for (int k = 0; k < kGrid * kGrid; ++k) {
    const double x = x_px + (k % kGrid + 0.5) / kGrid, y = y_px + (k / kGrid + 0.5) / kGrid;
    const std::optional<RaySight> hit = see(scene, x, y);
    if (!hit || hit->seen.solid != 0) continue;
    const Ray ray = ray_through(scene.eye, {x, y});
    const Vec3d p = ray.origin + ray.direction * hit->depth;
    const Vec3d to = light.is_directional ? p - light.direction * 20.0 : light.position;
    if (!is_blocked(scene, p, to)) lit += 1.0 / (kGrid * kGrid);
  }
  return lit;
}

// Too many lights to be looked at jointly.
TEST(beam_shadow, shares_of_many_lights_hold_what_rays_find) {
  CsgRandom random(9);
  double open = 0, partly = 0;
  for (int i = 0; i < 8; ++i) {
    const BeamScene scene = shadow_scene(random, 1 + i % 3);
    std::vector<LightPlace> lights(6);
    for (LightPlace& light : lights) {
      light.position = {uniform(random, -3, 3), uniform(random, -3, 3), 9};
    }
    const BeamTracer tracer(scene.placed, scene.eye, 4, 4, {}, lights);
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        for (std::size_t l = 0; l < lights.size(); ++l) {
          LitShare sum;
          for (const PixelSurface& s : pixel.surfaces) {
            if (!s.seen || s.seen->solid != 0 || s.lit_shares.empty()) continue;
            sum.lo += s.lit_shares[l].lo;
            sum.hi += s.lit_shares[l].hi;
            sum.open += s.lit_shares[l].open;
          }
          const double lit = lit_share(scene, lights[l], pixel.x, pixel.y);
          EXPECT_GE(lit, sum.lo - 3.0 / kGrid) << i;
          EXPECT_LE(lit, sum.hi + sum.open + 3.0 / kGrid) << i;
          open += sum.open;
          partly += sum.lo > 0.01 && sum.lo < 0.99 ? 1 : 0;
        }
      });
    }
  }
  EXPECT_LT(open, 8);  // of 768 pixels and lights
  EXPECT_GT(partly, 60);
}

// By surface of a pixel, light by light.
using Shares = std::map<std::pair<int, SeenKey>, std::vector<LitShare>>;
BeamStats trace_shares(const BeamScene& scene, std::span<const LightPlace> lights, int tile_px,
                       Shares& shares) {
  const BeamTracer tracer(scene.placed, scene.eye, scene.width, scene.height, {.tile_px = tile_px},
                          lights);
  BeamStats stats;
  for (const BeamTile& tile : tracer.make_tiles()) {
    stats.add(tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
      for (const PixelSurface& s : pixel.surfaces) {
        if (s.hi > 0) shares[{pixel.y * scene.width + pixel.x, key_of(s.seen)}] = s.lit_shares;
      }
    }));
  }
  return stats;
}

TEST(beam_shadow, pixels_that_share_looks_from_many_lights_know_as_much_as_alone) {
  CsgRandom random(11);
  for (int i = 0; i < 6; ++i) {
    BeamScene scene = shadow_scene(random, 1 + i % 3);
    scene.width = scene.height = 32;
    scene.eye = look_at(Vec3d(uniform(random, -3, 3), -7, 6), {0, 0, 0}, 40, 32, 32);
    std::vector<LightPlace> lights(6);
    for (LightPlace& light : lights) {
      light.position = {uniform(random, -3, 3), uniform(random, -3, 3), 9};
    }
    Shares together, alone;
    const BeamStats shared = trace_shares(scene, lights, 16, together);
    const BeamStats single = trace_shares(scene, lights, 1, alone);
    EXPECT_LT(shared.regions, single.regions / 2);
    const double tolerance = BeamOptions{}.tolerance;
    for (const auto& [key, of_lights] : alone) {
      const std::vector<LitShare>& others = together[key];
      if (of_lights.empty() && others.empty()) continue;
      ASSERT_EQ(others.size(), of_lights.size());
      for (std::size_t l = 0; l < lights.size(); ++l) {
        const LitShare &a = of_lights[l], &b = others[l];
        EXPECT_LE(b.lo, a.hi + a.doubtful + 1e-9);
        EXPECT_GE(b.hi + b.doubtful, a.lo - 1e-9);
        EXPECT_LE(b.hi - b.lo + b.doubtful, std::max(tolerance, a.hi - a.lo + a.doubtful));
        EXPECT_NEAR(b.estimate, a.estimate, tolerance + a.doubtful);
        EXPECT_NEAR(b.open, a.open, tolerance + a.doubtful);
      }
    }
  }
}

TEST(beam_shadow, shares_of_lit_surface_hold_what_rays_find) {
  CsgRandom random(3);
  int known = 0, partly = 0;
  for (int i = 0; i < 24; ++i) {
    const BeamScene scene = shadow_scene(random, 1 + i % 3);
    LightPlace light;
    light.is_directional = i % 2 == 0;
    light.direction = {uniform(random, -0.6, 0.6), uniform(random, -0.6, 0.6), -1};
    light.position = {uniform(random, -3, 3), uniform(random, -3, 3), 9};
    const BeamTracer tracer(scene.placed, scene.eye, 4, 4, {}, {&light, 1});
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        double low = 0, high = 0, open = 0;  // of the floor's lit part
        for (const PixelSurface& s : pixel.surfaces) {
          if (!s.seen || s.seen->solid != 0) continue;
          if (s.lit_known == 0) open += s.hi;
          if (s.lit_known == 0 || s.lit == 0) continue;
          low += s.lo;
          high += s.hi;
        }
        const double lit = lit_share(scene, light, pixel.x, pixel.y);
        const double slack = 3.0 / kGrid;
        EXPECT_GE(lit, low - slack) << i;
        EXPECT_LE(lit, high + open + slack) << i;
        known += open == 0 ? 1 : 0;
        partly += low > 0.01 && low < 0.99 ? 1 : 0;
      });
    }
  }
  EXPECT_GT(known, 250);
  EXPECT_GT(partly, 60);
}

// So many bars that those in a light's way are found by place.
TEST(beam_shadow, none_of_many_bars_is_lost) {
  BeamScene scene;
  scene.width = scene.height = 8;
  scene.add(one_leaf(CsgBox{{-6, -6, -1}, {6, 6, 0}}));
  std::vector<CsgLeaf> bars;
  for (int i = 0; i < 60; ++i) {
    const double x = -3 + 0.1 * i;
    bars.push_back({CsgBox{{x, -4, 1}, {x + 0.05, 4, 1.1}}, {}, {}});
  }
  scene.add(flat_tree(CsgOperation::unite, bars));
  scene.eye = look_at({0, -9, 0.7}, {0, 0, 0}, 16, 8, 8);  // under the bars
  for (const bool is_directional : {true, false}) {
    LightPlace light;
    light.is_directional = is_directional;
    light.direction = {0.02, 0.01, -1};
    light.position = {0.4, 0.3, 40};
    const BeamTracer tracer(scene.placed, scene.eye, 8, 8, {}, {&light, 1});
    double in_shadow = 0;
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        double low = 0, high = 0;
        for (const PixelSurface& s : pixel.surfaces) {
          if (!s.seen || s.seen->solid != 0) continue;
          if (s.lit_known == 0) {
            EXPECT_TRUE(s.hi < 1.0 / 512 || !pixel.certified);
            continue;
          }
          if (s.lit == 0) in_shadow += s.lo;
          low += s.lit != 0 ? s.lo : 0;
          high += s.lit != 0 ? s.hi : 0;
        }
        const double lit = lit_share(scene, light, pixel.x, pixel.y);
        EXPECT_NEAR(lit, (low + high) / 2, 3.0 / kGrid);
      });
    }
    EXPECT_GT(in_shadow, 3);
  }
}

// A shadow of a hundredth of a pixel that no grid of samples meets.
TEST(beam_shadow, shadows_thinner_than_any_grid_are_found) {
  BeamScene scene;
  scene.width = scene.height = 2;
  scene.add(one_leaf(CsgBox{{-6, -6, -1}, {6, 6, 0}}));
  const double radius = 0.01;
  scene.add(
      one_leaf(CsgCone{-4, 4, radius, radius}, {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, {0, 0.3, 3}}));
  scene.eye = look_at({0, -8, 0.5}, {0, 0, 0}, 20, 2, 2);  // the wire is above the picture
  LightPlace light;
  light.is_directional = true;
  light.direction = {0, 0.01, -1};
  const BeamTracer tracer(scene.placed, scene.eye, 2, 2, {}, {&light, 1});
  double shadow_low = 0, shadow_high = 0;
  for (const BeamTile& tile : tracer.make_tiles()) {
    tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
      EXPECT_TRUE(pixel.certified);
      for (const PixelSurface& s : pixel.surfaces) {
        if (s.seen && s.seen->solid == 0 && s.lit_known != 0 && s.lit == 0) {
          shadow_low += s.lo;
          shadow_high += s.hi;
        }
      }
    });
  }
  EXPECT_GT(shadow_low, 0);
  EXPECT_LT(shadow_high - shadow_low, 1.0 / 256);
}

}  // namespace
}  // namespace arris::test
