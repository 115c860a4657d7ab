// smooth_patches.h — the smooth pieces of surface of which a solid's leaves are bounded
// What       Every face of a leaf lies on one smooth surface, the zeros of a function with a gradient: a polynomial of
//            degree two (planes, quadrics, the walls of prisms that are scaled unevenly, the cylinders and spheres of
//            rounded leaves) or the distance from a ring. Where two meet, a solid may have an edge (crease_finder.h);
//            where one turns away from the eye, it has an outline (csg_outline.h).
// Frames     the tree's own space
// Legend     f value, g gradient
#pragma once

#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "csg/csg_solid.h"

namespace arris {

// p·(q p) + 2 b·p + c, q symmetric.
struct SpaceQuadratic {
  Mat3d q{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  Vec3d b;
  double c = 0;

  [[nodiscard]] double value(Vec3d p) const { return dot(p, q * p + b * 2.0) + c; }
  [[nodiscard]] Vec3d gradient(Vec3d p) const { return (q * p + b) * 2.0; }
  // The plane that meets the surface where lines from the eye touch it.
  [[nodiscard]] SpaceQuadratic polar(Vec3d eye) const {
    const Vec3d n = q * eye + b;
    return {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, n * 0.5, dot(b, eye) + c};
  }
};

class SmoothSurface {
 public:
  using Form = std::variant<SpaceQuadratic, TorusLeaf>;
  explicit SmoothSurface(Form form) : form_(std::move(form)) {}

  [[nodiscard]] const Form& form() const { return form_; }
  [[nodiscard]] double value(Vec3d p) const;
  [[nodiscard]] Vec3d gradient(Vec3d p) const;
  // No point of the box is one of the surface; true is certain but for rounding.
  [[nodiscard]] bool misses(const Box3d& box) const;
  // Appends where the segment from a to b crosses the surface, as parts of it; of a ring, to a sixteenth.
  void collect_crossings(Vec3d a, Vec3d b, std::vector<double>& out) const;
  // The gradients in the box are about combinations of those at its corners.
  [[nodiscard]] bool is_tame(const Box3d& box) const;

 private:
  Form form_;
};

struct SmoothPatch {
  std::uint32_t surface = 0, leaf = 0;
  std::uint32_t face = 0;            // of prisms and revolutions
  Box3d box;                         // holds it
  std::vector<CsgHalfSpace> within;  // and all of these; normals not unit
};

// But for rounding, which the leaf's own membership settles.
bool may_hold(const SmoothPatch& patch, Vec3d p);
bool may_hold(const SmoothPatch& patch, const Box3d& box);

// Between two triangles of a mesh leaf.
struct MeshLeafEdge {
  std::uint32_t leaf = 0;
  std::uint32_t surface0 = 0, surface1 = 0;
  Vec3d a, b;
};

// Of a prism whose scales differ, over an edge of its region.
struct CurvedWall {
  std::uint32_t patch = 0, leaf = 0, edge = 0;
};

class SmoothPatches {
 public:
  explicit SmoothPatches(const CsgSolid& solid);

  [[nodiscard]] const SmoothSurface& surface(std::uint32_t index) const { return surfaces_[index]; }
  [[nodiscard]] const std::vector<SmoothPatch>& patches() const { return patches_; }
  [[nodiscard]] const std::vector<MeshLeafEdge>& mesh_edges() const { return mesh_edges_; }
  // Ellipsoids, cylinders and cones with the patches that lie on them.
  struct Curved {
    CsgQuadric quadric;
    std::uint32_t patch;
  };
  [[nodiscard]] const std::vector<Curved>& curved() const { return curved_; }
  [[nodiscard]] const std::vector<CurvedWall>& walls() const { return walls_; }
  [[nodiscard]] const std::vector<std::uint32_t>& tori() const { return tori_; }  // patches

 private:
  struct Adder;

  std::vector<SmoothSurface> surfaces_;  // of the table: planes, then quadrics; then others
  std::vector<SmoothPatch> patches_;
  std::vector<MeshLeafEdge> mesh_edges_;
  std::vector<Curved> curved_;
  std::vector<CurvedWall> walls_;
  std::vector<std::uint32_t> tori_;
};

}  // namespace arris
