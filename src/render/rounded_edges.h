// rounded_edges.h — the outline of rounded edges and corners
// What       Seen from an eye, the outline of a rounded solid is not its mesh's edge but where the normal of a rounding
//            cylinder or sphere is perpendicular to the view: on a cylinder straight lines along its axis, on a sphere
//            arcs of a circle. The border between a face and its rounding is no discontinuity and gets no edge. But
//            where both faces are seen and the rounding between them is narrow, its middle is an edge, the crease.
//            Creased solids (rounding/creased_solid.h) have outlines of their own (rounding/crease_outline.h), and
//            edges along the grooves in which their roundings meet.
// Guarantee  lines and arcs lie on the rounded surface of convex and creased solids, and end where their cylinder,
//            pipe or sphere ends (tests/render/rounded_shadow_test.cpp, tests/render/rounded_outline_test.cpp)
// Limits     on solids rounded locally, beside concave edges and where roundings end in caps, a line may go on for up
//            to a radius
// Legend     r radius; c centre or axis point; n outward normal; e eye: on the outline n·(e − c) = r
// Derivation A ray that touches the outline at c + r n in direction d leaves the void by a face of normal m, whose
//            plane is m·(x − c) = r, after r (1 − m·n) / (m·d); of several the first. The void of a touching solid is
//            at most as wide as two tangents r tan(θ/2), θ the angle between the faces; across the axis of an edge, the
//            ray advances by |d − (d·axis) axis|.
// Source     Bala, Walter, Greenberg (2003), §6.1, whose objects are meshes; Courtin et al., §3, for the surface
#pragma once

#include <vector>

#include "edgepoint/edge_raster.h"
#include "render/scene_rounding.h"

namespace arris {

// Where roundings are looked at from. Those of less than the least radius are too small to be seen as such.
struct RoundedView {
  Vec3d eye;
  Vec3d forward;               // unit; depth is measured along it
  double radius_at_depth;      // the least radius at depth 1
  double crease_at_depth = 0;  // the largest width of one that has a crease, at depth 1
};

// With the creases.
void find_rounded_outline(const RoundedGeometry& geometry, const RoundedView& view,
                          std::vector<WorldEdge>& edges);

// A piece of the outline, and how far rays from the eye that touch it go on through the void on either side, at most:
// through the solid's own, and that of one that touches it there. Nothing of the sharp faces there is taken for a
// surface.
struct RoundedTangent {
  WorldEdge edge;
  double void_depth = 0;
};
std::vector<RoundedTangent> find_rounded_tangents(const RoundedGeometry& geometry,
                                                  const RoundedView& view);

// Whether a rounding of this radius is seen as one at a point of the world.
inline bool is_seen_rounded(const RoundedView& view, double radius, Vec3d p) {
  return radius > view.radius_at_depth * dot(p - view.eye, view.forward);
}

}  // namespace arris
