#include "beam/beam_mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
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

const Optics kMirror{Optics::Kind::reflects, 1};

Optics mirror_faces(const SeenSurface& seen) {
  const bool is_mirror =
      (seen.solid == 0 && seen.face == kTop) || (seen.solid == 1 && seen.face == kFront);
  return is_mirror ? kMirror : Optics{};
}

// How many mirrors the ray meets, and glass that it passes, and what it sees in the end.
using MirroredKey = std::pair<std::size_t, SeenKey>;
MirroredKey follow(const BeamScene& scene, const OpticsOf& optics_of, Ray ray) {
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    roots.push_back({i, scene.placed[i].shape->root()});
  }
  for (std::size_t mirrors = 0;; ++mirrors) {
    const std::optional<RaySight> sight = see(scene.placed, roots, ray);
    if (!sight) return {mirrors, key_of(std::nullopt)};
    const SeenSurface& seen = sight->seen;
    const Optics optics = optics_of(seen);
    if (mirrors == kMostMirrors || optics.kind == Optics::Kind::scatters) {
      return {mirrors, key_of(seen)};
    }
    const BeamSolid& solid = scene.placed[seen.solid];
    const Ray own{transform_point(solid.object_from_world, ray.origin),
                  transform_vector(solid.object_from_world, ray.direction)};
    const CsgBoundary boundary{sight->depth, seen.leaf, seen.face, seen.entering};
    Vec3d n = normalize(transpose(solid.object_from_world.linear) *
                        solid.shape->csg().outward_normal(boundary, own));
    const Vec3d d = normalize(ray.direction);
    if (dot(n, d) > 0) n = -n;
    ray.origin = ray.origin + ray.direction * sight->depth;
    ray.direction = d - n * (2 * dot(n, d));
    const double eta = optics.relative_ior, cosine = -dot(n, d);
    const double passing = 1 - eta * eta * (1 - cosine * cosine);
    if (optics.kind == Optics::Kind::refracts && passing > 0) {
      ray.direction = d * eta + n * (eta * cosine - std::sqrt(passing));
    }
    ray.origin = ray.origin + ray.direction * 1e-7;
  }
}

struct MirrorCounts {
  double mirrored = 0, open = 0, area = 0;  // in pixels
};

// Holds what the tracer says of each pixel against a grid of rays.
void check_shares(const BeamScene& scene, const OpticsOf& optics_of, MirrorCounts& counts,
                  const std::string& name) {
  BeamOptions options;
  options.optics = optics_of;
  const BeamTracer tracer(scene.placed, scene.eye, scene.width, scene.height, options);
  for (const BeamTile& tile : tracer.make_tiles()) {
    tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
      constexpr int kGrid = 20;
      std::map<MirroredKey, double> truth;
      for (int k = 0; k < kGrid * kGrid; ++k) {
        const Vec2d at{pixel.x + (k % kGrid + 0.5) / kGrid, pixel.y + (k / kGrid + 0.5) / kGrid};
        truth[follow(scene, optics_of, ray_through(scene.eye, at))] += 1.0 / (kGrid * kGrid);
      }
      std::map<MirroredKey, std::pair<double, double>> bounds;
      double unknown = 0;
      for (const PixelSurface& s : pixel.surfaces) {
        if (s.mirror_open) unknown += s.hi;
        auto& [lo, hi] = bounds[{s.mirrors.size(), key_of(s.seen)}];
        lo += s.lo;
        hi += s.hi;
        if (!s.mirrors.empty()) counts.mirrored += s.lo;
      }
      const double slack = 3.0 / kGrid + unknown;
      for (const auto& [key, share] : truth) {
        const auto at = bounds.find(key);
        ASSERT_TRUE(at != bounds.end() || share <= slack) << name;
        if (at == bounds.end()) continue;
        EXPECT_GE(share, at->second.first - slack) << name;
        EXPECT_LE(share, at->second.second + slack) << name;
      }
      for (const auto& [key, bound] : bounds) {
        if (truth.contains(key)) continue;
        EXPECT_LE(bound.first, slack) << name;
      }
      counts.open += std::min(unknown, 1.0);
      counts.area += 1;
    });
  }
}

TEST(beam_mirror, shares_of_what_mirrors_show_hold_what_rays_find) {
  CsgRandom random(31);
  MirrorCounts counts;
  for (int i = 0; i < 12; ++i) {
    check_shares(mirror_scene(random, 1 + i % 3), mirror_faces, counts, std::to_string(i));
  }
  EXPECT_GT(counts.mirrored, counts.area / 3);  // the scene shows what it is to
  EXPECT_LT(counts.open, counts.area / 20);
}

// Balls, rods, funnels and dents that reflect everything, on a floor among other things.
BeamScene curved_mirror_scene(CsgRandom& random, int kind) {
  BeamScene scene;
  scene.width = scene.height = 8;
  const Affine3d turned = random_placement(random, 0);
  if (kind == 0) {
    scene.add(one_leaf(CsgSphere{1.2}), turned);
  } else if (kind == 1) {
    scene.add(one_leaf(random_convex(random)), turned);
  } else {
    // A dent in a block: a concave mirror, in which it may see itself.
    scene.add(flat_tree(CsgOperation::subtract,
                        {{CsgBox{{-2, -1.5, -2}, {2, 2, 2}}, {}, {}},
                         {CsgSphere{1.6}, {{}, {0, -2 - uniform(random, 0, 0.3), 0.3}}, {}}}));
  }
  scene.add(one_leaf(CsgBox{{-8, -8, -3}, {8, 8, -2.2}}));
  for (int i = 0; i < 4; ++i) {
    // One draw after the other, so that all compilers make the same scene.
    const CsgPrimitive small = random_convex(random);
    scene.add(one_leaf(small),
              {{{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}},
               {uniform(random, -2.5, 2.5), uniform(random, -4, -2), uniform(random, -2, 2.5)}});
  }
  scene.eye = look_at({uniform(random, -1, 1), -6, 1}, {0, 0, 0}, 22, 8, 8);
  return scene;
}

TEST(beam_mirror, shares_of_what_curved_mirrors_show_hold_what_rays_find) {
  CsgRandom random(32);
  for (const int kind : {0, 1, 2}) {
    MirrorCounts counts;
    for (int i = 0; i < 8; ++i) {
      check_shares(
          curved_mirror_scene(random, kind),
          [](const SeenSurface& seen) { return seen.solid == 0 ? kMirror : Optics{}; }, counts,
          std::to_string(kind) + "/" + std::to_string(i));
    }
    EXPECT_GT(counts.mirrored, counts.area / 5);
    EXPECT_LT(counts.open, counts.area / 200);
  }
}

// The same solids of glass: through them, and where they reflect totally.
TEST(beam_mirror, shares_of_what_glass_shows_hold_what_rays_find) {
  CsgRandom random(33);
  for (const int kind : {0, 1, 2}) {
    MirrorCounts counts;
    for (int i = 0; i < 8; ++i) {
      const double ior = uniform(random, 1.2, 1.8);
      check_shares(
          curved_mirror_scene(random, kind),
          [&](const SeenSurface& seen) {
            return seen.solid == 0 ? Optics{Optics::Kind::refracts, seen.entering ? 1 / ior : ior}
                                   : Optics{};
          },
          counts, std::to_string(kind) + "/" + std::to_string(i));
    }
    EXPECT_GT(counts.mirrored, counts.area / 5);
    // A ball of four pixels' radius squeezes the whole scene into its rim: more looks than a pixel has.
    EXPECT_LT(counts.open, counts.area / 10);
  }
}

}  // namespace
}  // namespace arris::test
