// ray_sight.h — what a single ray sees, as beams name it
// What       what stands in where bounds leave something open, and what tests compare with. Leaves that are not convex
//            have one surface, kAnyFace.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "beam/region_look.h"

namespace arris {

struct RaySight {
  SeenSurface seen;
  double depth = 0;  // in lengths of the ray's direction
};

// The first surface along a world ray, beyond the depth `from`.
std::optional<RaySight> see(std::span<const BeamSolid> solids, const std::vector<BeamPart>& parts,
                            const Ray& world, double from = 0);

}  // namespace arris
