// csg_bounds.h — how large a tree of solids is, before anything is built from it
#pragma once

#include <cstdint>

#include "arris/csg.h"
#include "csg/cover.h"

namespace arris {

// Holds the solid as described, in the tree's own space; differences count as their first child. Empty (infinities the
// wrong way round) for the empty set, infinite for endless solids.
Box3d csg_bounds(const CsgTree& tree);

struct CsgCounts {
  std::uint64_t primitives = 0;  // leaves that nodes use
  std::uint64_t curved = 0;      // of them, those with a curved surface
  std::uint64_t flat_faces = 0;  // of the others
  std::uint64_t operations = 0;  // inner nodes
  std::uint64_t depth = 0;       // operations in one another
};
CsgCounts count_csg(const CsgTree& tree);

}  // namespace arris
