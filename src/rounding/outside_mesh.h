// outside_mesh.h — a mesh turned inside out, so that what rounds convex edges rounds concave ones
// What       closing(P) is the complement of opening(complement of P): the same shells with their triangles' order,
//            planes and kinds of edges turned around bound the space outside P
// In / Out   triangles, vertices, shells and regions keep their numbers; planes are about the same centres
// Source     the definition of rounding by balls that fit outside; docs/rounding.md
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"

namespace arris {

struct OutsideMesh {
  WeldedMesh welded;
  FlatRegions regions;
  std::vector<EdgeKind> kinds;  // per half-edge
};

// The half-edge that is the reverse of one of the mesh before, and the other way.
inline std::uint32_t turned_edge(std::uint32_t h) {
  return h / 3 * 3 + (2 - h % 3);
}

OutsideMesh turn_inside_out(const WeldedMesh& welded, const FlatRegions& regions,
                            std::span<const EdgeKind> kinds);

}  // namespace arris
