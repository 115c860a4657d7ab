// growing_ball.h — whether a ball that touches a solid's surface from inside can grow to the radius
// What       A ball that touches the surface in several places grows fastest away from the middle of these: that is how
//            the distance to the surface rises. Where it comes to the radius, the place is beside an edge or corner and
//            rounding takes it away. Where it gets stuck, or touches opposite faces, or three all around it between
//            which it grows as slowly, it is between the sides of a thin wall or rod, or at the rim of one.
// In / Out   coordinates relative to the solid's centre
// Source     A. Lieutier, "Any open bounded subset of R^n has the same homotopy type as its medial axis" (2004): the
//            generalized gradient of the distance, and its flow
// Cost       a search of the surface for each step, some ten of them but where widths are near to two radii
#pragma once

#include <cstdint>
#include <vector>

#include "rounding/solid_surface.h"

namespace arris {

// Cosine of how much faces, or directions to them, turn at least that are opposite: by 143 degrees. A ball between them
// grows by less than a third of its centre's way.
constexpr double kOpposite = -0.8;
// Of three directions that are all around: two are this far apart at least.
constexpr double kApart = -0.2;

// Whether a ball that touches in these directions, or faces of these normals, all around it grows as slowly.
bool are_around(Vec3d a, Vec3d b, Vec3d c);
// Whether three of them are.
bool are_around(const std::vector<Vec3d>& directions);

// From a place of a face, with the face's normal.
bool gets_stuck(const SolidSurface& surface, Vec3d x, Vec3d normal, std::uint32_t face,
                double radius);
// From a place of a convex edge, with the direction inward between its faces.
bool gets_stuck_at_edge(const SolidSurface& surface, Vec3d x, Vec3d inward, double radius);

}  // namespace arris
