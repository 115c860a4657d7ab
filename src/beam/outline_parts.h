// outline_parts.h — a region of the plane as unions and differences of convex polygons
// What       A polygon is its convex hull without its pockets, which are polygons again, until all are convex. Holes
//            are taken from the outline around them.
// Guarantee  no edge is added but the lids of the pockets, which lie on edges of the hull above (where a difference
//            leaves nothing of them). Together the parts are the region (tests/beam/convex_solid_test.cpp).
// Limits     outlines must not cross each other or themselves; they may touch in vertices. Nothing if they cross, or
//            have more than kMostOutlineEdges edges.
// Cost       edges squared, for the check
// Source     S. B. Tor and A. E. Middleditch, "Convex Decomposition of Simple Polygons", ACM TOG 1984
#pragma once

#include <optional>
#include <vector>

#include "arris/csg.h"

namespace arris {

inline constexpr std::size_t kMostOutlineEdges = 20'000;

// hull without the pockets; convex, counter-clockwise, no three vertices on a line.
struct OutlinePart {
  std::vector<Vec2d> hull;
  std::vector<OutlinePart> pockets;
};

// Their union is the region.
std::optional<std::vector<OutlinePart>> find_outline_parts(const CsgRegion& region);

}  // namespace arris
