// creased_solid.h — a solid of any shape whose every edge is flat, convex or concave, rounded exactly
// What       a hit on the mesh is kept iff the ball that touches the face there fits into the solid; a ray that is in
//            the void between the sharp and the rounded surface meets a pipe (crease_pipes.h) before it leaves the
//            sharp solid, or passes
// In / Out   coordinates relative to the solid's centre
// Guarantee  the surface is that of all balls of the radius that fit (tests/rounding/creased_test.cpp)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "rounding/crease_pipes.h"
#include "rounding/crease_shape.h"
#include "rounding/creases.h"
#include "rounding/solid_surface.h"

namespace arris {

// Where a ray in the void comes to the rounded surface, or where it leaves the sharp solid.
struct VoidCrossing {
  std::optional<PipeHit> met;
  SolidSurface::Exit exit;
};

struct CreasedSolid {
  SolidSurface surface;
  CreasePipes pipes;
  double radius = 0;
  double tolerance = 0;  // crease_tolerance()
  CreaseShape shape;

  // Whether a point of a face, whose normal is given, is on the rounded solid.
  [[nodiscard]] bool is_kept(Vec3d x, Vec3d normal, std::uint32_t region) const;
  // From a point of the void, or of the sharp surface above it, on along a ray within the sharp solid.
  [[nodiscard]] VoidCrossing cross_void(Vec3d x, Vec3d direction) const;
  // Of a place on a pipe of a curved solid, with its normal: the two faces that the ball there touches and between
  // which the normal lies. Nothing: there are no such two. Points are relative to the centre, triangles the mesh's.
  [[nodiscard]] std::optional<EdgeBlend> blend_at(Vec3d x, Vec3d normal) const;
  [[nodiscard]] std::size_t bytes() const {
    return surface.bytes() + pipes.bytes() + shape.bytes();
  }
};

// A linear function of the places of a triangle, by its corners, that is positive wherever the rounding has taken it
// away, and perhaps beside.
struct DepthAtCorners {
  double d0, d1, d2;
};
std::vector<DepthAtCorners> find_depths(const SolidSurface& surface,
                                        const SurfaceTriangle& triangle, Vec3d normal,
                                        double radius);

}  // namespace arris
