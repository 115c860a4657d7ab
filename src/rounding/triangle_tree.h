// triangle_tree.h — the triangles of one face in a tree of boxes, to find those that reach into slabs
// Cost       building n log n; a search visits the triangles near the slabs alone, so that a face of many edges
//            does not cost the product of its edges and triangles
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "arris/rounding.h"

namespace arris {

// All x with low ≤ normal·x ≤ high.
struct Slab {
  Vec3d normal;
  double low, high;
};

class TriangleTree {
 public:
  // Coordinates are relative to `center`.
  TriangleTree(const MeshView& mesh, std::span<const std::uint32_t> triangles, Vec3d center);

  // Visits every triangle that reaches into all the slabs, and some beside it.
  template <class Visit>
  void for_each_near(std::span<const Slab> slabs, Visit&& visit) const {
    for (std::uint32_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      const bool is_near =
          std::ranges::all_of(slabs, [&](const Slab& s) { return reaches(node, s); });
      if (is_near) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(triangles_[node.first + k]);
      }
      i = is_near ? i + 1 : node.next;
    }
  }

 private:
  struct Node {
    Vec3d middle, half;                  // of the box
    std::uint32_t first = 0, count = 0;  // its triangles, of a leaf
    std::uint32_t next = 0;              // the node after this one's children
  };
  struct Item {
    Vec3d low, high;
    std::uint32_t triangle;
  };

  static bool reaches(const Node& node, const Slab& slab);
  void build(std::span<Item> items);

  std::vector<Node> nodes_;  // each before its children
  std::vector<std::uint32_t> triangles_;
};

}  // namespace arris
