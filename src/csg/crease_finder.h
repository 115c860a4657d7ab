// crease_finder.h — the edges of a solid of solids: where smooth pieces of its surface meet
// What       find_creases() follows the curves in which two surfaces meet, cell by cell, and keeps the pieces along
//            which the solid's surface turns or its material changes
// In / Out   segments in the tree's space. Turns of less than kSoftTurn are soft: to be drawn as outlines only.
// Guarantee  in a box that is taken as one segment the curve exists once: a bound on the gradients says so. Chords turn
//            by at most kChordTurn, or are shorter than kShortChord of the solid (tests/render/csg_edges_test.cpp).
//            Membership of points around the curve decides whether the solid has an edge there, so coincident faces,
//            tangent surfaces and edges in contact are what the solid makes of them. The same segments in the same
//            order at any number of threads.
// Limits     where two surfaces touch along a curve, at less than kTangent, they make no edge, even if the solid has
//            one there (the sharp rim between a cylinder and a torus that is tangent to it from outside); features
//            thinner than CellProbe::reach() may be missed
// Errors     Error{failed} once `stop` is set, within the time of a few boxes
// Cost       for each cell its pairs of surfaces; some 100 boxes and membership tests for each curve
// Source     J. M. Snyder, "Interval Analysis for Computer Graphics", 1992, §3: boxes are halved until a Jacobian says
//            that what they hold is one piece; ours is bounded at the corners
// Legend     f, g value and gradient of the two surfaces; along: unit tangent, g0 × g1
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "csg/cell_probe.h"
#include "csg/smooth_patches.h"

namespace arris {

struct CreaseSegment {
  enum class Kind : std::uint8_t {
    soft,     // an edge where one of its two sides faces the eye and the other doesn't
    sharp,    // an edge where one of its two sides faces the eye
    contact,  // always an edge: more than two pieces of surface meet, or they turn along it
  };
  Vec3d a, b;
  Kind kind = Kind::contact;
  std::uint32_t cell = 0;
  Vec3d middle;                 // of the curve, where a and b are the ends of a chord
  std::array<Vec3d, 2> normal;  // outward, of the two sides; contact: none
};

// Turns of the surface below are soft, and below the second none at all.
inline constexpr double kSoftTurn = radians(2);
inline constexpr double kNoTurn = radians(0.2);
inline constexpr double kChordTurn = radians(6);
// Along a segment that isn't always drawn no side turns by more.
inline constexpr double kSideTurn = radians(8);
inline constexpr double kShortChord = 5e-4;
inline constexpr double kTangent = radians(1);

std::vector<CreaseSegment> find_creases(const CellProbe& probe, const SmoothPatches& patches,
                                        int threads, const std::atomic<bool>* stop = nullptr);

}  // namespace arris
