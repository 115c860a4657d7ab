// exact_solids.h — the closed solids of a mesh that are rounded by what balls fit: creased ones, and fillets
// What       Makes CreasedSolids of what isn't convex, with its hollows, or has edges of several radii, and of the
//            space outside solids with concave edges; and tells the solids of Rounding::Data so
// Cost       on all cores
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/bands.h"
#include "rounding/make_creased.h"
#include "rounding/outside_mesh.h"
#include "rounding/rounding_data.h"

namespace arris {

struct ExactInput {
  const MeshView& mesh;
  const RoundingOptions& options;
  const WeldedMesh& welded;
  const FlatRegions& regions;
  std::span<const EdgeKind> kinds;                           // per half-edge
  std::span<const double> radii;                             // find_edge_radii()
  std::span<const std::uint32_t> triangle_begin, triangles;  // the caller's, by region
  const OutsideMesh* outside;  // if concave edges are to be rounded, and there are any
};

struct MadeExact {
  std::vector<TriangleBand> bands;
  std::vector<ClampedPart> clamped;
  std::uint64_t filled_edges = 0;  // pieces of concave ones, of solids with fillets
  // Shells of solids with hollows in whose walls no ball fits: rounded by themselves they might reach into one another.
  std::vector<std::uint32_t> left_sharp;
};

MadeExact make_exact_solids(const ExactInput& input, Rounding::Data& data);

// Visits a half-edge of each edge of a kind that a shell has.
template <class Visit>
void for_edges_of(EdgeKind kind, const WeldedMesh& mesh, std::span<const EdgeKind> kinds,
                  std::uint32_t s, const Visit& visit) {
  const Shell& shell = mesh.shells[s];
  for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
    const std::uint32_t t = mesh.triangles_by_shell[shell.first_triangle + i];
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (kinds[h] == kind && h < mesh.twin[h]) visit(h);
    }
  }
}

}  // namespace arris
