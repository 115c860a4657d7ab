#include "beam/ray_sight.h"

#include <cstdint>

namespace arris {
namespace {

SeenSurface name(std::uint32_t index, const BeamSolid& solid, const CsgBoundary& boundary) {
  SeenSurface seen{index, boundary.leaf, boundary.face, {}, boundary.entering};
  if (solid.is_whole(boundary.leaf)) {
    seen.face = kAnyFace;
    seen.surface = {index, boundary.leaf, BeamSurface::Root::whole};
  }
  return seen;
}

}  // namespace

std::optional<RaySight> see(std::span<const BeamSolid> solids, const std::vector<BeamPart>& parts,
                            const Ray& world) {
  thread_local BoundarySearch search;
  std::optional<RaySight> first;
  const auto offer = [&](const SeenSurface& seen, double depth) {
    if (!first || depth < first->depth) first = RaySight{seen, depth};
  };
  for (const BeamPart& part : parts) {
    const BeamSolid& solid = solids[part.solid];
    if (solid.mesh != nullptr) {
      for (const std::uint32_t facet : part.expression.leaves()) {
        const std::optional<double> t = solid.mesh->meet(facet, world);
        if (t) offer({part.solid, facet, 0, {}, true}, *t);
      }
      continue;
    }
    const Ray ray{transform_point(solid.object_from_world, world.origin),
                  transform_vector(solid.object_from_world, world.direction)};
    for (const CsgBoundary& b : search.find(*solid.solid, view_of(part.expression), ray)) {
      if (b.t <= 0) continue;
      offer(name(part.solid, solid, b), b.t);
      break;
    }
  }
  return first;
}

}  // namespace arris
