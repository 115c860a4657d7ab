// polygon_mesh.h — a mesh of shared vertices that polygons are added to
// What       what the PLY and OFF readers have in common
// Errors     add() says what is wrong; the reader knows the place
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arris/scene.h"
#include "geometry/polygon.h"

namespace arris {

class PolygonMesh {
 public:
  // Vertices first: all positions, and normals of any length, uvs or neither.
  Mesh mesh;

  // Corners are vertex numbers from 0. What is wrong with the polygon; empty if nothing is.
  [[nodiscard]] std::string add(std::span<const std::int64_t> corners);

 private:
  std::vector<Vec3f> positions_;  // of one polygon
  PolygonTriangulator triangulator_;
};

// What is wrong with a vertex's number, from 0, among `count`; empty if nothing is.
std::string problem_with_vertex(std::int64_t number, std::size_t count);

// Makes the normals unit; those of a mesh with a normal of length 0 are left out with a note in the scene.
void normalize_normals(Mesh& mesh, Scene& scene);

}  // namespace arris
