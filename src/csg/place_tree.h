// place_tree.h — a binary tree of boxes over numbered things, by place
// What       halved by the middles of the boxes along their longest side, so that its depth is that of a balanced tree;
//            visit() goes down where the caller's test lets it
// Cost       building n log n; boxes are kept by the tree's owner
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "csg/cover.h"

namespace arris {

class PlaceTree {
 public:
  PlaceTree() = default;
  // Of the numbers in `items`, whose boxes are finite. The tree's own boxes are wider by `slack`.
  PlaceTree(std::vector<std::uint32_t> items, std::span<const Box3d> boxes, double slack);

  [[nodiscard]] bool is_empty() const { return nodes_.empty(); }
  [[nodiscard]] const Box3d& bounds() const { return nodes_[0].box; }

  // meets(box) for the tree's boxes; take(item) for the items below those that it holds for, until it says false.
  template <class Meets, class Take>
  void visit(const Meets& meets, const Take& take) const {
    std::uint32_t stack[64];
    int top = 0;
    if (!nodes_.empty()) stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t at = stack[--top];
      const Node& node = nodes_[at];
      if (!meets(node.box)) continue;
      if (node.count == 0) {
        stack[top++] = node.second_child;
        stack[top++] = at + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (!take(items_[i])) return;
      }
    }
  }

 private:
  struct Node {
    Box3d box;
    std::uint32_t first = 0, count = 0;  // of items_, if it is an end
    std::uint32_t second_child = 0;      // the first follows its parent
  };
  void build(std::uint32_t first, std::uint32_t count, std::span<const Box3d> boxes, double slack);

  std::vector<std::uint32_t> items_;
  std::vector<Node> nodes_;
};

}  // namespace arris
