// Trees: hits against membership, cells against the whole tree, coincident faces, depth, determinism.
#include "csg/csg_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arris/error.h"
#include "support/csg_oracle.h"

namespace arris::test {
namespace {

CsgCells make_cells(const CsgTree& tree, const CellOptions& options = {}) {
  return {std::make_shared<const CsgSolid>(tree), tree.name, options};
}

std::vector<CsgBoundary> all_boundaries(const CsgSolid& solid, const Ray& ray) {
  BoundarySearch search;
  return search.find(solid, view_of(solid.root()), ray);
}

// Of every cell, put in order.
std::vector<CsgBoundary> cell_boundaries(const CsgCells& cells, const Ray& ray) {
  BoundarySearch search;
  std::vector<CsgBoundary> found;
  for (std::uint32_t i = 0; i < cells.cells().size(); ++i) {
    cells.visit_boundaries(i, ray, -INFINITY, INFINITY, search, [&](const CsgBoundary& b) {
      found.push_back(b);
      return false;
    });
  }
  std::ranges::sort(found, {}, &CsgBoundary::t);
  return found;
}

bool same(const CsgBoundary& a, const CsgBoundary& b) {
  return a.t == b.t && a.leaf == b.leaf && a.face == b.face && a.entering == b.entering;
}

Ray random_ray(CsgRandom& random) {
  const Vec3d origin = random_unit(random) * 4.0;
  return {origin, (random_vector(random, 1.5) - origin) * uniform(random, 0.2, 2)};
}

bool agrees(const CsgTree& tree, const std::vector<CsgBoundary>& found, const Ray& ray, double from,
            double to) {
  bool inside = tree_holds(tree, ray.origin + ray.direction * from);
  double last = from;
  for (std::size_t i = 0; i <= found.size(); ++i) {
    if (i < found.size() && found[i].t < from) continue;
    const double next = i < found.size() ? found[i].t : to;
    for (const double u : {0.001, 0.3, 0.77, 0.999}) {
      if (next - last < 1e-6) continue;
      if (tree_holds(tree, ray.origin + ray.direction * (last + u * (next - last))) != inside) {
        return false;
      }
    }
    inside = !inside;
    last = next;
  }
  return true;
}

TEST(csg_cells, hits_agree_with_membership_in_random_trees) {
  CsgRandom random(11);
  int wrong = 0, rays = 0, hits = 0;
  for (int i = 0; i < 60; ++i) {
    const CsgTree tree = random_tree(random, 4);
    const CsgCells cells = make_cells(tree);
    for (int k = 0; k < 40; ++k) {
      Ray ray = random_ray(random);
      double from = -0.1;
      if (k % 3 == 1) ray.origin = random_vector(random, 1.5);  // from inside or between
      if (k % 3 == 2) {                                         // from the surface
        const std::vector<CsgBoundary> first = cell_boundaries(cells, ray);
        if (first.empty()) continue;
        ray.origin = ray.origin + ray.direction * first[first.size() / 2].t;
        ray.direction = random_unit(random);
        from = 1e-7;
      }
      const std::vector<CsgBoundary> found = cell_boundaries(cells, ray);
      hits += found.empty() ? 0 : 1;
      wrong += agrees(tree, found, ray, from, 20 / length(ray.direction)) ? 0 : 1;
      ++rays;
    }
  }
  EXPECT_LE(wrong, rays / 1000);
  EXPECT_GT(hits, rays / 4);
}

TEST(csg_cells, cells_find_what_the_whole_tree_finds) {
  CsgRandom random(12);
  int different = 0, boundaries = 0;
  for (int i = 0; i < 200; ++i) {
    const CsgTree tree = random_tree(random, 2 + i % 4);
    const CsgCells cells = make_cells(tree);
    for (int k = 0; k < 50; ++k) {
      const Ray ray = random_ray(random);
      const std::vector<CsgBoundary> all = all_boundaries(cells.solid(), ray);
      different += std::ranges::equal(all, cell_boundaries(cells, ray), same) ? 0 : 1;
      boundaries += int(all.size());
    }
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(boundaries, 1000);
}

// Solids on a grid touch each other, and the grid is where cells are halved.
TEST(csg_cells, faces_on_the_cells_borders_are_met_once) {
  CsgRandom random(13);
  for (int i = 0; i < 40; ++i) {
    std::vector<CsgLeaf> leaves;
    for (int k = 0; k < 40; ++k) {
      const Vec3d at{double(random() % 4), double(random() % 4), double(random() % 4)};
      leaves.push_back({CsgBox{at, at + Vec3d(1)}, {}, {}});
    }
    const CsgTree tree = flat_tree(CsgOperation::unite, std::move(leaves));
    const CsgCells cells = make_cells(tree);
    for (int k = 0; k < 100; ++k) {
      Ray ray{{uniform(random, 0, 4), uniform(random, 0, 4), -1}, {0, 0, 1}};
      if (k % 2 == 0) ray.direction = random_vector(random, 0.5) + Vec3d(0, 0, 1);
      const std::vector<CsgBoundary> all = all_boundaries(cells.solid(), ray);
      ASSERT_TRUE(std::ranges::equal(all, cell_boundaries(cells, ray), same));
      ASSERT_TRUE(agrees(tree, all, ray, -1, 9));  // no inner walls
    }
  }
}

// A - A is empty, for every primitive wherever it is; a larger one without a smaller with a common face has one face.
TEST(csg_cells, coincident_faces_are_decided_once) {
  CsgRandom random(14);
  for (int i = 0; i < 300; ++i) {
    const CsgPrimitive primitive = random_primitive(random, i % 10);
    const Affine3d place = random_placement(random, 3);
    // As a file with six digits would have it.
    Affine3d rounded = place;
    if (i % 2 == 0 && i % 10 < 3) rounded.translation += Vec3d(3e-7, -3e-7, 2e-7);
    const CsgTree nothing =
        flat_tree(CsgOperation::subtract, {{primitive, place, {}}, {primitive, rounded, {}}});
    const CsgTree itself =
        flat_tree(CsgOperation::unite, {{primitive, place, {}}, {primitive, rounded, {}}});
    const CsgTree alone = one_leaf(primitive, place);
    const CsgSolid a(nothing), b(itself), c(alone);
    for (int k = 0; k < 30; ++k) {
      Ray ray = random_ray(random);
      ray.origin += place.translation;
      ASSERT_TRUE(all_boundaries(a, ray).empty()) << i;
      ASSERT_EQ(all_boundaries(b, ray).size(), all_boundaries(c, ray).size()) << i;
    }
  }
}

// Also in pieces of space: where boxes touch there is no wall, where one is taken from itself there is nothing.
TEST(csg_cells, coincident_faces_are_pruned) {
  const auto pruned = [](const CsgTree& tree, const Box3d& box) {
    const CsgSolid solid(tree);
    return solid.prune(solid.root(), make_cell(box)).value();
  };
  const CsgLeaf a{CsgBox{Vec3d(0), Vec3d(1)}, {}, {}};
  const CsgLeaf b{CsgBox{{1, 0, 0}, {2, 1, 1}}, {}, {}};
  const CsgLeaf rod{CsgCone{0, 1, 1, 1}, {}, {}}, longer{CsgCone{-1, 2, 1, 1}, {}, {}};
  const Box3d at_face{{0.9, 0.4, 0.4}, {1.1, 0.6, 0.6}}, at_rim{{0.9, 0, 0.4}, {1.1, 0.1, 0.6}};
  EXPECT_EQ(pruned(flat_tree(CsgOperation::unite, {a, b}), at_face), Cover::in);
  EXPECT_EQ(pruned(flat_tree(CsgOperation::intersect, {a, b}), at_face), Cover::out);
  EXPECT_EQ(pruned(flat_tree(CsgOperation::subtract, {a, a}), at_face), Cover::out);
  EXPECT_EQ(pruned(flat_tree(CsgOperation::subtract, {a, b}), at_face), Cover::on);
  EXPECT_EQ(pruned(flat_tree(CsgOperation::subtract, {rod, longer}), at_rim), Cover::out);
  EXPECT_EQ(pruned(flat_tree(CsgOperation::unite, {rod, longer}), at_rim), Cover::on);
}

TEST(csg_cells, different_primitives_share_their_faces) {
  // A cylinder, a prism, a mesh and a cone on a box: only the outline is left.
  const CsgRegion square{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}};
  CsgMesh cube;
  for (int i = 0; i < 8; ++i) {
    cube.vertices.push_back({double(i & 1), double((i >> 1) & 1), double(i >> 2)});
  }
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const CsgBox box{Vec3d(0), Vec3d(1)};
  const Affine3d turned{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {1, 0, 0}};
  const CsgPrism prism{square, 0, 1, {1, 1}};
  for (const CsgPrimitive& other : {CsgPrimitive(prism), CsgPrimitive(cube), CsgPrimitive(box)}) {
    const CsgSolid empty(flat_tree(CsgOperation::subtract, {{box, {}, {}}, {other, turned, {}}}));
    CsgRandom random(15);
    for (int k = 0; k < 300; ++k) {
      Ray ray = random_ray(random);
      ray.origin += Vec3d(0.5);
      ASSERT_TRUE(all_boundaries(empty, ray).empty());
    }
  }
  // A long cylinder without a short one of its radius, turned about the axis.
  const double c = std::cos(1.0), s = std::sin(1.0);
  const Affine3d spun{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {}};
  const CsgSolid ring(flat_tree(
      CsgOperation::subtract, {{CsgCone{0, 2, 1, 1}, {}, {}}, {CsgCone{0.5, 3, 1, 1}, spun, {}}}));
  EXPECT_TRUE(all_boundaries(ring, {{-5, 0.2, 1}, {1, 0, 0}}).empty());
  EXPECT_EQ(all_boundaries(ring, {{-5, 0.2, 0.3}, {1, 0, 0}}).size(), 2U);
}

TEST(csg_cells, a_thin_plate_keeps_its_thickness) {
  const CsgSolid solid(
      flat_tree(CsgOperation::unite, {{CsgBox{{0, 0, 0}, {1000, 1000, 1e-4}}, {}, {}},
                                      {CsgBox{{0, 0, 1e-4}, {1000, 1000, 2e-4}}, {}, {}}}));
  const auto found = all_boundaries(solid, {{500, 500, -1}, {0, 0, 1}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[1].t - found[0].t, 2e-4, 1e-12);
}

TEST(csg_cells, deep_chains_need_no_stack) {
  for (const CsgOperation operation : {CsgOperation::unite, CsgOperation::subtract}) {
    CsgTree tree;
    constexpr std::uint32_t kDepth = 20'000;
    // Node 2i is an operation on leaf node 2i + 1 and what follows; subtraction alternates.
    for (std::uint32_t i = 0; i < kDepth; ++i) {
      tree.nodes.push_back({CsgNode::kInner, operation, {2 * i + 1, 2 * i + 2}});
      tree.nodes.push_back({i, CsgOperation::unite, {}});
      tree.leaves.push_back({CsgSphere{0.4}, {{}, {double(i), 0, 0}}, {}});
    }
    tree.nodes.push_back({kDepth, CsgOperation::unite, {}});
    tree.leaves.push_back({CsgSphere{0.4}, {{}, {double(kDepth), 0, 0}}, {}});
    const CsgSolid solid(tree);
    const std::size_t expected = operation == CsgOperation::unite ? kDepth + 1 : 1;
    EXPECT_EQ(solid.root().depth() == 1, operation == CsgOperation::unite);
    const CsgCells cells = make_cells(tree);
    EXPECT_EQ(cell_boundaries(cells, {{-5, 0, 0}, {1, 0, 0}}).size(), 2 * expected);
  }
}

TEST(csg_cells, same_cells_at_any_number_of_threads) {
  CsgRandom random(16);
  const CsgTree tree = random_tree(random, 6);
  const CsgCells one = make_cells(tree, {.threads = 1}), all = make_cells(tree, {.threads = 4});
  ASSERT_EQ(one.cells().size(), all.cells().size());
  for (std::size_t i = 0; i < one.cells().size(); ++i) {
    EXPECT_EQ(one.cells()[i].bounds.low, all.cells()[i].bounds.low);
    EXPECT_EQ(one.cells()[i].truth, all.cells()[i].truth);
  }
}

TEST(csg_cells, holes_cost_no_more_cells_than_tiles) {
  std::vector<CsgLeaf> holes{{CsgBox{{0, 0, 0}, {20, 20, 1}}, {}, {}}}, tiles;
  for (int i = 0; i < 400; ++i) {
    const Affine3d at{{}, {0.5 + i % 20, 0.5 + double(i / 20), 0}};
    holes.push_back({CsgCone{-1, 2, 0.1, 0.1}, at, {}});
    tiles.push_back({CsgCone{-1, 2, 0.1, 0.1}, at, {}});
  }
  const CsgCells with_holes = make_cells(flat_tree(CsgOperation::subtract, holes));
  const CsgCells with_tiles = make_cells(flat_tree(CsgOperation::unite, tiles));
  EXPECT_LE(with_holes.cells().size(), 8 * with_tiles.cells().size());
  for (const CsgCell& cell : with_holes.cells()) EXPECT_LE(cell.leaf_count, 3U);
}

TEST(csg_cells, empty_operands) {
  const CsgLeaf ball{CsgSphere{1}, {}, {}}, nothing{CsgSphere{0}, {}, {}};
  const Ray ray{{-5, 0, 0}, {1, 0, 0}};
  const auto count = [&](const CsgTree& tree) {
    return all_boundaries(CsgSolid(tree), ray).size();
  };
  EXPECT_EQ(count(flat_tree(CsgOperation::subtract, {nothing, ball})), 0U);
  EXPECT_EQ(count(flat_tree(CsgOperation::subtract, {ball, nothing})), 2U);
  EXPECT_EQ(count(flat_tree(CsgOperation::intersect, {ball, nothing})), 0U);
  EXPECT_EQ(count(flat_tree(CsgOperation::unite, {nothing, ball})), 2U);
  for (const CsgOperation operation :
       {CsgOperation::unite, CsgOperation::intersect, CsgOperation::subtract}) {
    EXPECT_EQ(count(flat_tree(operation, {})), 0U);
    EXPECT_EQ(count(flat_tree(operation, {ball})), 2U);
  }
}

TEST(csg_cells, broken_and_endless_trees_are_errors) {
  EXPECT_THROW(make_cells(one_leaf(CsgHalfSpace{})), Error);
  CsgTree tree = one_leaf(CsgSphere{});
  tree.nodes[0].leaf = 7;
  EXPECT_THROW(CsgSolid{tree}, Error);
  tree.nodes[0] = {CsgNode::kInner, CsgOperation::unite, {3}};
  EXPECT_THROW(CsgSolid{tree}, Error);
  tree.nodes[0].children = {0};
  EXPECT_THROW(CsgSolid{tree}, Error);
}

}  // namespace
}  // namespace arris::test
