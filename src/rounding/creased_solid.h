// creased_solid.h — a solid of any shape, rounded exactly
// What       a hit on the mesh is kept iff the ball that touches the face there fits into the solid, or can't grow to
//            the radius from there (thin_walls.h); a ray that is in the void between the sharp and the rounded surface
//            meets a pipe (crease_pipes.h), or material that stays, before it leaves the sharp solid, or passes
// In / Out   coordinates relative to the solid's centre
// Guarantee  the surface is that of all balls of the radius that fit (tests/rounding/creased_test.cpp) and what stays
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
#include "rounding/clear_cells.h"
#include "rounding/crease_pipes.h"
#include "rounding/crease_shape.h"
#include "rounding/creases.h"
#include "rounding/narrow_cells.h"
#include "rounding/near_triangles.h"
#include "rounding/open_mouths.h"
#include "rounding/radius_field.h"
#include "rounding/solid_surface.h"
#include "rounding/stuck_places.h"

namespace arris {

// Where a ray in the void comes to the rounded surface; if nowhere, where it leaves the sharp solid.
struct VoidCrossing {
  std::optional<PipeHit> met;
  SolidSurface::Exit exit;
};

// By a triangle of the caller's mesh and barycentrics.
struct MeshPlace {
  std::uint32_t triangle;
  double u, v;
};

// An edge between two faces.
struct FaceEdge {
  Vec3d p0, p1;
  Vec3d normal0, normal1;
  std::uint32_t region0, region1;
};

struct CreasedSolid {
  SolidSurface surface;
  CreasePipes pipes;
  RadiusField field{0};
  double radius = 0;     // the largest
  double tolerance = 0;  // crease_tolerance()
  ClearCells clear;      // of the caller's triangles of which bands tell little
  NearLists near;        // of those with bands, and few others near
  OpenMouths mouths;     // of the space outside
  StuckPlaces stuck;
  NarrowCells narrow;

  // Which part of the balls is surface, for outlines: made on all cores when it is first asked for.
  [[nodiscard]] const CreaseShape& shape() const;
  // Whether a point of a face, whose normal is given, is on the rounded solid.
  [[nodiscard]] bool is_kept(Vec3d x, Vec3d normal, std::uint32_t region) const;
  [[nodiscard]] bool is_kept(const MeshPlace& at, Vec3d x, Vec3d normal,
                             std::uint32_t region) const;
  // From a point of the void, or of the sharp surface above it, on along a ray within the sharp solid.
  [[nodiscard]] VoidCrossing cross_void(Vec3d x, Vec3d direction) const;
  // The parts of a convex edge that stay sharp, by fractions of it.
  [[nodiscard]] std::vector<std::pair<double, double>> find_sharp_parts(const FaceEdge& edge) const;
  // How deep in balls a point is beneath the rounded surface.
  [[nodiscard]] double beneath() const;
  // Whether a point of the solid lies beneath the rounded surface, by more than what rays are computed to, or by so
  // many radii.
  [[nodiscard]] bool is_beneath(Vec3d x, double radii = 0) const;
  // Of a place on a pipe of a curved solid, with its normal: the two faces that the ball there touches and between
  // which the normal lies. Nothing: there are no such two. Points are relative to the centre, triangles the mesh's.
  [[nodiscard]] std::optional<EdgeBlend> blend_at(Vec3d x, Vec3d normal) const;
  [[nodiscard]] std::size_t bytes() const {
    return surface.bytes() + pipes.bytes() + field.bytes() + clear.bytes() + near.bytes() +
           mouths.bytes();
  }

  // Whether a place of a face that no ball of the radius r can touch stays all the same; at an edge, balls may lie in
  // another direction than the face's.
  [[nodiscard]] bool stays(Vec3d x, Vec3d normal, std::uint32_t region, double r,
                           bool is_at_edge = false) const;
  // Whether a ball gets stuck that touches a face near a place of its plane.
  [[nodiscard]] StuckPlaces::Answer gets_stuck_at(Vec3d x, std::uint32_t region) const;
  // Where a way through the void comes to material that stays; nothing: nowhere before the pipe, or the exit.
  [[nodiscard]] std::optional<PipeHit> first_material(Vec3d x, Vec3d direction,
                                                      const VoidCrossing& crossing) const;

  struct MadeShape {
    std::once_flag once;
    CreaseShape shape;
  };
  std::unique_ptr<MadeShape> made_shape = std::make_unique<MadeShape>();
};

}  // namespace arris
