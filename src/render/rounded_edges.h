// rounded_edges.h — the outline of rounded edges and corners
// What       Seen from an eye, the outline of a rounded solid is not its mesh's edge but where the normal of a rounding
//            cylinder or sphere is perpendicular to the view: on a cylinder straight lines along its axis, on a sphere
//            arcs of a circle. The border between a face and its rounding is no discontinuity and gets no edge.
// Guarantee  lines and arcs lie on the rounded surface of convex solids, and end where their cylinder or sphere ends
//            (tests/render/rounded_edges_test.cpp)
// Limits     beside concave edges, and where roundings end in caps, a line may go on for up to a radius
// Legend     r radius; c centre or axis point; n outward normal; e eye: on the outline n·(e − c) = r
// Source     Bala, Walter, Greenberg (2003), §6.1, whose objects are meshes; Courtin et al., §3, for the surface
#pragma once

#include <vector>

#include "edgepoint/edge_raster.h"
#include "render/scene_rounding.h"

namespace arris {

// Appends the outline in the world. least_radius(p): the radius in the world below which a rounding at p is too small
// to be seen as one, and left out.
struct RoundedView {
  Vec3d eye;
  Vec3d forward;           // unit; depth is measured along it
  double radius_at_depth;  // the least radius at depth 1
};

void find_rounded_outline(const RoundedGeometry& geometry, const RoundedView& view,
                          std::vector<WorldEdge>& edges);

// Whether a rounding of this radius is seen as one at a point of the world.
inline bool is_seen_rounded(const RoundedView& view, double radius, Vec3d p) {
  return radius > view.radius_at_depth * dot(p - view.eye, view.forward);
}

}  // namespace arris
