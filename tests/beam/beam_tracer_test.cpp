// The certificate against rays: every ray sees a surface that its pixel lists, as often as the bounds say.
#include "beam/beam_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

struct Report {
  int pixels = 0, missed = 0, outside = 0, uncertified = 0, surfaces = 0;
  double worst_open = 0;
  BeamStats stats;
};

// Samples of a regular grid count squares: an outline in a pixel may be off by the squares it crosses.
void check_pixel(const BeamScene& scene, const BeamPixel& pixel, int grid, Report& report) {
  std::map<SeenKey, double> truth;
  for (int j = 0; j < grid; ++j) {
    for (int i = 0; i < grid; ++i) {
      const double x = pixel.x + (i + 0.5) / grid, y = pixel.y + (j + 0.5) / grid;
      truth[key_at(scene, x, y)] += 1.0 / (grid * grid);
    }
  }
  std::map<SeenKey, const PixelSurface*> listed;
  for (const PixelSurface& s : pixel.surfaces) listed[key_of(s.seen)] = &s;
  const double slack = truth.size() > 1 || pixel.surfaces.size() > 1 ? 3.0 / grid : 1e-12;
  for (const auto& [key, share] : truth) {
    const auto at = listed.find(key);
    if (at == listed.end() || !(at->second->hi > 0)) {
      ++report.missed;
      ADD_FAILURE() << "pixel " << pixel.x << ", " << pixel.y << ": solid " << std::get<0>(key)
                    << " leaf " << std::get<1>(key) << " face " << std::get<2>(key) << " share "
                    << share;
      continue;
    }
    if (share < at->second->lo - slack || share > at->second->hi + slack) ++report.outside;
  }
  for (const PixelSurface& s : pixel.surfaces) {
    if (s.lo > slack && !truth.contains(key_of(s.seen))) ++report.outside;
    report.worst_open = std::max(report.worst_open, s.hi - s.lo);
    if (pixel.certified) {
      EXPECT_LE(s.hi - s.lo, BeamOptions{}.tolerance) << pixel.x << ", " << pixel.y;
    }
  }
  ++report.pixels;
  report.surfaces += int(pixel.surfaces.size());
  report.uncertified += pixel.certified ? 0 : 1;
}

Report check_scene(const BeamScene& scene, int grid) {
  Report report;
  const BeamTracer tracer(scene.placed, scene.eye, scene.width, scene.height);
  for (const BeamTile& tile : tracer.make_tiles()) {
    report.stats.add(tracer.trace_tile(
        tile, [&](const BeamPixel& pixel) { check_pixel(scene, pixel, grid, report); }));
  }
  EXPECT_EQ(report.pixels, scene.width * scene.height);
  return report;
}

void expect_sound(const BeamScene& scene, const std::string& name, int grid = 16) {
  const Report report = check_scene(scene, grid);
  EXPECT_EQ(report.missed, 0) << name;
  EXPECT_EQ(report.outside, 0) << name;
}

// The one sentence of the README. Solids interpenetrate, and every fifth eye is among them.
TEST(beam_tracer, no_surface_is_missed_and_samples_lie_inside_the_bounds) {
  CsgRandom random(1);
  for (int i = 0; i < 40; ++i) {
    BeamScene scene;
    scene.width = scene.height = 8;
    const int solids = 1 + int(random() % 2);
    for (int k = 0; k < solids; ++k) {
      scene.add(random_convex_tree(random, 1 + int(random() % 3)),
                k == 0 ? Affine3d{} : random_placement(random, 1));
    }
    const Vec3d from = i % 5 == 0 ? random_vector(random, 1.2) : random_unit(random) * 6.0;
    scene.eye = look_at(from, random_vector(random, 0.5), 40, scene.width, scene.height);
    expect_sound(scene, std::to_string(i), 12);
  }
}

// All that its quadric tells an eye in a cone's apex is zero: no pixel is certified, and a ray stands for each.
TEST(beam_tracer, an_eye_in_the_apex_of_a_cone_sees_what_rays_see) {
  for (const bool is_hole : {false, true}) {
    const CsgCone cone{0, 5, 0, 3};
    BeamScene scene;
    scene.width = scene.height = 48;
    scene.add(is_hole ? flat_tree(CsgOperation::subtract,
                                  {{CsgBox{Vec3d(-6), Vec3d(4)}, {}, {}}, {cone, {}, {}}})
                      : one_leaf(cone));
    scene.eye = look_at({0, 0, 0}, {0.5, 0, 1}, 80, 48, 48);
    expect_sound(scene, is_hole ? "hole" : "cone", 4);
    const BeamTracer tracer(scene.placed, scene.eye, 48, 48);
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        const SeenKey truth = key_at(scene, pixel.x + 0.5, pixel.y + 0.5);
        for (const PixelSurface& s : pixel.surfaces) {
          EXPECT_EQ(s.estimate, key_of(s.seen) == truth ? 1 : 0) << pixel.x << ", " << pixel.y;
        }
        EXPECT_FALSE(pixel.certified);
      });
    }
  }
}

