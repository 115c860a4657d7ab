// equidistant_curve.h — where a cylinder about an edge meets one about another edge, or a sphere: creases between
//                       concave edges and corners that don't meet
// What       Two cylinders whose axes neither meet nor are parallel, or a cylinder and a sphere beside its axis, cross
//            in a curve of the fourth order. On the part of a cylinder that balls reach, between two directions, the
//            curve is followed by the angle θ about the axis: x(θ) = p + s d + r (cos θ u + sin θ v) is r from the
//            other feature where s solves a quadratic equation, and comes out in arcs of circles.
// In / Out   coordinates of the caller's
// Guarantee  no arc is farther than `tolerance` from the curve, as far as it is looked at; arcs begin where others end
// Limits     curves shorter than a sixteenth of the angle may be missed where they are closed
#pragma once

#include <vector>

#include "rounding/crease_curve.h"

namespace arris {

struct CylinderPart {
  EdgeLine axis;
  double length;   // from the axis' point on; curves may go on a little beyond
  Vec3d from, to;  // directions between which it lies; unit, across the axis
};

// direction: of the other's axis, unit; 0: it is a sphere.
std::vector<CreaseCurve> equidistant_curves(const CylinderPart& part, const EdgeLine& other,
                                            double radius, double tolerance);
// The lines, or the circle, of centres of balls that touch two parallel edges, or two corners.
std::vector<CreaseCurve> parallel_edge_creases(const EdgeLine& a, Vec3d other, double radius,
                                               double extent);
std::vector<CreaseCurve> corner_corner_creases(Vec3d a, Vec3d b, double radius);

}  // namespace arris
