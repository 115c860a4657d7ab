// The certificate against rays: every ray sees a surface that its pixel lists, as often as the bounds say.
#include "beam/beam_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
      truth[key_of(see(scene, x, y).seen)] += 1.0 / (grid * grid);
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

TEST(beam_tracer, random_scenes_lie_inside_the_bounds) {
  CsgRandom random(1);
  Report sum;
  for (int i = 0; i < 200; ++i) {
    BeamScene scene;
    const int solids = 1 + int(random() % 2);
    for (int k = 0; k < solids; ++k) {
      scene.add(random_convex_tree(random, 1 + int(random() % 3)),
                k == 0 ? Affine3d{} : random_placement(random, 1));
    }
    const Vec3d from = i % 5 == 0 ? random_vector(random, 1.2) : random_unit(random) * 6.0;
    scene.eye = look_at(from, random_vector(random, 0.5), 40, scene.width, scene.height);
    const Report report = check_scene(scene, 16);
    EXPECT_EQ(report.missed, 0) << i;
    EXPECT_EQ(report.outside, 0) << i;
    sum.pixels += report.pixels;
    sum.uncertified += report.uncertified;
    sum.stats.add(report.stats);
  }
  std::printf("pixels %d uncertified %d regions %llu rays %llu\n", sum.pixels, sum.uncertified,
              (unsigned long long)sum.stats.regions, (unsigned long long)sum.stats.rays);
}

}  // namespace
}  // namespace arris::test
