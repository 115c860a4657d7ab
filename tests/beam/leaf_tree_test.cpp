#include "beam/leaf_tree.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "csg/csg_solid.h"
#include "support/csg_oracle.h"

namespace arris::test {
namespace {

bool holds(const Box3d& box, Vec3d p) {
  return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x &&
         p.y <= box.high.y && p.z <= box.high.z;
}

// A union of small trees, some of them endless.
CsgTree many_trees(CsgRandom& random, int count) {
  CsgTree tree;
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  for (int i = 0; i < count; ++i) {
    const auto node = std::uint32_t(tree.nodes.size());
    tree.nodes[0].children.push_back(node);
    tree.nodes.push_back({CsgNode::kInner, CsgOperation(random() % 3), {node + 1, node + 2}});
    for (int k = 0; k < 2; ++k) {
      tree.nodes.push_back({std::uint32_t(tree.leaves.size()), CsgOperation::unite, {}});
      Affine3d place = random_placement(random, 4);
      for (Vec3d* column : {&place.linear.x, &place.linear.y, &place.linear.z}) {
        *column = *column * 0.3;
      }
      const int kind = random() % 40 == 0 ? 10 : int(random() % 3);
      tree.leaves.push_back({random_primitive(random, kind), place, {}});
    }
  }
  return tree;
}

TEST(LeafTree, keeps_what_matters_at_a_place) {
  CsgRandom random(5);
  std::size_t kept = 0, all = 0, inside = 0;
  for (const int count : {3, 31, 32, 33, 400}) {
    const CsgSolid solid(many_trees(random, count));
    std::vector<Box3d> boxes;
    for (std::uint32_t i = 0; i < solid.leaf_count(); ++i) boxes.push_back(solid.leaf(i).bounds);
    const LeafTree tree(solid.root(), boxes);
    for (int k = 0; k < 300; ++k) {
      const Vec3d p = random_vector(random, 5);
      const CsgExpression near = tree.near([&](const Box3d& box) { return holds(box, p); });
      ASSERT_EQ(solid.contains(near, p), solid.contains(solid.root(), p)) << count;
      inside += solid.contains(near, p) ? 1 : 0;
      if (count < 400) continue;
      kept += near.leaves().size();
      all += solid.root().leaves().size();
    }
  }
  EXPECT_GT(inside, 100U);
  EXPECT_LT(kept, all / 10);
}

}  // namespace
}  // namespace arris::test