CsgLeaf ball(Vec3d at, double radius) {
  return {CsgSphere{radius}, {{}, at}, {}};
}
CsgLeaf rod(Vec3d at, double radius, double half_height) {
  return {CsgCone{-half_height, half_height, radius, radius}, {{}, at}, {}};
}

// What corner rays don't see, each in a picture of few pixels.
TEST(beam_tracer, what_lies_between_corner_rays_is_seen) {
  const auto scene_of = [](const CsgTree& tree, Vec3d from = {0.2, -0.1, 5}) {
    BeamScene scene;
    scene.width = scene.height = 4;
    scene.add(tree);
    scene.eye = look_at(from, {0, 0, 0}, 30, 4, 4);
    return scene;
  };
  const CsgLeaf slab{CsgBox{{-2, -2, -0.1}, {2, 2, 0.1}}, {}, {}};
  expect_sound(scene_of(flat_tree(CsgOperation::subtract, {slab, rod({0.13, 0.1, 0}, 0.02, 1)})),
               "hole between corners", 64);
  expect_sound(scene_of(flat_tree(CsgOperation::unite, {slab, ball({0.1, 0.1, 0.09}, 0.03)})),
               "ball that pokes through a face", 64);
  expect_sound(
      scene_of(flat_tree(CsgOperation::unite, {ball({0, 0, 0}, 1), ball({0.1, 0, 0.02}, 1)})),
      "interpenetrating balls");
  expect_sound(scene_of(one_leaf(CsgSphere{0.004})), "speck", 128);
  expect_sound(scene_of(one_leaf(CsgCone{-2, 2, 0.003, 0.003},
                                 {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {0.1, 0, 0}})),
               "wire", 128);
  expect_sound(scene_of(one_leaf(CsgSphere{8})), "eye inside a ball");
  expect_sound(
      scene_of(flat_tree(CsgOperation::subtract, {ball({0, 0, 0}, 9), rod({0, 0, 0}, 6, 20)})),
      "eye in a hole");
  expect_sound(scene_of(flat_tree(CsgOperation::subtract, {slab, slab})), "A - A");
  expect_sound(scene_of(flat_tree(CsgOperation::unite,
                                  {slab, {CsgBox{{0, -2, -0.1}, {3, 2, 0.1}}, {}, {}}})),
               "coincident faces");
  expect_sound(scene_of(flat_tree(CsgOperation::unite, {slab, ball({0, 0, 0.6}, 0.5)})),
               "tangent ball");
  expect_sound(scene_of(one_leaf(CsgCone{0, 2, 1, 0}), {0.3, 0.1, 6}), "cone from its tip");
  expect_sound(scene_of(one_leaf(CsgCone{0, 2, 0, 1}), {0.3, 0.1, 6}), "cone from its mouth");
}

// Far more closely than any grid of samples: the area of a ball's picture is known.
TEST(beam_tracer, areas_are_those_of_closed_forms) {
  BeamScene scene;
  scene.width = scene.height = 8;
  const double distance = 5, radius = 0.7;
  scene.add(one_leaf(CsgSphere{radius}));
  scene.eye = look_at({0, 0, distance}, {0, 0, 0}, 30, 8, 8);
  const BeamTracer tracer(scene.placed, scene.eye, 8, 8);
  double low = 0, high = 0;
  for (const BeamTile& tile : tracer.make_tiles()) {
    tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
      EXPECT_TRUE(pixel.certified);
      EXPECT_LE(pixel.coverage_hi - pixel.coverage_lo, 1.0 / 512);
      low += pixel.coverage_lo;
      high += pixel.coverage_hi;
    });
  }
  const double pixel = 2 * std::tan(radians(15)) / 8;
  const double outline = radius / std::sqrt(distance * distance - radius * radius) / pixel;
  EXPECT_LE(low, kPi * outline * outline);
  EXPECT_GE(high, kPi * outline * outline);
  EXPECT_GT(low, 0.99 * high);
}

TEST(beam_tracer, same_pixels_at_any_number_of_threads) {
  CsgRandom random(5);
  BeamScene scene;
  scene.width = scene.height = 40;
  scene.add(random_convex_tree(random, 2));
  scene.eye = look_at({4, 3, 3}, {0, 0, 0}, 40, 40, 40);
  const auto sum = [&](int threads) {
    const BeamTracer tracer(scene.placed, scene.eye, 40, 40, {.threads = threads});
    std::vector<double> values;
    for (const BeamTile& tile : tracer.make_tiles()) {
      tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
        for (const PixelSurface& s : pixel.surfaces) {
          values.insert(values.end(), {s.lo, s.hi, s.estimate, s.sample.x, s.sample.y});
        }
      });
    }
    return values;
  };
  EXPECT_EQ(sum(1), sum(2));
}

