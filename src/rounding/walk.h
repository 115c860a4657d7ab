// walk.h — from the void to the rounded surface
// What       Between the sharp and the rounded edge lies the void P \ opening(P). The distance from a point of the void
//            to E is the distance to the nearest arc or node, whose Voronoi regions partition the void: an arc's is
//            the slab between its end planes, a node's what its arcs' slabs leave. A ray is walked from region to
//            region (paper §3.1 and §4, the adjacency graph) until it meets the cylinder or sphere of the region it is
//            in, leaves through a face, or moves away: the distance to the convex E along a ray is convex, so it
//            won't come back. On solids that aren't exact a ray is walked on, through the regions of a local E.
// In / Out   positions relative to the solid's centre; directions unit
// Guarantee  every walk ends: steps are bounded by kMaxSteps, far above what a corner needs
// Source     Courtin et al. §4, Fig. 7: there all cylinders that hold the hit are tried first, then spheres; here
//            regions are met in the ray's order, as in V-Clip (Mirtich 1998), for a point
#pragma once

#include <optional>

#include "rounding/rounding_data.h"

namespace arris {

struct Place {
  std::uint32_t index = 0;  // arc or node
  bool is_node = false;
};

// The arc or node nearest to x, a point of the void, from an arc nearby. Nothing if x is beyond the end of
// the rounding.
std::optional<Place> find_place(const Rounding::Data& data, const Solid& solid, std::uint32_t arc,
                                Vec3d x);
// The same by looking at all of the solid's arcs and nodes.
std::optional<Place> search_place(const Rounding::Data& data, const Solid& solid, Vec3d x);

// Distance from x to the place: to the arc's axis or the node's centre.
double distance_to_place(const Rounding::Data& data, Place place, Vec3d x);

struct WalkHit {
  double distance = 0;  // along the ray from its start
  Vec3d normal;
  Feature feature = Feature::edge;
  std::uint32_t arc = kNone;  // of an edge
};

// The commonest walk of all: x lies between the ends of an exact solid's arc, and the ray meets its cylinder before it
// leaves that slab, or moves away. `certain` is false where walk() must decide. The direction may have any length, in
// which the distance is then counted.
struct ShortWalk {
  bool certain = false;
  std::optional<WalkHit> hit;
};
ShortWalk walk_short(const Rounding::Data& data, std::uint32_t arc, Vec3d x, Vec3d direction);

// From x, a point of the void at `place`. Nothing if the ray leaves the solid.
std::optional<WalkHit> walk(const Rounding::Data& data, const Solid& solid, Place place, Vec3d x,
                            Vec3d direction);

}  // namespace arris
