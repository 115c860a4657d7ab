// face_tree.h — the triangles of a mesh in boxes, to be walked down by shadow events
// What       four boxes a node, so that an event is held against four at a time
// In / Out   boxes in the mesh's UnitFrame; triangles by their index in the EdgeMesh
// Guarantee  a box holds its triangles, but for float's rounding, at most 2⁻²³ of the half size
//            (tests/edgepoint/face_tree_test.cpp)
// Limits     triangles of no area are left out. Keeps a reference to the mesh, which must outlive it and not move.
// Cost       build n log n, parallel; const afterwards
// Source     Bala, Walter, Greenberg 2003, section 6.4, "Shadow edge computation". There nodes bound normals, too, to
//            leave out what is turned away from the light. A walk that visits the nearest box first and stops behind
//            what it has found hardly meets such boxes: on irregular meshes of 250,000 triangles normals left out 3% of
//            nodes and 17% of triangles, and cost 40% more time than they saved. Here each triangle is asked.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "edgepoint/bounds_tree.h"
#include "edgepoint/edge_mesh.h"
#include "edgepoint/face_bounds.h"

namespace arris {

// Four boxes, in the unit frame, and what is in them.
struct alignas(64) FaceNode {
  std::array<std::array<float, 4>, 3> middle, reach;  // per axis, per box
  std::array<std::uint32_t, 4> first;                 // node, or first of the faces
  std::array<std::uint32_t, 4> count;                 // of faces; 0: a node
};

class FaceTree {
 public:
  explicit FaceTree(const EdgeMesh& mesh);
  explicit FaceTree(EdgeMesh&&) = delete;

  [[nodiscard]] const EdgeMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const UnitFrame& frame() const { return frame_; }
  // The root first; none without triangles. Boxes that are not there have a reach that meets nothing.
  [[nodiscard]] const std::vector<FaceNode>& nodes() const { return nodes_; }
  // Nodes hold ranges of these.
  [[nodiscard]] const std::vector<std::uint32_t>& faces() const { return faces_; }
  // Their corners, in the mesh's coordinates.
  [[nodiscard]] const std::vector<std::array<Vec3f, 3>>& corners() const { return corners_; }

 private:
  const EdgeMesh* mesh_;
  UnitFrame frame_;
  std::vector<FaceNode> nodes_;
  std::vector<std::array<Vec3f, 3>> corners_;
  std::vector<std::uint32_t> faces_;
};

}  // namespace arris
