// random_solids.h — CSG trees to measure on
#pragma once

#include <random>
#include <vector>

#include "arris/csg.h"

namespace arris::bench {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);

CsgTree union_of(std::vector<CsgLeaf> leaves, CsgOperation operation = CsgOperation::unite);

// Balls, boxes and cylinders at random in a unit cube, of which they fill a like part at any number; every pair has
// its second bitten out of its first. Sizes lie between `least` times the largest and the largest.
CsgTree make_heap(int primitives, double least = 1);

enum class PlateForm { one_difference, tiles };
// A unit square, 0.1 thick, with 20 x 20 round holes: one difference of 400, or a tile for each.
CsgTree make_plate(PlateForm form);

}  // namespace arris::bench
