// mesh_checks.h — areas, volumes and closedness of loaded meshes
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "arris/scene.h"

namespace arris::test {

inline double area_of(const Mesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    area += length(cross(b - a, c - a)) / 2;
  }
  return area;
}

// Positive for a closed mesh whose triangles face outward.
inline double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    volume += dot(a, cross(b, c)) / 6;
  }
  return volume;
}

// Every edge is walked once in each direction; vertices are told apart by their position.
inline bool is_closed(const Mesh& mesh) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> walks;
  const auto point = [&](std::uint32_t i) {
    const Vec3f p = mesh.positions[i];
    return Point{p.x, p.y, p.z};
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = point(t[k]), b = point(t[(k + 1) % 3]);
      if (a < b) ++walks[{a, b}];
      if (b < a) --walks[{b, a}];
    }
  }
  return std::all_of(walks.begin(), walks.end(), [](const auto& walk) { return walk.second == 0; });
}

// Real models, see ../shared/data/README.md; tests skip where they are absent.
inline std::filesystem::path shared_model(const std::string& name) {
  const char* const folder = std::getenv("ARRIS_DATA_DIR");
  return std::filesystem::path(folder != nullptr ? folder : ARRIS_SOURCE_DIR "/../shared/data") /
         name;
}

}  // namespace arris::test
