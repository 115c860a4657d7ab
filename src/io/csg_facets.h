// csg_facets.h — OpenSCAD's facets of round things
// What       fragments(): how many a full circle has; the points of spheres and cylinders as OpenSCAD cuts
//            them: a sphere's rings lie half a step off its poles, so that it has no vertex there
// Source     OpenSCAD 2021.01: $fn > 0 without its fraction and at least 3, else by $fa (degrees) and $fs (length)
#pragma once

#include <vector>

#include "arris/csg.h"

namespace arris {

struct FacetSettings {
  double fn = 0, fa = 12, fs = 2;
};

// Explicit $fn up to this: the facets are meant, as with $fn = 6 for a hexagon. Beyond: a circle is.
inline constexpr int kMaxMeantFacets = 12;
// A sphere has half the square of its facets as vertices.
inline constexpr int kMaxFacets = 2000;

// Not limited to kMaxFacets.
double fragments(const FacetSettings& settings, double radius);
// By kMaxMeantFacets.
bool means_facets(const FacetSettings& settings);
// Steps that a twist over a height is cut into; `radius` of the farthest point.
double twist_slices(const FacetSettings& settings, double radius, double height, double twist_deg);

std::vector<Vec3d> sphere_points(double radius, int facets);
std::vector<Vec3d> cone_points(const CsgCone& cone, int facets);

}  // namespace arris
