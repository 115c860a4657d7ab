// csg_leaf.h — the primitives of a tree as they are evaluated: placed, their faces in the table of surfaces
// What       Sphere, box, cylinder, cone, half-space and polyhedron are one kind: what is below planes and within a
//            quadric. The others keep a frame of their own.
// Faces      numbered per leaf, one number for each smooth piece of surface: see each kind
// Frames     planes, quadrics and meshes are in the tree's space; the rest is in that of the primitive
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "csg/closed_mesh.h"
#include "csg/region.h"
#include "csg/surfaces.h"

namespace arris {

// Faces: the planes in their order, then the quadric.
struct ConvexLeaf {
  std::vector<PlaneRef> planes;
  std::optional<std::uint32_t> quadric;
};
// One face.
struct TorusLeaf {
  Affine3d primitive_from_object;
  double ring_radius = 0, tube_radius = 0;
};
// Faces: low end, high end, then the walls in the order of the region's edges.
struct PrismLeaf {
  Affine3d primitive_from_object;
  CsgPrism shape;
  Region region;
  PlaneRef low, high;
  std::vector<PlaneRef> walls;  // empty where scale_high differs in x and y: they are not flat then

  [[nodiscard]] Vec2d growth() const {  // of the scale per z
    const double height = shape.z_high - shape.z_low;
    return {(shape.scale_high.x - 1) / height, (shape.scale_high.y - 1) / height};
  }
};
// Faces: in the order of the region's edges. An edge on the axis has no surface.
struct RevolutionLeaf {
  struct None {};
  struct Ring {
    PlaneRef plane;
  };
  struct Band {
    std::uint32_t quadric;
  };
  using Swept = std::variant<None, Ring, Band>;
  Affine3d primitive_from_object;
  Region region;  // x: distance from the axis, y: height
  std::vector<Swept> swept;
};
// Faces: the triangles.
struct MeshLeaf {
  ClosedMesh mesh;
  std::vector<PlaneRef> planes;  // by triangle
};
// Faces: those of the core moved out, then its edges' cylinders, then its vertices' spheres.
struct RoundedLeaf {
  struct Face {
    CsgHalfSpace plane;
    std::vector<CsgHalfSpace> sides;  // through its edges, upright on the plane
    PlaneRef moved;
  };
  struct Edge {
    Vec3d a, b;
  };
  Affine3d primitive_from_object;
  double radius = 0;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<Vec3d> vertices;
};

using CsgShape =
    std::variant<ConvexLeaf, TorusLeaf, PrismLeaf, RevolutionLeaf, MeshLeaf, RoundedLeaf>;

struct PlacedLeaf {
  CsgShape shape;
  Box3d bounds;  // infinite for half-spaces
  MaterialId material;
};

// Nothing if the leaf has no points: sizes that are not positive, no numbers, or a placement that flattens.
std::optional<PlacedLeaf> place_leaf(const CsgLeaf& leaf, SurfaceTable& surfaces);

// The box of a leaf where it is placed, as described; infinite for half-spaces; empty for none.
Box3d extent_of(const CsgLeaf& leaf);
// A little wider: faces move onto equal ones.
Box3d bounds_of(const CsgLeaf& leaf);

// Where the leaf lies relative to a cell: in and out are certain. `surfaces` is the table it was placed with.
Cover cover_of(const PlacedLeaf& leaf, const SurfaceTable& surfaces, const SpaceCell& cell);
// The one surface of the table that is left of a leaf in a cell, if that is all: inside is where the plane's height
// or the quadric's value is negative, or positive if flipped.
struct SoleSurface {
  enum class Kind : std::uint8_t { plane, quadric, other } kind = Kind::other;
  std::uint32_t index = 0;
  bool flipped = false;
};
std::optional<SoleSurface> sole_surface_of(const PlacedLeaf& leaf, const SurfaceTable& surfaces,
                                           const SpaceCell& cell);
[[nodiscard]] bool contains(const PlacedLeaf& leaf, const SurfaceTable& surfaces, Vec3d p);
// Outward, not unit, at a point of that face.
Vec3d normal_at(const PlacedLeaf& leaf, const SurfaceTable& surfaces, std::uint32_t face, Vec3d p);

// Distance of a point from a rounded leaf's core, in the primitive's space.
double distance_to_core(const RoundedLeaf& leaf, Vec3d p);

}  // namespace arris
