// creased_solid.h — a solid of any shape whose every edge is flat, convex or concave, rounded exactly
// What       a hit on the mesh is kept iff the ball that touches the face there fits into the solid; a ray that is in
//            the void between the sharp and the rounded surface meets a pipe (crease_pipes.h) before it leaves the
//            sharp solid, or passes
// In / Out   coordinates relative to the solid's centre
// Guarantee  the surface is that of all balls of the radius that fit (tests/rounding/creased_test.cpp)
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "rounding/crease_pipes.h"
#include "rounding/crease_shape.h"
#include "rounding/creases.h"
#include "rounding/radius_field.h"
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
  RadiusField field{0};
  double radius = 0;     // the largest
  double tolerance = 0;  // crease_tolerance()
  // Regions beside which voids may have open ends: at edges that stay sharp, and where edges have several
  // radii; sorted.
  std::vector<std::uint32_t> loose;

  // Which part of the balls is surface, for outlines: made on all cores when it is first asked for.
  [[nodiscard]] const CreaseShape& shape() const;
  // Whether a point of a face, whose normal is given, is on the rounded solid.
  [[nodiscard]] bool is_kept(Vec3d x, Vec3d normal, std::uint32_t region) const;
  // From a point of the void, or of the sharp surface above it, on along a ray within the sharp solid.
  [[nodiscard]] VoidCrossing cross_void(Vec3d x, Vec3d direction) const;
  // The parts of a convex edge of two faces that stay sharp, by fractions of it.
  [[nodiscard]] std::vector<std::pair<double, double>> find_sharp_parts(std::uint32_t face,
                                                                        std::uint32_t other,
                                                                        Vec3d p0, Vec3d p1) const;
  // How deep in balls a point is beneath the rounded surface.
  [[nodiscard]] double beneath() const;
  // Whether a point of the solid lies beneath the rounded surface, by more than what rays are computed to, or by so
  // many radii.
  [[nodiscard]] bool is_beneath(Vec3d x, double radii = 0) const;
  [[nodiscard]] bool is_loose(std::uint32_t region) const {
    return std::ranges::binary_search(loose, region);
  }
  // Where edges stay sharp nothing ends their neighbours' voids: whether a way from x on a face, up to a place on
  // another one or a pipe, is no way through the void.
  [[nodiscard]] bool is_through_material(Vec3d x, std::uint32_t region, Vec3d direction, double end,
                                         std::uint32_t end_region) const;
  // Of a place on a pipe of a curved solid, with its normal: the two faces that the ball there touches and between
  // which the normal lies. Nothing: there are no such two. Points are relative to the centre, triangles the mesh's.
  [[nodiscard]] std::optional<EdgeBlend> blend_at(Vec3d x, Vec3d normal) const;
  [[nodiscard]] std::size_t bytes() const {
    return surface.bytes() + pipes.bytes() + field.bytes();
  }

  struct MadeShape {
    std::once_flag once;
    CreaseShape shape;
  };
  std::unique_ptr<MadeShape> made_shape = std::make_unique<MadeShape>();
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
