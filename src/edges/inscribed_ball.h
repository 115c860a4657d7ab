// inscribed_ball.h — the largest ball within a convex solid
// What       maximises ρ under n_k·x + ρ ≤ d_k (the Chebyshev centre) by the dual simplex method: four planes are
//            tight at a time, the most violated one comes in
// In / Out   planes outward and unit; centre in their coordinates
// Limits     planes that don't enclose a bounded, non-empty solid: radius is not meaningful (at most 4·size)
// Cost       linear in the planes for each of typically some ten steps
#pragma once

#include <span>

#include "edges/flat_regions.h"

namespace arris {

struct InscribedBall {
  Vec3d center;
  double radius = 0;
};

// size: of the solid's bounding box, whose centre is the origin.
InscribedBall largest_inscribed_ball(std::span<const Plane> planes, double size);

}  // namespace arris
