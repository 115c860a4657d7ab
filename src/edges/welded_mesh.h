// welded_mesh.h — triangles joined into shells
// What       vertices at the same place become one, triangles find their neighbours across edges, and
//            connected triangles become shells. Where more than two triangles meet at an edge (pieces
//            that touch), they are paired around the edge so that each pair encloses material. A triangle
//            with other triangles' vertices on an open edge (a T-junction) is split there.
// In / Out   triangle indices stay the caller's, pieces of split triangles follow them; half-edge h = 3 * triangle + k
//            runs from corner k to corner k+1 of `triangles` (which turn_inverted_shells() may turn around)
// Guarantee  twin[twin[h]] == h; tests/edges/welded_mesh_test.cpp
// Limits     a T-junction is healed where its vertex lies on the edge within kJunctionTolerance of the mesh's
//            size; at most kMaxJunctionTests vertices are looked at in all, the rest stay boundaries
// Errors     Error{input}: index out of range, position not finite
// Cost       linear, but for sorting the triangles around a vertex
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"

namespace arris {

inline constexpr std::uint32_t kNone = 0xffffffffU;
// Values of twin[] that are no half-edge.
inline constexpr std::uint32_t kBoundary = kNone;
inline constexpr std::uint32_t kNonManifold = kNone - 1;
inline constexpr std::uint32_t kLastHalfEdge = kNone - 2;

struct Shell {
  Vec3d bounds_min, bounds_max;
  double volume = 0;  // signed, before turning around; about the bounds' centre if open
  bool closed = true;
  bool turned = false;  // the triangles' order was reversed: their normals pointed inwards
  std::uint32_t first_triangle = 0;  // into triangles_by_shell
  std::uint32_t triangle_count = 0;

  [[nodiscard]] Vec3d center() const { return (bounds_min + bounds_max) * 0.5; }
  [[nodiscard]] double size() const { return length(bounds_max - bounds_min); }
};

inline constexpr double kJunctionTolerance = 1e-6;
inline constexpr std::uint64_t kMaxJunctionTests = 50'000'000;

struct WeldedMesh {
  std::vector<Vec3f> vertices;
  std::vector<Triangle> triangles;   // the caller's, then pieces of split ones
  std::vector<std::uint32_t> twin;   // per half-edge
  std::vector<std::uint32_t> shell;  // per triangle; kNone where it has no area
  std::vector<Shell> shells;
  std::vector<std::uint32_t> triangles_by_shell;  // triangle indices, shell after shell
  std::uint64_t degenerate_triangles = 0;         // whose corners lie in one line
  std::uint64_t healed_junctions = 0;             // vertices on open edges of other triangles
  // Those of MeshView, sorted, the smaller vertex first. Pieces of split triangles have none.
  std::optional<std::vector<VertexPair>> sharp_edges;
  std::vector<EdgeRadius> edge_radii;  // the same; where an edge has several, the smallest
  std::vector<std::uint32_t> source;   // per vertex: one of the caller's

  [[nodiscard]] std::uint32_t origin(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
  [[nodiscard]] static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  [[nodiscard]] static std::uint32_t previous(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
  }
  [[nodiscard]] std::uint32_t target(std::uint32_t h) const { return origin(next(h)); }
};

WeldedMesh make_welded_mesh(const MeshView& mesh, const std::string& name);

}  // namespace arris
