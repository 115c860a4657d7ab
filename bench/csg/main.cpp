// bench_csg — what rays through CSG solids cost
// What       growth: random solids of 10² to 10⁵ primitives in a cube, differences among them; holes: a plate with 400
//            holes as one difference against 400 tiles with a hole each, and against the plate alone. Times are of
//            closest hits and of occlusion, in rounds in which every scene has its turn; ratios pair times of one
//            round.
// Usage      bench_csg [--rounds N] [--rays N] [--largest N]
//            bench_csg --beam examples/beam [--path 4,16,64] [--corners 0] [--threads N]: see beam_table.cpp
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "beam_table.h"
#include "csg/csg_cells.h"
#include "interleaved.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"

namespace arris::bench {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

struct Settings {
  int rounds = 7;
  int rays = 100'000;
  int largest = 100'000;
};

struct Case {
  std::string name;
  std::shared_ptr<const PreparedScene> prepared;
  std::vector<TraceRay> rays;
  double build_seconds = 0;
  std::size_t cells = 0;
  double hit_share = 0;
  std::vector<double> ns;  // per ray and round
};

CsgTree union_of(std::vector<CsgLeaf> leaves, CsgOperation operation = CsgOperation::unite) {
  CsgTree tree;
  tree.name = "bench";
  tree.nodes.push_back({CsgNode::kInner, operation, {}});
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    tree.nodes[0].children.push_back(i + 1);
    tree.nodes.push_back({i, CsgOperation::unite, {}});
  }
  tree.leaves = std::move(leaves);
  return tree;
}

// Balls, boxes and cylinders at random in a unit cube, of which they fill a like part at any number; every pair has
// its second bitten out of its first.
CsgTree make_heap(int primitives) {
  Random random(1);
  CsgTree tree;
  tree.name = fmt::format("{} primitives", primitives);
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  const double size = 0.35 / std::cbrt(double(primitives));
  for (int i = 0; i < primitives; i += 2) {
    const auto pair = std::uint32_t(tree.nodes.size());
    const auto leaf = std::uint32_t(tree.leaves.size());
    tree.nodes[0].children.push_back(pair);
    tree.nodes.push_back({CsgNode::kInner, CsgOperation::subtract, {pair + 1, pair + 2}});
    tree.nodes.push_back({leaf, CsgOperation::unite, {}});
    tree.nodes.push_back({leaf + 1, CsgOperation::unite, {}});
    const Vec3d at{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
    CsgPrimitive first = CsgSphere{size};
    if (i % 3 == 1) first = CsgBox{Vec3d(-0.8 * size), Vec3d(0.8 * size)};
    if (i % 3 == 2) first = CsgCone{-size, size, 0.7 * size, 0.7 * size};
    tree.leaves.push_back({first, {{}, at}, {}});
    tree.leaves.push_back({CsgSphere{0.7 * size}, {{}, at + Vec3d(0.6 * size)}, {}});
  }
  return tree;
}

constexpr int kSide = 20;

CsgTree make_plate(bool one_difference) {
  std::vector<CsgLeaf> leaves;
  CsgTree tiles;
  tiles.name = "tiles";
  tiles.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  leaves.push_back({CsgBox{{0, 0, 0}, {1, 1, 0.1}}, {}, {}});
  for (int i = 0; i < kSide * kSide; ++i) {
    const double step = 1.0 / kSide;
    const Vec3d low{(i % kSide) * step, (i / kSide) * step, 0};
    const CsgLeaf hole{
        CsgCone{-1, 1, 0.3 * step, 0.3 * step}, {{}, low + Vec3d(step / 2, step / 2, 0)}, {}};
    leaves.push_back(hole);
    const auto node = std::uint32_t(tiles.nodes.size());
    const auto leaf = std::uint32_t(tiles.leaves.size());
    tiles.nodes[0].children.push_back(node);
    tiles.nodes.push_back({CsgNode::kInner, CsgOperation::subtract, {node + 1, node + 2}});
    tiles.nodes.push_back({leaf, CsgOperation::unite, {}});
    tiles.nodes.push_back({leaf + 1, CsgOperation::unite, {}});
    tiles.leaves.push_back({CsgBox{low, low + Vec3d(step, step, 0.1)}, {}, {}});
    tiles.leaves.push_back(hole);
  }
  return one_difference ? union_of(std::move(leaves), CsgOperation::subtract) : tiles;
}

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

int run_all(const Settings& settings) {
  std::vector<Case> growth;
  for (int n = 100; n <= settings.largest; n *= 10) {
    growth.push_back(make_case(fmt::format("heap of {}", n), make_heap(n),
                               make_rays(settings.rays, Vec3d(0), Vec3d(1))));
  }
  run(growth, settings.rounds);
  std::vector<Case> holes;
  const std::vector<TraceRay> rays = make_rays(settings.rays, {0, 0, 0}, {1, 1, 0.1});
  holes.push_back(make_case("400 tiles with a hole each", make_plate(false), rays));
  holes.push_back(make_case("one difference of 400 holes", make_plate(true), rays));
  holes.push_back(
      make_case("plate without holes", union_of({{CsgBox{{0, 0, 0}, {1, 1, 0.1}}, {}, {}}}), rays));
  run(holes, settings.rounds);
  return 0;
}

}  // namespace
}  // namespace arris::bench

namespace {

std::vector<int> parse_counts(const std::string& text) {
  std::vector<int> counts;
  for (std::size_t at = 0; at < text.size();) {
    counts.push_back(std::atoi(text.c_str() + at));
    const std::size_t comma = text.find(',', at);
    at = comma == std::string::npos ? text.size() : comma + 1;
  }
  return counts;
}

}  // namespace

int main(int argc, char** argv) {
  arris::bench::Settings settings;
  arris::bench::BeamTableSettings beam;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    const int value = std::atoi(argv[i + 1]);
    if (option == "--rounds") settings.rounds = value;
    if (option == "--rays") settings.rays = value;
    if (option == "--largest") settings.largest = value;
    if (option == "--beam") beam.folder = argv[i + 1];
    if (option == "--path") beam.path_samples = parse_counts(argv[i + 1]);
    if (option == "--corners") beam.corners = value != 0;
    if (option == "--threads") beam.threads = value;
  }
  return beam.folder.empty() ? arris::bench::run_all(settings) : arris::bench::run_beam_table(beam);
}
