// make_creased.h — from one shell of a mesh to a CreasedSolid, and the bands that say where its faces are kept
// In / Out   bands are of the caller's triangles
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/bands.h"
#include "rounding/creased_solid.h"

namespace arris {

struct CreasedInput {
  const MeshView& mesh;
  const WeldedMesh& welded;
  const FlatRegions& regions;
  std::span<const EdgeKind> kinds;  // per half-edge
  double radius;
  bool with_outlines = true;  // CreasedSolid::shape; else empty
};

// Nothing, and no bands: something about the shell is open or curved, or the radius takes away a whole edge.
std::optional<CreasedSolid> make_creased_solid(const CreasedInput& input, std::uint32_t shell,
                                               std::vector<TriangleBand>& bands);

}  // namespace arris
