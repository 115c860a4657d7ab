// ray_bundle.h — rays without a common point: what a curved surface makes of a beam
// What       The paper's pseudo-semi-pyramid: origins and directions of all rays of a part of the picture, each a
//            quadratic polynomial of the picture's x and y and a bounded rest (taylor_model.h). A surface reflects or
//            refracts a bundle into the next one, level by level. What beams ask of planes and quadrics (beam_view.h)
//            is asked of bundles, too; their polynomials are over kUnitSquare.
// Guarantee  holds the ray of each point of the part, if that ray meets the surface where it is said to
//            (tests/beam/ray_bundle_test.cpp)
// Frames     the world, or a solid's space; depths are the same in all, in units of directions that are not unit
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §3, whose
//            volumes of four corner rays do not bound the others (docs/beam.md)
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "beam/beam_shape.h"
#include "beam/taylor_model.h"

namespace arris {

struct RayBundle {
  ModelVec origin, direction;
  std::optional<BeamSurface> start;  // on which all origins lie
};

// The eye: world rays through picture points, position + depth (corner + x step_x + y step_y).
struct EyeRays {
  Vec3d position;
  Vec3d corner, step_x, step_y;
};

RayBundle make_bundle(const EyeRays& eye, const Rect& rect);
// In the space of a solid.
RayBundle map_bundle(const Affine3d& m, const RayBundle& bundle);
// The same rays, begun at that depth.
RayBundle begun_at(const RayBundle& bundle, double depth);

// Where it meets the surface; nothing: it may run along it, or the surface is that of a leaf as a whole.
std::optional<RayBundle> reflect(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface);
// `relative_ior`: of where the rays come from, to that of where they go. Nothing also where some may be reflected
// totally.
std::optional<RayBundle> refract(const RayBundle& bundle, std::span<const BeamSolid> solids,
                                 const BeamSurface& surface, double relative_ior);
enum class Passing : std::uint8_t { all, none, unknown };
// Which rays are refracted, where all others are reflected totally.
Passing passing_of(const RayBundle& bundle, std::span<const BeamSolid> solids,
                   const BeamSurface& surface, double relative_ior);

// See PlaneForm and QuadricForm, beam_view.h.
struct BundlePlane {
  TaylorModel height, slope;
};
struct BundleQuadric {
  TaylorModel value, half_slope, curvature, discriminant, along;
  // From afar signs are differences of large numbers, each of which is known to third order only: so of depths, from
  // one near the middle between the roots, and half_slope there.
  double base = 0;
  TaylorModel base_half_slope;
};

// Precondition: the bundle is in the solid's space.
BundlePlane make_form(const RayBundle& bundle, const CsgPlane& plane);
BundleQuadric make_form(const RayBundle& bundle, const CsgQuadric& quadric);
TaylorModel make_side(const RayBundle& bundle, const BeamShape::Edge& edge);

BundlePlane begun_at(const BundlePlane& form, double depth);
// About where the middle of all rays meets it; 0 if it is never met.
double middle_depth(const BundlePlane& form);

TaylorModel plane_before_plane(const BundlePlane& a, const BundlePlane& b);
TaylorModel quadric_at_plane(const BundleQuadric& q, const BundlePlane& p);
TaylorModel plane_beyond_middle(const BundleQuadric& q, const BundlePlane& p);

}  // namespace arris
