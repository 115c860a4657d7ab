// smooth_reach.h — faces that are one curved surface as far as a ball goes
// What       Facets of a curved surface stand for what is between them: a ball that touches one of them may cut into
//            its neighbours where they meet in a smooth convex edge, by as much as facets are off the surface. For each
//            face: those that can be reached from it over smooth edges by way of faces that a ball may cut into.
// Limits     no faces that meet it in a sharp edge elsewhere, and none that have turned by more than kMostTurn
// Cost       linear in the pairs of triangles within 2 r of each other; on all cores
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arris/math.h"
#include "edges/flat_regions.h"
#include "rounding/solid_surface.h"

namespace arris {

struct SmoothReachInput {
  const SolidSurface& surface;
  std::span<const FacePair> smooth,
      sharp;  // faces that meet in such edges; sorted, each pair in both orders
  const FlatRegions& regions;
  double radius;
};

// Sorted: a face, and one that its balls may cut into.
std::vector<FacePair> find_smooth_reach(const SmoothReachInput& input);

}  // namespace arris
