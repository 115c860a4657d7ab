// csg_extrude.h — plane shapes swept along z and about it
// What       linear_extrude and rotate_extrude of OpenSCAD. Operations in the plane become the same operations
//            of solids, so that circles sweep cylinders, cones, tori and spheres. Only twisted outlines, and
//            turned ones with facets, are cut into triangles, as OpenSCAD does it.
// Guarantee  what is taken away, or intersected with, reaches beyond the faces that end the first shape: they never
//            coincide
// Errors     ScadUnsupported for outlines that have no triangulation
// Legend     s(z): scale of a section, linear in z from 1 at z_low to `scale` at z_high
#pragma once

#include "io/csg_facets.h"
#include "io/csg_shape.h"

namespace arris {

struct LinearExtrusion {
  double z_low = 0, z_high = 1;
  Vec2d scale{1, 1};
  double twist = 0;  // radians, clockwise from z_low to z_high
  int slices = 1;    // of a twist
};
SolidShape extrude(const FlatShape& shape, const LinearExtrusion& extrusion,
                   const LeafMaker& make_leaf);

struct RotaryExtrusion {
  double start = 0, angle = 2 * kPi;  // radians from the x axis; a negative angle turns clockwise
  // 0: round; else the steps that the angle is cut into.
  int steps = 0;
};
// Of the shape's part at x ≥ 0.
SolidShape revolve(const FlatShape& shape, const RotaryExtrusion& extrusion,
                   const LeafMaker& make_leaf);

}  // namespace arris
