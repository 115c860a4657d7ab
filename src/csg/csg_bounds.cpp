#include "csg/csg_bounds.h"

#include <algorithm>
#include <optional>
#include <variant>
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

namespace {

// Of a primitive that has no others; nothing: it has a curved surface.
struct FlatFaces {
  using Count = std::optional<std::uint64_t>;

  Count operator()(const CsgBox&) const { return 6; }
  Count operator()(const CsgHalfSpace&) const { return 1; }
  Count operator()(const CsgPolyhedron& polyhedron) const { return polyhedron.faces.size(); }
  Count operator()(const CsgMesh& mesh) const { return mesh.triangles.size(); }
  Count operator()(const CsgPrism& prism) const {
    if (prism.scale_high.x != prism.scale_high.y) return std::nullopt;
    std::uint64_t faces = prism.scale_high.x > 0 ? 2 : 1;
    for (const std::vector<Vec2d>& outline : prism.region.outlines) faces += outline.size();
    return faces;
  }
  Count operator()(const CsgSphere&) const { return std::nullopt; }
  Count operator()(const CsgCone&) const { return std::nullopt; }
  Count operator()(const CsgTorus&) const { return std::nullopt; }
  Count operator()(const CsgRevolution&) const { return std::nullopt; }
  Count operator()(const CsgRounded&) const { return std::nullopt; }
};

void add_leaf(const CsgPrimitive& primitive, CsgCounts& counts) {
  const std::optional<std::uint64_t> faces = std::visit(FlatFaces{}, primitive);
  ++counts.primitives;
  counts.curved += faces ? 0 : 1;
  counts.flat_faces += faces.value_or(0);
}

}  // namespace

// Children have greater numbers than their parents: one pass down for what is used, one up for the depth.
CsgCounts count_csg(const CsgTree& tree) {
  CsgCounts counts;
  const std::size_t count = tree.nodes.size();
  std::vector<bool> used(count);
  if (count > 0) used[0] = true;
  for (std::size_t i = 0; i < count; ++i) {
    const CsgNode& node = tree.nodes[i];
    if (!used[i]) continue;
    if (node.leaf != CsgNode::kInner) {
      add_leaf(tree.leaves[node.leaf].primitive, counts);
    } else {
      ++counts.operations;
    }
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
