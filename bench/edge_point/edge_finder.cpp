#include "edge_point/edge_finder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>

#include "arris/scene.h"
#include "edgepoint/shadow_edges.h"

namespace arris::bench {
namespace {

template <class Work>
double best_ms(int times, const Work& work) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < times; ++i) {
    const Clock::time_point start = Clock::now();
    work();
    const std::chrono::duration<double, std::milli> took = Clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

Vec3f rough(Vec3d p, double grain, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double waves = 1 + 0.03 * std::sin(17 * p.x) * std::sin(13 * p.y + 3 * p.z) +
                       0.01 * std::sin(60 * p.x + 20 * p.z);
  return Vec3f(p * waves + Vec3d{unit(random), unit(random), unit(random)} * grain);
}

Mesh rough_torus(std::uint32_t around, std::uint32_t across, double grain) {
  Mesh mesh;
  std::mt19937_64 random(1);
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / across;
      const double r = 1 + 0.45 * std::cos(v);
      mesh.positions.push_back(
          rough({r * std::cos(u), r * std::sin(u), 0.45 * std::sin(v)}, grain, random));
      const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, i * across + j1});
    }
  }
  return mesh;
}

EdgeFinderRow measure(const std::string& name, const Mesh& mesh) {
  EdgeFinderRow row;
  row.name = name;
  const WeldedMesh welded = make_welded_mesh({mesh.positions, mesh.triangles}, name);
  row.edge_mesh_ms = best_ms(3, [&] { make_edge_mesh(welded); });
  const EdgeMesh edges = make_edge_mesh(welded);
  row.triangles = edges.triangles.size();
  row.edges = edges.edges.size();
  row.edge_tree_ms = best_ms(3, [&] { EdgeTree{edges}; });
  row.face_tree_ms = best_ms(3, [&] { FaceTree{edges}; });
  const EdgeTree tree(edges);
  const FaceTree faces(edges);

  const HomogeneousPoint from{{3, 2, 2}, 1};
  row.silhouettes_ms = best_ms(10, [&] { row.silhouettes = tree.find_silhouettes(from).size(); });
  row.brute_force_ms = best_ms(3, [&] {
    row.silhouettes = 0;
    for (std::uint32_t e = 0; e < edges.edges.size(); ++e) {
      row.silhouettes += is_silhouette(edges, e, from) ? 1 : 0;
    }
  });
  const ShadowReceiver self{0, &faces, {}, true};
  row.shadow_ms = best_ms(5, [&] {
    TracedEvents traced(find_shadow_events(tree, from));
    traced.add(std::span(&self, 1), std::span(&self, 1));
    row.shadow_events = traced.events().size();
    row.shadow_edges = traced.edges().size();
  });
  const ParallelogramLight light{{3, 2, 2}, {0.3, -0.3, 0}, {0, 0.2, -0.3}, {-3, -2, -2}};
  row.area_ms = best_ms(3, [&] {
    TracedEvents traced(find_shadow_events(tree, light));
    traced.add(std::span(&self, 1), std::span(&self, 1));
    row.area_events = traced.events().size();
    row.area_edges = traced.edges().size();
  });
  return row;
}

}  // namespace

std::vector<EdgeFinderRow> measure_edge_finder() {
  return {measure("250k, smooth", rough_torus(500, 250, 0)),
          measure("250k, some grain", rough_torus(500, 250, 0.001)),
          measure("250k, rough", rough_torus(500, 250, 0.003)),
          measure("871k", rough_torus(933, 467, 0.0005))};
}

}  // namespace arris::bench
