// The tree finds the edges that looking at all of them finds.
#include "edgepoint/edge_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>
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

std::vector<std::uint32_t> find_drawn(const EdgeTree& tree, const DrawnQuery& query) {
  std::vector<std::uint32_t> edges, places;
  for (const EdgeShare& share : tree.shares()) {
    places.clear();
    tree.find_drawn(share, query, places);
    for (const std::uint32_t place : places) {
      const std::uint32_t e = tree.edges(share.group)[place];
      const EdgeEnds ends = tree.ends(share.group)[place];
      EXPECT_EQ(ends.a, tree.mesh().vertices[tree.mesh().edges[e].v0]);
      EXPECT_EQ(ends.b, tree.mesh().vertices[tree.mesh().edges[e].v1]);
      edges.push_back(e);
    }
  }
  return sorted(std::move(edges));
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
        ASSERT_EQ(find_drawn(tree, {from, false, {}}),
                  all_with(mesh, [&](std::uint32_t e) { return is_drawn(mesh, e, from); }))
            << m.name;
        ASSERT_EQ(
            find_drawn(tree, {from, true, {}}),
            all_with(mesh,
                     [&](std::uint32_t e) { return mesh.is_sharp(e) || is_drawn(mesh, e, from); }))
            << m.name;
      }
    }
  }
}

// What is left out lies outside of one of the half spaces; some of it is.
TEST(EdgeTree, leaves_out_only_what_is_outside) {
  FinderRandom random(3);
  std::size_t left_out = 0;
  for (const test::NamedMesh& m : test::make_finder_meshes(3)) {
    const EdgeMesh mesh = test::edges_of(m.mesh);
    const EdgeTree tree(mesh);
    const Vec3d middle = (mesh.bounds_min + mesh.bounds_max) * 0.5;
    for (int i = 0; i < 30; ++i) {
      const HomogeneousPoint from = test::random_viewpoint(mesh, random);
      const Vec3d d = test::random_point(random, 1), e = test::random_point(random, 1);
      const std::array<HalfSpace, 2> within{HalfSpace{d, -dot(d, middle)},
                                            HalfSpace{e, -dot(e, middle)}};
      const std::vector<std::uint32_t> all = find_drawn(tree, {from, false, {}});
      const std::vector<std::uint32_t> some = find_drawn(tree, {from, false, within});
      ASSERT_TRUE(std::ranges::includes(all, some));
      std::vector<std::uint32_t> rest;
      std::ranges::set_difference(all, some, std::back_inserter(rest));
      left_out += rest.size();
      for (const std::uint32_t edge : rest) {
        ASSERT_TRUE(std::ranges::any_of(within, [&](const HalfSpace& h) {
          const auto at = [&](std::uint32_t v) {
            return dot(h.direction, Vec3d(mesh.vertices[v])) + h.offset;
          };
          return at(mesh.edges[edge].v0) < 0 && at(mesh.edges[edge].v1) < 0;
        })) << m.name;
      }
    }
  }
  EXPECT_GT(left_out, 1000U);
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
  EXPECT_TRUE(tree.shares().empty());
}

}  // namespace
}  // namespace arris
