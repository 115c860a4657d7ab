// bench_edge_point: what finding edges costs.
#include <fmt/format.h>

#include <cstdio>

#include "edge_point/edge_finder.h"

int main() {
  for (const arris::bench::EdgeFinderRow& r : arris::bench::measure_edge_finder()) {
    std::fputs(
        fmt::format(
            "{:18} {:7} triangles {:8} edges | mesh {:.0f} ms, edge tree {:.0f} ms, face tree "
            "{:.0f} ms | {} silhouettes {:.2f} ms (all edges {:.1f} ms) | point light: {} events, "
            "{} "
            "edges {:.1f} ms | area light: {} events, {} edges {:.1f} ms\n",
            r.name, r.triangles, r.edges, r.edge_mesh_ms, r.edge_tree_ms, r.face_tree_ms,
            r.silhouettes, r.silhouettes_ms, r.brute_force_ms, r.shadow_events, r.shadow_edges,
            r.shadow_ms, r.area_events, r.area_edges, r.area_ms)
            .c_str(),
        stdout);
  }
  return 0;
}
