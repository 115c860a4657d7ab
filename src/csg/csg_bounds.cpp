#include "csg/csg_bounds.h"

#include <algorithm>
#include <vector>

#include "csg/csg_expression.h"
#include "csg/csg_leaf.h"

namespace arris {

Box3d csg_bounds(const CsgTree& tree) {
  std::vector<Box3d> boxes;
  std::vector<bool> exists;
  for (const CsgLeaf& leaf : tree.leaves) {
    boxes.push_back(extent_of(leaf));
    exists.push_back(!boxes.back().is_empty());
  }
  const CsgExpression expression(tree, exists);
  std::vector<Box3d> used;
  for (const std::uint32_t leaf : expression.leaves()) used.push_back(boxes[leaf]);
  return expression.bounds(used);
}

// Children have greater numbers than their parents: one pass down for what is used, one up for the depth.
CsgCounts count_csg(const CsgTree& tree) {
  CsgCounts counts;
  const std::size_t count = tree.nodes.size();
  std::vector<bool> used(count);
  if (count > 0) used[0] = true;
  for (std::size_t i = 0; i < count; ++i) {
    const CsgNode& node = tree.nodes[i];
    if (!used[i]) continue;
    (node.leaf != CsgNode::kInner ? counts.primitives : counts.operations) += 1;
    for (const std::uint32_t child : node.children) {
      if (child < count) used[child] = true;
    }
  }
  std::vector<std::uint64_t> depth(count);
  for (std::size_t i = count; i-- > 0;) {
    if (tree.nodes[i].leaf != CsgNode::kInner) continue;
    for (const std::uint32_t child : tree.nodes[i].children) {
      if (child < count) depth[i] = std::max(depth[i], depth[child]);
    }
    ++depth[i];
  }
  if (count > 0) counts.depth = depth[0];
  return counts;
}

}  // namespace arris
