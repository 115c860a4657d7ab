// thin_walls.h — walls and rods with less than two radii of material between their sides: they stay
// What       A ball that touches the surface in several places grows fastest away from the middle of these: that is how
//            the distance to the surface rises. Where it comes to the radius, the place is beside an edge or corner and
//            rounding takes it away. Where it gets stuck, or touches opposite faces, or some all around it that keep it
//            from growing as much, it is between the sides of a thin wall or rod, or at the rim of one.
//            Of the space outside, from which fillets are made, the same is true of air: gaps stay.
// In / Out   coordinates relative to the solid's centre
// Source     A. Lieutier, "Any open bounded subset of R^n has the same homotopy type as its medial axis" (2004): the
//            generalized gradient of the distance, and its flow
// Cost       find_thin_walls: linear in the pairs of triangles within 2 r of each other, on all cores; gets_stuck: a
//            search of the surface for each step, some ten of them but where widths are near to two radii
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

// Some more triangles than get balls stuck: sides are about opposite to each other, or some of them all around, those of
// blades and needles among them.
ThinWalls find_thin_walls(const ThinWallInput& input);

// Whether both sides of a wall, or those all around a rod, reach into a ball. Balls that get stuck elsewhere are of no
// account: faces of which nothing is left stay in another way (SolidSurface::is_firm).
bool is_between_walls(const SolidSurface& surface, Vec3d center, double radius);
// From a place of a face, with the face's normal.
bool gets_stuck(const SolidSurface& surface, Vec3d x, Vec3d normal, std::uint32_t face,
                double radius);
// From a place of a convex edge, with the direction inward between its faces.
bool gets_stuck_at_edge(const SolidSurface& surface, Vec3d x, Vec3d inward, double radius);

}  // namespace arris
