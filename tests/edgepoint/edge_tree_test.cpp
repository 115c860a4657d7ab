// The tree finds the edges that looking at all of them finds.
#include "edgepoint/edge_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "edgepoint/finder_meshes.h"

namespace arris {
namespace {

using test::FinderRandom;
using test::uniform;

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> edges) {
  std::ranges::sort(edges);
  return edges;
}

template <class Predicate>
std::vector<std::uint32_t> all_with(const EdgeMesh& mesh, const Predicate& holds) {
  std::vector<std::uint32_t> edges;
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    if (holds(e)) edges.push_back(e);
  }
  return edges;
}

TEST(EdgeTree, agrees_with_brute_force) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    FinderRandom random(seed);
    for (const test::NamedMesh& m : test::make_finder_meshes(seed)) {
      EdgeMeshOptions options;
      options.min_sharp_angle = seed % 2 == 0 ? radians(85) : radians(20);
      const EdgeMesh mesh = test::edges_of(m.mesh, options);
      const EdgeTree tree(mesh);
      for (int i = 0; i < 60; ++i) {
        const HomogeneousPoint from = test::random_viewpoint(mesh, random);
        ASSERT_EQ(sorted(tree.find_silhouettes(from)),
                  all_with(mesh, [&](std::uint32_t e) { return is_silhouette(mesh, e, from); }))
            << m.name;
        ASSERT_EQ(sorted(tree.find_drawn(from)),
                  all_with(mesh, [&](std::uint32_t e) { return is_drawn(mesh, e, from); }))
            << m.name;
      }
    }
  }
}

TEST(EdgeTree, agrees_with_brute_force_for_area_lights) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    FinderRandom random(seed);
    for (const test::NamedMesh& m : test::make_finder_meshes(seed)) {
      const EdgeMesh mesh = test::edges_of(m.mesh);
      const EdgeTree tree(mesh);
      for (int i = 0; i < 30; ++i) {
        const Vec3d at = test::random_viewpoint(mesh, random).xyz;
        const double size = uniform(random, 0, 1);
        const Vec3d u = test::random_point(random, size), v = test::random_point(random, size);
        const std::array<HomogeneousPoint, 4> light{HomogeneousPoint{at}, HomogeneousPoint{at + u},
                                                    HomogeneousPoint{at + u + v},
                                                    HomogeneousPoint{at + v}};
        ASSERT_EQ(
            sorted(tree.find_possible_silhouettes(light)),
            all_with(mesh, [&](std::uint32_t e) { return may_be_silhouette(mesh, e, light); }))
            << m.name;
      }
    }
  }
}

// Every point of the light sees nothing but what was found.
TEST(EdgeTree, finds_what_any_point_of_an_area_light_sees) {
  FinderRandom random(7);
  const EdgeMesh mesh = test::edges_of(test::make_scan_like_mesh(3, 0.03, 1));
  const EdgeTree tree(mesh);
  for (int i = 0; i < 30; ++i) {
    const Vec3d at = test::random_point(random, 3), u = test::random_point(random, 1),
                v = test::random_point(random, 1);
    const std::array<HomogeneousPoint, 4> light{HomogeneousPoint{at}, HomogeneousPoint{at + u},
                                                HomogeneousPoint{at + u + v},
                                                HomogeneousPoint{at + v}};
    const std::vector<std::uint32_t> possible = sorted(tree.find_possible_silhouettes(light));
    for (int k = 0; k < 20; ++k) {
      const HomogeneousPoint from{at + u * uniform(random, 0, 1) + v * uniform(random, 0, 1)};
      const std::vector<std::uint32_t> seen = sorted(tree.find_silhouettes(from));
      EXPECT_TRUE(std::ranges::includes(possible, seen));
    }
  }
}

TEST(EdgeTree, visits_little_of_a_smooth_mesh) {
  const EdgeMesh mesh = test::edges_of(make_icosphere_mesh(1, 6));
  const EdgeTree tree(mesh);
  const std::vector<std::uint32_t> found = tree.find_silhouettes({{3, 1, 2}, 1});
  EXPECT_GT(found.size(), 200U);
  EXPECT_LT(found.size(), 2000U);
}

TEST(EdgeTree, has_no_edges_without_triangles) {
  const EdgeMesh mesh = test::edges_of(Mesh{});
  const EdgeTree tree(mesh);
  EXPECT_TRUE(tree.find_drawn({{1, 2, 3}, 1}).empty());
}

}  // namespace
}  // namespace arris
