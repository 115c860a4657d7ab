// edge_tree.h — finds the edges of a mesh that a viewpoint sees as outline, without looking at all of them
// What       a tree over the edges. Each node bounds the normals and the positions of its edges' faces by interval
//            vectors: where normal · (viewpoint − position) cannot change sign, no edge below is a silhouette.
//            find_drawn() works on a share of the tree at a time, for threads to share a mesh, and leaves out what is
//            beside the picture.
// In / Out   the mesh's own coordinates; edges by their index in the EdgeMesh, in the tree's order
// Guarantee  finds exactly the edges for which the predicate of edge_mesh.h holds, for every viewpoint: at infinity,
//            on the surface, within it (tests/edgepoint/edge_tree_test.cpp). Bounds and planes are stored as float; a
//            sign that is within kSignMargin of zero is not believed: nodes are entered, edges put to the predicate.
//            Same tree, same order, with any number of threads.
// Limits     viewpoints finite. Keeps a reference to the mesh, which must outlive it and not move.
// Cost       build n log n, parallel; query about proportional to what is found, on all cores for one viewpoint of a
//            large tree. Const afterwards, queries from any number of threads.
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

// Where direction·p + offset >= 0.
struct HalfSpace {
  Vec3d direction;
  double offset = 0;
};

struct EdgeEnds {
  Vec3f a, b;
};

// Edges below a node end within it.
struct EdgeBox {
  Vec3f low, high;
};

enum class EdgeGroup : std::uint8_t { open, smooth, sharp };

// Some nodes' edges of one group.
struct EdgeShare {
  EdgeGroup group = EdgeGroup::smooth;
  std::uint32_t first = 0, last = 0;
};

struct DrawnQuery {
  HomogeneousPoint from;
  bool turned_away = false;           // sharp edges also where neither face faces the viewpoint
  std::span<const HalfSpace> within;  // edges outside of one of these may be left out
};

class EdgeTree {
 public:
  explicit EdgeTree(const EdgeMesh& mesh);
  explicit EdgeTree(EdgeMesh&&) = delete;

  [[nodiscard]] const EdgeMesh& mesh() const { return *mesh_; }
  // Edges of which is_silhouette() holds; open edges first.
  [[nodiscard]] std::vector<std::uint32_t> find_silhouettes(const HomogeneousPoint& from) const;
  // Shares of all edges; together they find what is drawn.
  [[nodiscard]] const std::vector<EdgeShare>& shares() const { return shares_; }
  // Appends places in the share's group of the edges of which is_drawn() holds.
  void find_drawn(const EdgeShare& share, const DrawnQuery& query,
                  std::vector<std::uint32_t>& places) const;
  // By place in a group.
  [[nodiscard]] std::span<const std::uint32_t> edges(EdgeGroup group) const {
    return part(group).edges;
  }
  [[nodiscard]] std::span<const EdgeEnds> ends(EdgeGroup group) const { return part(group).ends; }
  // Edges of which may_be_silhouette() holds, as for a light with these corners; open edges first.
  [[nodiscard]] std::vector<std::uint32_t> find_possible_silhouettes(
      std::span<const HomogeneousPoint> from) const;

  // Planes n·x = d of both faces of each edge.
  struct Part {
    std::vector<BoundsNode> nodes;
    std::vector<EdgeBox> boxes;  // of the nodes
    std::vector<std::uint32_t> edges;
    std::vector<EdgeEnds> ends;
    std::array<std::vector<float>, 8> planes;  // n0, d0, n1, d1
  };

 private:
  [[nodiscard]] const Part& part(EdgeGroup group) const {
    return group == EdgeGroup::open ? open_ : group == EdgeGroup::smooth ? smooth_ : sharp_;
  }

  const EdgeMesh* mesh_;
  UnitFrame frame_;
  Part open_;  // without nodes and planes
  Part smooth_, sharp_;
  std::vector<EdgeShare> shares_;
};

}  // namespace arris
