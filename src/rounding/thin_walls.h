// thin_walls.h — walls and rods with less than two radii of material between their sides: they stay
// What       Where a ball that touches the surface can't grow to the radius (growing_ball.h), the material stays. What
//            tells at once of most places that it can: no sides of walls or rods are near.
//            Of the space outside, from which fillets are made, the same is true of air: gaps stay.
// In / Out   coordinates relative to the solid's centre
// Cost       find_thin_walls: linear in the pairs of triangles within 2 r of each other, where they turn by more than
//            100 degrees in the triples, on all cores;
//            is_between_walls: a search of their sides
#pragma once

#include <cstdint>
#include <span>

#include "edges/flat_regions.h"
#include "rounding/solid_surface.h"

namespace arris {

struct ThinWallInput {
  const SolidSurface& surface;
  // Faces that meet in such edges; sorted, each pair in both orders.
  std::span<const FacePair> smooth, sharp;
  const FlatRegions& regions;
  double radius;
};

// Some more triangles than get balls stuck: sides are about opposite to each other, or three of them all around, those
// of blades and needles among them.
ThinWalls find_thin_walls(const ThinWallInput& input);

// Whether both sides of a wall, or those all around a rod, reach into a ball. Balls that get stuck elsewhere are of no
// account: faces of which nothing is left stay in another way (SolidSurface::is_firm).
bool is_between_walls(const SolidSurface& surface, Vec3d center, double radius);

}  // namespace arris
