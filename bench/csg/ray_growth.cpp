#include "ray_growth.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "csg/csg_cells.h"
#include "interleaved.h"
#include "random_solids.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"

namespace arris::bench {
namespace {

struct Case {
  std::string name;
  std::shared_ptr<const PreparedScene> prepared;
  std::vector<TraceRay> rays;
  double build_seconds = 0;
  std::size_t cells = 0;
  double hit_share = 0;
  std::vector<double> ns;  // per ray and round
};

std::vector<TraceRay> make_rays(int count, Vec3d low, Vec3d high) {
  Random random(2);
  std::vector<TraceRay> rays;
  const Vec3d middle = (low + high) * 0.5;
  for (int i = 0; i < count; ++i) {
    const double z = uniform(random, 0.2, 1), angle = uniform(random, 0, 2 * kPi);
    const double r = std::sqrt(1 - z * z);
    const Vec3d origin = middle + Vec3d(r * std::cos(angle), r * std::sin(angle), z) * 3.0;
    const Vec3d target{uniform(random, low.x, high.x), uniform(random, low.y, high.y),
                       uniform(random, low.z, high.z)};
    TraceRay ray;
    ray.origin = Vec3f(origin);
    ray.direction = normalize(Vec3f(target - origin));
    rays.push_back(ray);
  }
  return rays;
}

Case make_case(std::string name, CsgTree tree, std::vector<TraceRay> rays) {
  Scene scene;
  scene.meshes.emplace_back();
  scene.materials.emplace_back();
  scene.csg_trees.push_back(std::move(tree));
  Object object;
  object.name = name;
  object.csg = CsgId{0};
  scene.objects.push_back(object);
  Case made;
  made.name = std::move(name);
  made.rays = std::move(rays);
  made.prepared = prepare_scene(std::move(scene));
  made.build_seconds = prepare_stats(*made.prepared).build_seconds;
  for (const auto& csg : made.prepared->geometry().csg.objects) {
    made.cells += csg->cells->cells().size();
  }
  return made;
}

double time_rays(Case& c) {
  std::size_t hits = 0;
  const auto start = std::chrono::steady_clock::now();
  for (const TraceRay& ray : c.rays) {
    hits += c.prepared->intersect(ray) ? 1U : 0U;
    hits += c.prepared->occluded(ray) ? 1U : 0U;
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  c.hit_share = double(hits) / double(2 * c.rays.size());
  return seconds * 1e9 / double(2 * c.rays.size());
}

void run(std::vector<Case>& cases, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < cases.size(); ++k) {
      Case& c = cases[round % 2 == 0 ? k : cases.size() - 1 - k];
      c.ns.push_back(time_rays(c));
    }
  }
  fmt::print("{:<28} {:>9} {:>9} {:>8} {:>9} {:>8}\n", "scene", "build s", "cells", "hits",
             "ns/ray", "ratio");
  for (const Case& c : cases) {
    fmt::print("{:<28} {:>9.2f} {:>9} {:>7.0f}% {:>9.0f} {:>8.2f}\n", c.name, c.build_seconds,
               c.cells, 100 * c.hit_share, median(c.ns), median_ratio(c.ns, cases[0].ns));
  }
  fmt::print("\n");
}

}  // namespace

void run_ray_growth(const RayGrowthSettings& settings) {
  std::vector<Case> growth;
  for (int n = 100; n <= settings.largest; n *= 10) {
    growth.push_back(make_case(fmt::format("heap of {}", n), make_heap(n),
                               make_rays(settings.rays, Vec3d(0), Vec3d(1))));
  }
  run(growth, settings.rounds);
  std::vector<Case> holes;
  const std::vector<TraceRay> rays = make_rays(settings.rays, {0, 0, 0}, {1, 1, 0.1});
  holes.push_back(make_case("400 tiles with a hole each", make_plate(PlateForm::tiles), rays));
  holes.push_back(
      make_case("one difference of 400 holes", make_plate(PlateForm::one_difference), rays));
  holes.push_back(
      make_case("plate without holes", union_of({{CsgBox{{0, 0, 0}, {1, 1, 0.1}}, {}, {}}}), rays));
  run(holes, settings.rounds);
}

}  // namespace arris::bench
