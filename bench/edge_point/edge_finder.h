// edge_finder.h — what finding edges costs: building trees, silhouettes, shadow events, shadow edges
// What       one row a mesh: tori with waves and grain, as irregular as scans, of 250,000 and 871,000 triangles. Each
//            time is the best of several.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace arris::bench {

struct EdgeFinderRow {
  std::string name;
  std::size_t triangles = 0, edges = 0;
  double edge_mesh_ms = 0, edge_tree_ms = 0, face_tree_ms = 0;
  std::size_t silhouettes = 0;
  double silhouettes_ms = 0, brute_force_ms = 0;
  // Of a point light on the mesh itself: events and edges together, as when the light has moved.
  std::size_t shadow_events = 0, shadow_edges = 0;
  double shadow_ms = 0;
  // The same of an area light.
  std::size_t area_events = 0, area_edges = 0;
  double area_ms = 0;
};

std::vector<EdgeFinderRow> measure_edge_finder();

}  // namespace arris::bench
