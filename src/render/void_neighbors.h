// void_neighbors.h — what else lies in the voids of rounded edges, or at them
// What       A ray that moves from the mesh onto a rounded edge crosses the void between them, and so does one that
//            leaves it. Other solids can be there: those must be looked for. Where none is near, which is known in
//            advance, a ray may cross the void in one step.
// Guarantee  never too few: a void is said to have no neighbour only if a plane separates it from all of the other
//            solid, or of its box; by kVoidMargin of the rounded solid's size, or, where it may be touched, by 0
// Cost       sorts the solids' boxes along one axis; pairs of overlapping boxes are looked at arc by arc
#pragma once

#include "render/scene_rounding.h"

namespace arris {

// With `before`, of the same objects in other places, only voids that a moved solid was or is near are looked at.
void find_void_neighbors(const SceneGeometry& geometry, SceneRounding& rounding, int threads,
                         const SceneRounding* before = nullptr);

}  // namespace arris
