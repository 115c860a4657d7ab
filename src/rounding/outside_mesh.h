// outside_mesh.h — a mesh turned inside out, so that what rounds convex edges rounds concave ones
// What       closing(P) is the complement of opening(complement of P): the same shells with their triangles' order,
//            planes and kinds of edges turned around bound the space outside P
// In / Out   triangles, vertices, shells and regions keep their numbers; planes are about the same centres
// Source     the definition of rounding by balls that fit outside; docs/rounding.md
#pragma once

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

OutsideMesh turn_inside_out(const WeldedMesh& welded, const FlatRegions& regions,
                            std::span<const EdgeKind> kinds);

}  // namespace arris
