// crowded_arcs.h — rounded edges with other solids in their void
// What       A ray that moves from the mesh onto a rounded edge crosses the void between them. Other solids can reach
//            into it only where their boxes overlap the edge's: only there a second trace looks for them.
// Guarantee  never too few: an arc is free only if a plane of its own (its faces, its ends) separates all of the
//            other solid's box from its void
// Cost       sorts the solids' boxes along x; pairs of overlapping solids are looked at arc by arc
#pragma once

#include "render/scene_rounding.h"

namespace arris {

void find_crowded_arcs(const SceneGeometry& geometry, SceneRounding& rounding);

}  // namespace arris
