// edge_tree.h — finds the edges of a mesh that a viewpoint sees as outline, without looking at all of them
// What       a tree over the edges. Each node bounds the normals and the positions of its edges' faces by interval
//            vectors: where normal · (viewpoint − position) cannot change sign, no edge below is a silhouette.
// In / Out   the mesh's own coordinates; edges by their index in the EdgeMesh, in the tree's order
// Guarantee  finds exactly the edges for which the predicate of edge_mesh.h holds, for every viewpoint: at infinity,
//            on the surface, within it (tests/edgepoint/edge_tree_test.cpp). Bounds and planes are stored as float; a
//            sign that is within kSignMargin of zero is not believed: nodes are entered, edges put to the predicate.
//            Same tree, same order, with any number of threads.
// Limits     viewpoints finite. Keeps a reference to the mesh, which must outlive it and not move.
// Cost       build n log n, parallel; query about proportional to what is found, on all cores for one viewpoint of a
//            large tree. Const afterwards, queries from any
//            number of threads.
// Source     Bala, Walter, Greenberg 2003, section 6.4. As there: interval vectors, split on one axis where the
//            children are smallest, edges whose normals span more than half of their node's stay at the node. Beyond
//            it: size counts by how many edges a child has, and positions are split on as well as normals, for which
//            of both promises more (large flat or evenly curved parts have no normals to tell apart); sharp edges,
//            which show from all of their front, have a tree of their own; nodes lie in depth-first order and say
//            how many to skip, so that the traversal is a loop; edges are tested by the planes of their faces, many
//            at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/bounds_tree.h"
#include "edgepoint/edge_mesh.h"
#include "edgepoint/face_bounds.h"

namespace arris {

class EdgeTree {
 public:
  explicit EdgeTree(const EdgeMesh& mesh);
  explicit EdgeTree(EdgeMesh&&) = delete;

  [[nodiscard]] const EdgeMesh& mesh() const { return *mesh_; }
  // Edges of which is_silhouette() holds; open edges first.
  [[nodiscard]] std::vector<std::uint32_t> find_silhouettes(const HomogeneousPoint& from) const;
  // Edges of which is_drawn() holds; open edges first.
  [[nodiscard]] std::vector<std::uint32_t> find_drawn(const HomogeneousPoint& from) const;
  // Edges of which may_be_silhouette() holds, as for a light with these corners; open edges first.
  [[nodiscard]] std::vector<std::uint32_t> find_possible_silhouettes(
      std::span<const HomogeneousPoint> from) const;

  // Planes n·x = d of both faces of each edge.
  struct Part {
    std::vector<BoundsNode> nodes;
    std::vector<std::uint32_t> edges;
    std::array<std::vector<float>, 8> planes;  // n0, d0, n1, d1
  };

 private:
  const EdgeMesh* mesh_;
  UnitFrame frame_;
  std::vector<std::uint32_t> open_;
  Part smooth_, sharp_;
};

}  // namespace arris
