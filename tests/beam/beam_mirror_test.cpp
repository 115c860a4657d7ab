#include "beam/beam_mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

constexpr std::uint32_t kTop = 5, kFront = 2;  // faces of a box: z high, y low

// A floor and a wall behind, both mirrors, and things between.
BeamScene mirror_scene(CsgRandom& random, int count) {
  BeamScene scene;
  scene.width = scene.height = 4;
  scene.add(one_leaf(CsgBox{{-6, -6, -1}, {6, 6, 0}}));
  scene.add(one_leaf(CsgBox{{-6, 3, 0}, {6, 4, 6}}));
  for (int i = 0; i < count; ++i) {
    scene.add(flat_tree(CsgOperation::intersect,
                        {{CsgBox{Vec3d(-2), Vec3d(2)}, {}, {}},
                         {random_convex(random), random_placement(random, 1), {}}}),
              {{{0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}},
               {uniform(random, -1, 1), uniform(random, -1, 1), 0.9}});
  }
  scene.eye = look_at({uniform(random, -2, 2), -6, 4}, {0, 0.5, 0.5}, 30, 4, 4);
  return scene;
}

bool is_mirror_face(const SeenSurface& seen) {
  return (seen.solid == 0 && seen.face == kTop) || (seen.solid == 1 && seen.face == kFront);
}

// How many mirrors the ray meets, and what it sees in the end.
using MirroredKey = std::pair<std::size_t, SeenKey>;
MirroredKey follow(const BeamScene& scene, Ray ray) {
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    roots.push_back({i, scene.placed[i].shape->root()});
  }
  for (std::size_t mirrors = 0;; ++mirrors) {
    const std::optional<RaySight> sight = see(scene.placed, roots, ray);
    if (!sight) return {mirrors, key_of(std::nullopt)};
    if (mirrors == kMostMirrors || !is_mirror_face(sight->seen)) {
      return {mirrors, key_of(sight->seen)};
    }
    const int axis = sight->seen.solid == 0 ? 2 : 1;
    ray.origin = ray.origin + ray.direction * sight->depth;
    ray.direction[axis] = -ray.direction[axis];
    ray.origin = ray.origin + ray.direction * 1e-9;
  }
}

TEST(beam_mirror, shares_of_what_mirrors_show_hold_what_rays_find) {
  CsgRandom random(31);
  double mirrored = 0;
  int open = 0, pixels = 0;
  for (int i = 0; i < 12; ++i) {
    const BeamScene scene = mirror_scene(random, 1 + i % 3);
    BeamOptions options;
    options.is_mirror = is_mirror_face;
    const BeamTracer tracer(scene.placed, scene.eye, 4, 4, options);
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        constexpr int kGrid = 20;
        std::map<MirroredKey, double> truth;
        for (int k = 0; k < kGrid * kGrid; ++k) {
          const Vec2d at{pixel.x + (k % kGrid + 0.5) / kGrid, pixel.y + (k / kGrid + 0.5) / kGrid};
          truth[follow(scene, ray_through(scene.eye, at))] += 1.0 / (kGrid * kGrid);
        }
        std::map<MirroredKey, std::pair<double, double>> bounds;
        double unknown = 0;
        for (const PixelSurface& s : pixel.surfaces) {
          if (s.mirror_open) unknown += s.hi;
          auto& [lo, hi] = bounds[{s.mirrors.size(), key_of(s.seen)}];
          lo += s.lo;
          hi += s.hi;
          if (!s.mirrors.empty()) mirrored += s.lo;
        }
        const double slack = 3.0 / kGrid + unknown;
        for (const auto& [key, share] : truth) {
          const auto at = bounds.find(key);
          ASSERT_TRUE(at != bounds.end() || unknown > 0) << i;
          if (at == bounds.end()) continue;
          EXPECT_GE(share, at->second.first - slack) << i;
          EXPECT_LE(share, at->second.second + slack) << i;
        }
        for (const auto& [key, bound] : bounds) {
          if (truth.contains(key)) continue;
          EXPECT_LE(bound.first, slack) << i;
        }
        open += unknown > 1.0 / 512 ? 1 : 0;
        ++pixels;
      });
    }
  }
  EXPECT_GT(mirrored, pixels / 3);  // the scene shows what it is to
  EXPECT_LT(open, pixels / 10);
}

}  // namespace
}  // namespace arris::test
