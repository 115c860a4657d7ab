// crease_grooves.h — the lines along which rounded edges meet in a hollow
// What       Where a crease bends more sharply than the radius, towards where its balls are surface, balls of one part
//            of it reach into those of another: the surface folds, and has a sharp groove. So it is at the ends of
//            many concave edges. On the pipe about such a crease, and on those beside, a grid over its length and the
//            angle across it tells where other balls cover the surface; the border of what is covered is the groove.
// In / Out   coordinates relative to the solid's centre; `shape` without grooves
// Guarantee  ends of segments lie on the surface (tests/render/rounded_outline_test.cpp)
// Limits     grooves between pipes away from such folds are not looked for: they come where walls are thinner than
//            2 r. What is covered by less than a cell of the grid, 5° by a twelfth of what lies across, may be missed.
// Cost       some hundred distance queries for each crease that folds
#pragma once

#include <vector>

#include "rounding/creased_solid.h"

namespace arris {

std::vector<CreaseGroove> find_grooves(const CreasedSolid& solid, const CreaseShape& shape);

}  // namespace arris
