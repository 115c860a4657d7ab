// varied_creases.h — the creases of a solid whose edges have radii of their own
// What       Each corner has the median radius of its convex edges, and the creases about it are those of that one
//            radius (creases.h). Along an edge the radius then turns to the edge's own, by balls between its two faces:
//            the cone that these fill touches both. An edge without radius stays sharp between its corners.
//            Balls of all radii lie in the solid, but the field knows the nearest edge alone.
// In / Out   coordinates relative to the solid's centre
// Guarantee  the profile of an edge is a smooth step of kTransitionSteps pieces, twice as long as the radius changes by
// Limits     an edge too short for its transitions, or without room for them, takes a radius of its ends, or these take
//            its own
// Cost       that of find_creases() for each radius
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rounding/creases.h"
#include "rounding/radius_field.h"

namespace arris {

struct VariedInput {
  const CreaseInput& solid;       // its radius is of no account
  std::span<const double> radii;  // per half-edge of the mesh
  bool clamp = false;             // edges without room take a smaller radius, else they stay sharp
};

// A part of an edge that has a smaller radius than it should, or stays sharp: there is no room.
struct ClampedPart {
  std::uint32_t half_edge;
  double radius;
  double from = 0, to = 1;  // fractions of it
};

struct VariedCreases {
  std::vector<CreaseCurve> curves;
  RadiusField field{0};
  std::vector<ClampedPart> clamped;  // whole edges
};

VariedCreases find_varied_creases(const VariedInput& input);

}  // namespace arris
