// concave_features.h — concave edges and corners of a solid, as balls within it touch them
// In / Out   coordinates relative to the solid's centre
// Legend     x centre of a ball that touches the feature; r radius
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/box_tree.h"
#include "rounding/crease_cutter.h"

namespace arris {

// Between two faces, with the directions in them that lead away from it.
struct ConcaveEdge {
  Vec3d p0, p1, direction;
  Vec3d normal0, normal1;
  Vec3d inward0, inward1;
  std::uint32_t face0, face1, vertex0, vertex1;
  bool is_smooth;

  // Whether a ball around x touches the edge before anything beside it.
  [[nodiscard]] bool is_touched_from(Vec3d x, double tolerance) const;
  // Outside which planes it does not; their normals lead outward.
  [[nodiscard]] std::array<CurveBound, 4> bounds() const;
  // What holds all x between these.
  [[nodiscard]] std::array<Vec3d, 6> hull(double r) const;
  [[nodiscard]] Box box(double r) const;
};

// At which concave edges end.
struct ConcaveCorner {
  Vec3d point;
  std::vector<Vec3d> directions;     // of its edges, outgoing
  std::vector<std::uint32_t> faces;  // around it
  std::vector<std::uint32_t> edges;  // concave ones
  bool is_smooth = true;             // all of these are

  [[nodiscard]] bool is_touched_from(Vec3d x, double tolerance) const;
  [[nodiscard]] std::vector<CurveBound> bounds() const;
};

// Of two edges or corners.
template <class A, class B>
std::vector<CurveBound> bounds_of(const A& a, const B& b) {
  const auto of_a = a.bounds();
  const auto of_b = b.bounds();
  std::vector<CurveBound> bounds(of_a.begin(), of_a.end());
  bounds.insert(bounds.end(), of_b.begin(), of_b.end());
  return bounds;
}

struct ConcaveFeatures {
  std::vector<ConcaveEdge> edges;
  std::vector<ConcaveCorner> corners;
};

struct ConcaveInput {
  const WeldedMesh& mesh;
  const FlatRegions& regions;
  std::span<const EdgeKind> kinds;        // per half-edge
  std::span<const std::uint32_t> shells;  // of one solid
  Vec3d center;                           // of the solid
};

// Smooth edges that bend in are concave ones, too.
ConcaveFeatures find_concave_features(const ConcaveInput& input);

// Visits each half-edge of the solid that is between two faces, with its twin.
template <class Visit>
void for_outlines(const ConcaveInput& in, const Visit& visit) {
  const auto region_of = [&](std::uint32_t h) { return in.regions.region[h / 3]; };
  for (const std::uint32_t s : in.shells) {
    const Shell& shell = in.mesh.shells[s];
    for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
      const std::uint32_t t = in.mesh.triangles_by_shell[shell.first_triangle + i];
      if (in.regions.region[t] == kNone) continue;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t twin = in.mesh.twin[h];
        if (twin <= kLastHalfEdge && region_of(twin) != region_of(h)) visit(h, twin);
      }
    }
  }
}

}  // namespace arris