// Every kind of primitive, extrusions, tori and meshes among them.
TEST(beam_tracer, bounds_hold_for_every_kind_of_leaf) {
  CsgRandom random(21);
  for (int i = 0; i < 30; ++i) {
    BeamScene scene;
    scene.width = scene.height = 6;
    scene.add(random_tree(random, 1 + int(random() % 2)));
    const Vec3d from = random_unit(random) * uniform(random, 2.5, 6);
    scene.eye = look_at(from, random_vector(random, 0.5), 35, scene.width, scene.height);
    expect_sound(scene, "tree " + std::to_string(i), 12);
  }
}

// Open and closed, as coarse as a pixel and finer, with CSG solids among them.
TEST(beam_tracer, bounds_hold_for_meshes) {
  CsgRandom random(23);
  for (int i = 0; i < 30; ++i) {
    BeamScene scene;
    scene.width = scene.height = 6;
    std::vector<MeshTriangle> triangles;
    const std::uint32_t count = 1 + std::uint32_t(random() % (i % 3 == 0 ? 100 : 6));
    for (std::uint32_t k = 0; k < count; ++k) {
      const Vec3d middle = random_vector(random, 1);
      const double size = count > 6 ? 0.3 : 1.5;
      triangles.push_back(
          {{middle + random_vector(random, size), middle + random_vector(random, size),
            middle + random_vector(random, size)},
           k});
    }
    const CsgMesh closed = random_mesh(random);
    for (const Triangle& t : closed.triangles) {
      triangles.push_back(
          {{closed.vertices[t[0]], closed.vertices[t[1]], closed.vertices[t[2]]}, 0});
    }
    if (i % 2 == 0) scene.add(random_convex_tree(random, 1));
    scene.add(triangles);
    const Vec3d from = random_unit(random) * uniform(random, 0.2, 6);
    scene.eye = look_at(from, random_vector(random, 0.5), 35, scene.width, scene.height);
    expect_sound(scene, "mesh " + std::to_string(i), 12);
  }
}

// A torus before a wall: where no outline is near, it is certain.
TEST(beam_tracer, the_inside_of_a_torus_is_certified) {
  BeamScene scene;
  scene.add(one_leaf(CsgTorus{1, 0.4}));
  scene.eye = look_at({0, -4, 3}, {0, 0, 0}, 45, scene.width, scene.height);
  const Report report = check_scene(scene, 16);
  EXPECT_EQ(report.missed, 0);
  EXPECT_EQ(report.outside, 0);
  EXPECT_GT(report.uncertified, 0);
  EXPECT_LT(report.uncertified,
            100);  // of 256; the torus covers about 100, of which half are at its outlines
}

// Shares of everything that a picture's pixels show of one solid, and of what they may show of it.
struct Shown {
  double estimate = 0, hi = 0, all = 0;
  int pixels = 0;
};
Shown shown_of(const BeamScene& scene, std::uint32_t solid) {
  Shown shown;
  const BeamTracer tracer(scene.placed, scene.eye, scene.width, scene.height);
  for (const BeamTile& tile : tracer.make_tiles()) {
    tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
      double sum = 0, of_solid = 0;
      for (const PixelSurface& s : pixel.surfaces) {
        EXPECT_GE(s.estimate, 0);
        EXPECT_LE(s.estimate, s.hi + 1e-12);
        sum += s.estimate;
        if (!s.seen || s.seen->solid != solid) continue;
        of_solid += s.estimate;
        shown.hi += s.hi;
        if (!(s.estimate > 0)) continue;
        EXPECT_EQ(std::get<0>(key_at(scene, s.sample.x, s.sample.y)), int(solid));
      }
      EXPECT_NEAR(sum, 1, 1e-9) << pixel.x << ", " << pixel.y;
      shown.estimate += of_solid;
      shown.pixels += of_solid > 0 ? 1 : 0;
    });
  }
  return shown;
}

// What is left unknown is smaller than the regions, and lies between their middles.
TEST(beam_tracer, what_stays_unknown_shows_however_small_it_is) {
  const auto scene_of = [](const CsgTree& tree) {
    BeamScene scene;
    scene.width = scene.height = 4;
    scene.add(one_leaf(CsgBox{{-2, -2, -1.2}, {2, 2, -1}}));
    scene.add(tree);
    scene.eye = look_at({0.2, -0.1, 5}, {0, 0, 0}, 30, 4, 4);
    return scene;
  };
  const Shown ring = shown_of(scene_of({one_leaf(CsgTorus{0.003, 0.0003})}), 1);
  EXPECT_GE(ring.pixels, 1);
  EXPECT_LT(ring.estimate, 1e-4);
  // The balls' common part: a lens of a radius of 1/200 pixel.
  const double deep = 0.003 * 0.003 / 2;
  const Shown lens = shown_of(
      scene_of(flat_tree(CsgOperation::intersect,
                         {ball({0.123, 0.077, 1 - deep}, 1), ball({0.123, 0.077, -1 + deep}, 1)})),
      1);
  EXPECT_GE(lens.pixels, 1);
  EXPECT_LT(lens.estimate, 1e-2);
}

}  // namespace
}  // namespace arris::test
