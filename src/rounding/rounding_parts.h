// rounding_parts.h — a rounding with what it was made from
// What       the welded mesh, its flat regions and edges, and each shell's network of arcs and nodes, for those who
//            build geometry from them (bevel_mesh.h)
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/crease_network.h"
#include "rounding/rounding_data.h"

namespace arris {

struct RoundingParts {
  std::unique_ptr<const Rounding::Data> data;
  WeldedMesh welded;
  FlatRegions regions;
  std::vector<EdgeKind> kinds;  // per half-edge; edges left sharp for their length are `smooth`
  std::vector<ShellNetwork> networks;  // per shell; faces are regions, arcs and nodes count from 0
};

// Errors as make_rounding().
RoundingParts make_rounding_parts(const MeshView& mesh, const RoundingOptions& options,
                                  const std::string& name);

}  // namespace arris
