// separation.h — is there a plane between a beam and a primitive?
// What       The paper's position tests (§2.3): the four planes of the beam, then planes through each of its edges
//            that touch the primitive. A primitive lies on one side of a plane if its extreme points do: of a sphere
//            along the plane's normal, of a cylinder the points Q on both rims, of a cone those and the apex, of a
//            polyhedron the corners of its box.
// Guarantee  a plane that is found separates, but for rounding. None may be found though there is one.
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §2.3
#pragma once

#include <array>
#include <cstdint>

#include "beam/beam_shape.h"

namespace arris {

// The pyramid of an eye and four directions in turn; in the space of a solid.
struct Pyramid {
  Vec3d apex;
  std::array<Vec3d, 4> edges;
};

// Precondition: the leaf is a ConvexLeaf.
bool is_separated(const Pyramid& beam, const BeamShape& shape, std::uint32_t leaf);

}  // namespace arris
