// crease_outline.h — the outline of a creased solid's rounded edges, and what stays of its concave ones
// What       On the pipe about a crease the outline is where the direction from the crease is perpendicular to the
//            view: two lines along a segment, two curves along an arc, cut to where that direction lies between those
//            in which the balls touch; on the ball at a node arcs of a circle. What lies within other balls of the
//            solid is left out, and what the surface itself hides because it curves towards the ray.
// In / Out   coordinates relative to the solid's centre
// Guarantee  lines of segments are exact; chords of curves lie within r / 500 of the surface, and each has its ends on
//            it but for r / 1000 (tests/rounding/crease_outline_test.cpp); from outside every jump of depth is at one
//            (tests/render/rounded_outline_test.cpp)
// Limits     where walls thinner than 2 r have vanished, what is left may end in balls whose outline is missing
//            (creases.h). Seen from within the solid, places that the surface hides are others.
// Cost       linear in the creases, and for each line that is found two or three searches of what is near it: 8 µs
// Legend     r radius; e eye; c point of a crease, T its unit direction; n from c to the surface: on the outline
//            n·(e − c) = r, which is (w/D) r/D ± T×(w/D) √(1 − r²/D²) for w = e − c across T, D its length
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "rounding/creased_solid.h"

namespace arris {

struct CreaseLine {
  Vec3d a, b;
  // Between directions in which balls touch on the two sides.
  Vec3d across;
  // How far rays from the eye along it go on through the void on either side, at most: through the solid's own, and
  // that of one that touches it there.
  double void_depth = 0;
};

// void_depth costs rays.
enum class VoidDepths : std::uint8_t { none, found };

std::vector<CreaseLine> find_crease_outline(const CreasedSolid& solid, Vec3d eye,
                                            VoidDepths depths);
// The middles of roundings both sides of which are seen.
std::vector<CreaseLine> find_crease_middles(const CreasedSolid& solid, Vec3d eye);

// The parts of a concave edge on the rounded surface, by fractions of it.
std::vector<std::pair<double, double>> find_kept_parts(const CreasedSolid& solid,
                                                       const FaceEdge& edge);

}  // namespace arris
