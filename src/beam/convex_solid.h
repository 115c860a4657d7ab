// convex_solid.h — a tree of solids as beams read it: its leaves are planes and at most one quadric
// What       Extrusions become prisms over convex polygons (outline_parts.h), solids of revolution frustums between
//            the heights of their vertices, rounded polyhedra their faces' prisms with the pieces of cylinders and
//            spheres between them. The rest stays as it is.
// Guarantee  the same set of points: pieces have no surface of their own but where they meet each other, in planes
//            that the table makes one (tests/beam/convex_solid_test.cpp)
// Limits     tori, meshes, extrusions scaled unequally and those over outlines that cross stay as they are
#pragma once

#include "arris/csg.h"
#include "csg/csg_solid.h"

namespace arris {

// Errors: as CsgSolid.
CsgSolid make_convex_solid(const CsgTree& tree);

}  // namespace arris
