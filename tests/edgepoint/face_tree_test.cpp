// Boxes of triangles.
#include "edgepoint/face_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "edgepoint/finder_meshes.h"

namespace arris {
namespace {

// All faces below a box lie in it.
void expect_holds(const FaceTree& tree, std::uint32_t first, std::uint32_t count, Vec3d low,
                  Vec3d high, std::vector<int>& seen) {
  if (count == 0) {
    const FaceNode& node = tree.nodes()[first];
    for (std::size_t i = 0; i < 4; ++i) {
      if (node.reach[0][i] < 0) continue;
      const Vec3d middle{node.middle[0][i], node.middle[1][i], node.middle[2][i]};
      const Vec3d reach{node.reach[0][i], node.reach[1][i], node.reach[2][i]};
      expect_holds(tree, node.first[i], node.count[i], max(low, middle - reach),
                   min(high, middle + reach), seen);
    }
    return;
  }
  for (std::uint32_t i = first; i < first + count; ++i) {
    const std::uint32_t face = tree.faces()[i];
    ++seen[face];
    for (const std::uint32_t v : tree.mesh().triangles[face]) {
      const Vec3d p = tree.frame().unit_from_object(Vec3d(tree.mesh().vertices[v]));
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(p[k], low[k] - 2e-7);
        ASSERT_LE(p[k], high[k] + 2e-7);
      }
    }
  }
}

TEST(FaceTree, holds_every_face_once) {
  for (const test::NamedMesh& m : test::make_finder_meshes(1)) {
    const EdgeMesh mesh = test::edges_of(m.mesh);
    const FaceTree tree(mesh);
    std::vector<int> seen(mesh.triangles.size(), 0);
    expect_holds(tree, 0, 0, Vec3d(-2), Vec3d(2), seen);
    for (std::uint32_t t = 0; t < seen.size(); ++t) {
      ASSERT_EQ(seen[t], face_normal(mesh, t) == Vec3d() ? 0 : 1) << m.name;
    }
  }
}

TEST(FaceTree, of_nothing_has_no_nodes) {
  const EdgeMesh mesh = test::edges_of(Mesh{});
  EXPECT_TRUE(FaceTree(mesh).nodes().empty());
}

}  // namespace
}  // namespace arris
