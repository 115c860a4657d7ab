// crease_shape.h — which part of the balls about a creased solid's creases is its surface
// What       A ball about a point c of a crease touches the solid in two places, in the directions a and b from c: of
//            its sphere the arc between them, across the crease, is surface. Where creases end, the ball touches in
//            more places, and the part of its sphere that their directions span is.
// In / Out   coordinates relative to the solid's centre; directions are unit
// Guarantee  directions of faces are exact; those of edges, along arcs, are interpolated over at most kArcStep
// Legend     r radius; c point of a crease; T unit direction of the crease
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rounding/crease_curve.h"
#include "rounding/solid_surface.h"

namespace arris {

// Chords of a circle of radius r that turn by this lie within r / 1000 of it.
inline constexpr double kArcStep = radians(5);

// From a to b it turns about T, by less than half a turn.
struct CreaseWedge {
  Vec3d a, b;
};

struct CreasePipe {
  CreaseCurve curve;
  std::vector<CreaseWedge> wedges;  // of a line one; else at even steps of u, from u0 to u1
  // At its ends; kNone where no more than the pipe is surface.
  std::array<std::uint32_t, 2> balls{kNone, kNone};

  [[nodiscard]] CreaseWedge wedge_at(double u) const;
  // Steps in u whose chords lie within r / 1000 of the curve.
  [[nodiscard]] static int steps_of(const CreaseCurve& curve);
};

struct CreaseBall {
  Vec3d center;
  double radius = 0;
  std::vector<Vec3d> contacts;  // directions
  std::vector<Vec3d> sides;     // n is spanned by the contacts where n·side ≥ 0 for all
  Vec3d middle;                 // direction
};

// A piece of a line along which balls about two places meet in a hollow.
struct CreaseGroove {
  Vec3d p0, p1;
  Vec3d normal0, normal1;  // of the two sides
};

// Where pipes along one edge meet whose balls grow differently.
struct CreaseJoint {
  std::array<std::uint32_t, 2> pipes;
  std::array<bool, 2> is_last;  // ends
};

struct CreaseShape {
  std::vector<CreasePipe> pipes;
  std::vector<CreaseJoint> joints;
  std::vector<CreaseBall> balls;
  std::vector<CreaseGroove> grooves;
};

// All but the grooves (crease_grooves.h). radius: the largest; tolerance: crease_tolerance()
CreaseShape make_crease_shape(const SolidSurface& surface, std::span<const CreaseCurve> creases,
                              double radius, double tolerance);

}  // namespace arris
