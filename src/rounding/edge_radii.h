// edge_radii.h — which edges have a radius of their own
// What       MeshView::edge_radii, and RoundingOptions::rules, which go before
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"

namespace arris {

struct EdgeRadii {
  // Per half-edge, of those to be rounded, else the options'; empty if all have the options' radius.
  std::vector<double> radii;
  std::vector<std::uint64_t> matches;  // of each rule
};
EdgeRadii find_edge_radii(const MeshView& mesh, const WeldedMesh& welded,
                          const FlatRegions& regions, std::span<const EdgeKind> kinds,
                          const RoundingOptions& options);

}  // namespace arris
