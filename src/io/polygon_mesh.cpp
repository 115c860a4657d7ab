#include "io/polygon_mesh.h"

#include <algorithm>

namespace arris {

std::string PolygonMesh::add(std::span<const std::int64_t> corners) {
  if (corners.size() < 3) {
    return "a face has " + std::to_string(corners.size()) + " corners; at least 3 are needed";
  }
  const std::size_t count = mesh.positions.size();
  positions_.clear();
  for (const std::int64_t corner : corners) {
    if (std::string problem = problem_with_vertex(corner, count); !problem.empty()) return problem;
    positions_.push_back(mesh.positions[std::size_t(corner)]);
  }
  const std::span<const Triangle> triangles = triangulator_.triangulate(positions_);
  if (triangles.empty()) {
    return "the faces up to this one of " + std::to_string(corners.size()) +
           " corners are too intricate to cut into triangles; triangulate them on export";
  }
  for (const Triangle& t : triangles) {
    mesh.triangles.push_back(
        {std::uint32_t(corners[t[0]]), std::uint32_t(corners[t[1]]), std::uint32_t(corners[t[2]])});
  }
  return "";
}

std::string problem_with_vertex(std::int64_t number, std::size_t count) {
  if (number >= 0 && std::size_t(number) < count) return "";
  return "vertex " + std::to_string(number) + " is out of range: the file has " +
         std::to_string(count) + ", numbered from 0";
}

void normalize_normals(Mesh& mesh, Scene& scene) {
  for (Vec3f& normal : mesh.normals) {
    const Vec3d unit = normalize(Vec3d(normal));
    if (!is_finite(unit)) {
      mesh.normals.clear();
      scene.notes.push_back("object \"" + mesh.name +
                            "\": a vertex normal has no direction; it is shaded flat");
      return;
    }
    normal = Vec3f(unit);
  }
}

}  // namespace arris
