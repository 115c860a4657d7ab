// The paper's light pyramids against shadows in closed form, and where they are known to fail.
#include "beam/corner_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "beam/light_pyramid.h"
#include "support/beam_truth.h"

namespace arris::test {
namespace {

template <class Sink>
BeamStats trace(const BeamScene& scene, std::span<const LightPlace> lights, const Sink& sink,
                const BeamOptions& options = {}) {
  const CornerTracer tracer(scene.placed, scene.eye, scene.width, scene.height, options, lights);
  BeamStats stats;
  for (const BeamTile& tile : tracer.make_tiles()) stats.add(tracer.trace_tile(tile, sink));
  return stats;
}

const Box3d kBox{{-1, -1, 0}, {1, 1, 2}};

LightPlace sun(Vec3d direction) {
  return {{}, direction, true};
}
LightPlace lamp(Vec3d position) {
  return {position, {}, false};
}

// A box that stands on a floor.
BeamScene box_scene(Vec3d from) {
  BeamScene scene;
  scene.width = scene.height = 32;
  scene.add(one_leaf(CsgBox{{-20, -20, -1}, {20, 20, 0}}));
  scene.add(one_leaf(CsgBox{kBox.low, kBox.high}));
  scene.eye = look_at(from, {0, 0, 0}, 2 * degrees(std::atan(0.5)), 32, 32);
  return scene;
}

Vec3d point_at(const BeamScene& scene, const PixelSurface& s) {
  const Ray ray = ray_through(scene.eye, s.sample);
  return ray.origin + ray.direction * see(scene, s.sample.x, s.sample.y)->depth;
}

// Does the way to the light pass kBox made wider by `margin`?
bool is_in_shadow(const LightPlace& light, Vec3d p, double margin) {
  const Vec3d way = light.is_directional ? -light.direction * 100.0 : light.position - p;
  double from = 0, to = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (kBox.low[axis] - margin - p[axis]) / way[axis];
    const double b = (kBox.high[axis] + margin - p[axis]) / way[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from < to;
}

const std::vector<LightPlace> kLights{sun({1, 1e-9, -1}), lamp({-4, 1e-9, 6})};

// From above the floor's picture is the floor itself, 10 wide; the box hides it up to 1.25 from the middle.
TEST(corner_tracer, shadow_of_a_box_has_its_area) {
  const BeamScene scene = box_scene({0, 0, 10});
  const double pixel_area = (10.0 / 32) * (10.0 / 32);
  double dark[2] = {0, 0}, unknown = 0;
  trace(scene, kLights, [&](const BeamPixel& pixel) {
    for (const PixelSurface& s : pixel.surfaces) {
      if (!s.seen || s.seen->solid != 0) continue;
      if (s.lit_known != 3) unknown += s.estimate * pixel_area;
      for (unsigned i = 0; i < 2; ++i) {
        const bool is_dark = ((s.lit_known & ~s.lit) >> i & 1U) != 0;
        if (is_dark) dark[i] += s.estimate * pixel_area;
      }
    }
  });
  EXPECT_LT(unknown, 0.06);                       // where the box's own outline is
  EXPECT_NEAR(dark[0], (3 - 1.25) * 2, 0.03);     // as far as the box is high, from its far side
  EXPECT_NEAR(dark[1], 2.25 * 3 + 0.5625, 0.03);  // half as large again as the top
}

TEST(corner_tracer, no_light_leaks_under_a_box) {
  for (const Vec3d from : {Vec3d{0, 0, 10}, Vec3d{8, -3, 5}, Vec3d{6, 6, 0.7}}) {
    const BeamScene scene = box_scene(from);
    int known = 0, wrong = 0, dark = 0;
    trace(scene, kLights,
          [&](const BeamPixel& pixel) {
            for (const PixelSurface& s : pixel.surfaces) {
              if (!s.seen || s.seen->solid != 0) continue;
              const Vec3d p = point_at(scene, s);
              for (unsigned i = 0; i < 2; ++i) {
                if ((s.lit_known >> i & 1U) == 0) continue;
                const bool is_lit = (s.lit >> i & 1U) != 0;
                const bool at_edge =
                    is_in_shadow(kLights[i], p, 1e-6) != is_in_shadow(kLights[i], p, -1e-6);
                ++known;
                dark += is_lit ? 0 : 1;
                wrong += !at_edge && is_lit == is_in_shadow(kLights[i], p, 0) ? 1 : 0;
              }
            }
          },
          {.least_region = 1.0 / 16});
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(dark, known / 20);
  }
}

// Away from outlines, that is what the pyramids are for.
TEST(corner_tracer, most_of_a_picture_needs_no_shadow_rays) {
  const BeamScene scene = box_scene({8, -3, 5});
  double unknown = 0;
  const BeamOptions coarse{.least_region = 1.0 / 8};
  const BeamStats stats = trace(
      scene, kLights,
      [&](const BeamPixel& pixel) {
        for (const PixelSurface& s : pixel.surfaces) {
          if (s.seen && s.lit_known != 3) unknown += s.estimate;
        }
      },
      coarse);
  EXPECT_LT(unknown, 0.02 * 32 * 32);
  EXPECT_LT(stats.regions, 32 * 32 * 12);
}

// A plate with a dent that just comes through: the light's rays to the corners pass the dent and the plate alike.
BeamScene dent_scene() {
  BeamScene scene;
  scene.width = scene.height = 4;
  scene.add(one_leaf(CsgBox{{-9, -9, -1}, {9, 9, 0}}));
  scene.add(
      flat_tree(CsgOperation::subtract, {{CsgBox{{-1.5, -1.5, 2.0005}, {1.5, 1.5, 2.5}}, {}, {}},
                                         {CsgSphere{1}, {{}, {0, 0, 3}}, {}}}));
  scene.eye = look_at({4, 0, 1.9}, {0, 0, 0}, 6, 4, 4);
  return scene;
}

TEST(corner_tracer, misses_a_hole_between_the_corners_that_the_certificate_finds) {
  const BeamScene scene = dent_scene();
  const std::vector<LightPlace> light{sun({0, 0, -1})};
  const auto add_lit = [](double& lit) {
    return [&](const BeamPixel& pixel) {
      for (const PixelSurface& s : pixel.surfaces) {
        if (s.seen && s.seen->solid == 0 && s.lit_known == 1 && s.lit == 1) lit += s.lo;
      }
    };
  };
  double by_corners = 0, certified = 0;
  trace(scene, light, add_lit(by_corners));
  const BeamTracer tracer(scene.placed, scene.eye, scene.width, scene.height, {}, light);
  for (const BeamTile& tile : tracer.make_tiles()) tracer.trace_tile(tile, add_lit(certified));
  EXPECT_EQ(by_corners, 0);
  EXPECT_GT(certified, 0.01);
}

// A floor, a bowl, a ball, a cone, and triangles.
BeamScene curved_scene() {
  BeamScene scene;
  scene.width = scene.height = 24;
  scene.add(one_leaf(CsgBox{{-6, -6, -1}, {6, 6, 0}}));
  scene.add(flat_tree(CsgOperation::subtract, {{CsgBox{{-2, -2, 0}, {0, 0, 1}}, {}, {}},
                                               {CsgSphere{0.9}, {{}, {-1, -1, 1.1}}, {}}}));
  scene.add(one_leaf(CsgSphere{0.5}, {{}, {1, -1, 0.7}}));
  scene.add(one_leaf(CsgCone{0, 1.5, 0.5, 0.1}, {{}, {1, 1, 0}}));
  scene.add(one_leaf(CsgCone{-1, 1, 0.3, 0.3}, {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, {-1, 1, 1}}));
  const Vec3d a{-0.5, 0, 1.2}, b{0.5, 0.1, 1.3}, c{0, 1, 2}, d{0.2, -0.8, 1.9};
  const std::vector<MeshTriangle> triangles{{{a, b, c}, 0}, {{b, a, d}, 1}};
  scene.add(triangles);
  return scene;
}

// Nothing between the point and the light, by rays of the scene as a whole.
bool is_lit(const BeamScene& scene, const LightPlace& light, Vec3d p, Vec3d eye) {
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    roots.push_back({i, scene.placed[i].shape->root()});
  }
  const Vec3d from = p + (eye - p) * 1e-7;
  const auto met = see(scene.placed, roots, {from, to_light(light, from)});
  return !met || (!light.is_directional && met->depth > 1);
}

bool is_behind_surface(const BeamScene& scene, const PixelSurface& s, const LightPlace& light,
                       Vec3d p) {
  const HitPatch patch =
      make_patch(scene.placed[s.seen->solid], *s.seen, {p, p, p, p}, scene.eye.position);
  return dot(patch.normals[0], to_light(light, p)) <= 0;
}

TEST(corner_tracer, lights_of_curved_surfaces_are_mostly_those_of_shadow_rays) {
  const std::vector<LightPlace> lights{sun({0.5, 0.3, -1}), lamp({-2, -2.5, 4}),
                                       sun({-1, 0.2, -0.4})};
  for (const Vec3d from : {Vec3d{-3, -7, 6}, Vec3d{5, -2, 3}, Vec3d{-4, 4, 7}}) {
    BeamScene scene = curved_scene();
    scene.eye = look_at(from, {0, 0, 0.3}, 35, 24, 24);
    int known = 0, wrong = 0, dark = 0, all = 0;
    trace(scene, lights,
          [&](const BeamPixel& pixel) {
            for (const PixelSurface& s : pixel.surfaces) {
              if (!s.seen) continue;
              const Vec3d p = point_at(scene, s);
              for (unsigned i = 0; i < lights.size(); ++i) {
                ++all;
                if ((s.lit_known >> i & 1U) == 0) continue;
                const bool lit = (s.lit >> i & 1U) != 0;
                ++known;
                dark += lit ? 0 : 1;
                // Lights behind count as lit.
                const bool truth = is_lit(scene, lights[i], p, scene.eye.position);
                wrong += lit != truth && !lit ? 1 : 0;
                wrong += lit && !truth && !is_behind_surface(scene, s, lights[i], p) ? 1 : 0;
              }
            }
          },
          {.least_region = 1.0 / 4});
    EXPECT_LE(wrong, known / 1000);
    EXPECT_GT(known, all / 2);
    EXPECT_GT(dark, known / 20);
  }
}

TEST(corner_tracer, same_pixels_at_any_number_of_threads) {
  BeamScene scene = curved_scene();
  scene.width = scene.height = 40;
  scene.eye = look_at({-3, -7, 6}, {0, 0, 0.3}, 35, 40, 40);
  const auto values_of = [&](int threads) {
    std::vector<double> values;
    trace(scene, kLights,
          [&](const BeamPixel& pixel) {
            for (const PixelSurface& s : pixel.surfaces) {
              values.insert(values.end(), {s.lo, s.hi, s.estimate, s.sample.x, s.sample.y,
                                           double(s.lit), double(s.lit_known)});
            }
          },
          {.least_region = 1.0 / 8, .threads = threads});
    return values;
  };
  EXPECT_EQ(values_of(1), values_of(2));
}

}  // namespace
}  // namespace arris::test
