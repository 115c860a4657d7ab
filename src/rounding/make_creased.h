// make_creased.h — from shells of a mesh to a CreasedSolid, and the bands that say where its faces are kept
// In / Out   relative to a centre, usually that of the outermost shell; bands are of the caller's triangles
// Cost       on all cores
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
#include "rounding/plain_crease.h"
#include "rounding/varied_creases.h"

namespace arris {

struct CreasedInput {
  const MeshView& mesh;
  const WeldedMesh& welded;
  const FlatRegions& regions;
  std::span<const EdgeKind> kinds;  // per half-edge
  double radius;
  OnOverlap on_overlap = OnOverlap::report;
  std::span<const double> radii{};  // per half-edge; empty: all have the radius
  bool is_outside = false;          // of the space outside (outside_mesh.h)
};

struct MadeCreased {
  CreasedSolid solid;
  std::vector<TriangleBand> bands;
  std::vector<ClampedPart> clamped;
  std::vector<PlainCrease> plain;
};

// shells: the outside of one solid, then its hollows. center: about which planes and places are, where it isn't that of
// the first, as for fillets of a hollow. Nothing: something about them is open, no edge has room, or
// facets of a curved surface are too fine for the radius.
std::optional<MadeCreased> make_creased_solid(const CreasedInput& input,
                                              std::span<const std::uint32_t> shells,
                                              std::optional<Vec3d> center = {});

}  // namespace arris
