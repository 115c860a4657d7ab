// closed_mesh.h — a closed triangle mesh as a solid: winding number not 0
// What       crossings of a line with their sense, membership, and whether a box meets a triangle; by a tree of boxes
// Guarantee  each edge is crossed on one side only: of a closed mesh a line's crossings always add up to 0, but for
//            lines through the very vertex
// Source     Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013: shear along the largest axis; in
//            double, and an edge function of 0 counts as positive for the edge's lower vertex first
// Cost       a line about linear in what it crosses
#pragma once

#include <cstdint>
#include <vector>

#include "arris/csg.h"
#include "arris/rounding.h"
#include "csg/cover.h"
#include "csg/place_tree.h"

namespace arris {

class ClosedMesh {
 public:
  // Triangles that name vertices beyond the end are left out.
  ClosedMesh(std::vector<Vec3d> vertices, const std::vector<Triangle>& triangles);

  struct Crossing {
    double t = 0;
    std::uint32_t triangle = 0;
    int winding = 0;  // what it adds to the winding number: +1 entering
  };
  // Appends the whole line's crossings, in no order.
  void collect_crossings(const Ray& ray, std::vector<Crossing>& out) const;
  [[nodiscard]] bool contains(Vec3d p) const;
  [[nodiscard]] Cover cover(const SpaceCell& cell) const;

  // Of vertices and triangles: meshes of one digest are crossed alike.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<Vec3d>& vertices() const { return vertices_; }
  // Not unit; 0 where the triangle has no area.
  [[nodiscard]] Vec3d normal_of(std::uint32_t triangle) const;

 private:
  void make_digest();

  std::vector<Vec3d> vertices_;
  std::vector<Triangle> triangles_;
  PlaceTree tree_;  // of triangles
  std::uint64_t digest_ = 0;
  double slack_ = 0;  // the tree's boxes are wider by this: rounding of the crossing test
};

}  // namespace arris
