// What single rays see as beams describe solids, against the boundaries of the solids as they are described.
#include "beam/ray_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

struct First {
  double depth = 0;
  bool entering = true;
};

// Of the tree by itself: no leaf is cut, meshes are solids.
std::optional<First> find_first(const CsgSolid& solid, const Ray& ray) {
  BoundarySearch search;
  for (const CsgBoundary& b : search.find(solid, view_of(solid.root()), ray)) {
    if (b.t > 0 && std::isfinite(b.t)) return First{b.t, b.entering};
  }
  return std::nullopt;
}

Ray random_ray(CsgRandom& random, bool among) {
  const Vec3d origin = among ? random_vector(random, 1.2) : random_unit(random) * 4.0;
  return {origin, (random_vector(random, 1) - origin) * uniform(random, 0.2, 2)};
}

struct Tally {
  int rays = 0, hits = 0, leaving = 0, wrong = 0;
};

void compare(const std::optional<First>& truth, const std::optional<RaySight>& sight,
             Tally& tally) {
  ++tally.rays;
  const bool agrees =
      truth.has_value() == sight.has_value() &&
      (!truth || (std::abs(truth->depth - sight->depth) <= 1e-6 * (1 + truth->depth) &&
                  truth->entering == sight->seen.entering));
  tally.wrong += agrees ? 0 : 1;
  tally.hits += truth ? 1 : 0;
  tally.leaving += truth && !truth->entering ? 1 : 0;
}

TEST(ray_sight, sees_the_first_boundary_of_the_tree_as_it_is_described) {
  CsgRandom random(1);
  Tally tally;
  for (int i = 0; i < 120; ++i) {
    CsgTree tree = random_tree(random, 1 + i % 3);
    // Meshes in booleans, in every other tree.
    for (std::size_t k = 1; i % 2 == 0 && k < tree.leaves.size(); k += 2) {
      tree.leaves[k].primitive = random_mesh(random);
    }
    const CsgSolid solid(tree);
    const BeamShape shape(tree);
    const Affine3d object_from_world = inverse(random_placement(random, 1));
    const std::vector<BeamSolid> placed{{&shape, object_from_world}};
    for (int k = 0; k < 100; ++k) {
      const Ray own = random_ray(random, k % 2 == 0);
      const Affine3d world_from_object = inverse(object_from_world);
      const Ray world{transform_point(world_from_object, own.origin),
                      transform_vector(world_from_object, own.direction)};
      compare(find_first(solid, own), see(placed, {{0, shape.root()}}, world), tally);
    }
  }
  EXPECT_LE(tally.wrong, tally.rays / 1000);
  EXPECT_GT(tally.hits, tally.rays / 3);
  EXPECT_GT(tally.leaving, tally.rays / 20);
}

TEST(ray_sight, sees_the_nearest_of_several_solids) {
  CsgRandom random(2);
  Tally tally;
  int by_solid[3] = {};
  for (int i = 0; i < 40; ++i) {
    BeamScene scene;
    std::vector<CsgSolid> solids;
    std::vector<BeamPart> parts;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const CsgTree tree = random_tree(random, 1);
      solids.emplace_back(tree);
      scene.add(tree, random_placement(random, 1));
      parts.push_back({k, scene.placed[k].shape->root()});
    }
    for (int k = 0; k < 60; ++k) {
      const Ray ray = random_ray(random, k % 4 == 0);
      std::optional<First> truth;
      std::uint32_t nearest = 0;
      for (std::uint32_t s = 0; s < 3; ++s) {
        const Affine3d& m = scene.placed[s].object_from_world;
        const auto first = find_first(
            solids[s], {transform_point(m, ray.origin), transform_vector(m, ray.direction)});
        if (!first || (truth && truth->depth < first->depth)) continue;
        truth = first;
        nearest = s;
      }
      const std::optional<RaySight> sight = see(scene.placed, parts, ray);
      compare(truth, sight, tally);
      if (!truth || !sight) continue;
      tally.wrong += sight->seen.solid == nearest ? 0 : 1;
      ++by_solid[nearest];
    }
  }
  EXPECT_LE(tally.wrong, tally.rays / 1000);
  for (const int times : by_solid) EXPECT_GT(times, 100);
}

// Leaf and face: the point is on that face of that leaf, and on no other leaf's.
TEST(ray_sight, names_the_face_on_which_the_point_is) {
  CsgRandom random(3);
  int flat = 0, curved = 0, facets = 0;
  for (int i = 0; i < 60; ++i) {
    CsgTree tree = random_convex_tree(random, 1 + i % 2);
    if (i % 3 == 0) tree.leaves.back().primitive = random_mesh(random);
    const BeamShape shape(tree);
    const std::vector<BeamSolid> placed{{&shape, {}}};
    for (int k = 0; k < 60; ++k) {
      const Ray ray = random_ray(random, k % 3 == 0);
      const std::optional<RaySight> sight = see(placed, {{0, shape.root()}}, ray);
      if (!sight) continue;
      const Vec3d p = ray.origin + ray.direction * sight->depth;
      const std::uint32_t leaf = sight->seen.leaf, face = sight->seen.face;
      if (const Facet* facet = shape.facet(leaf)) {
        const CsgPlane& plane = shape.planes()[facet->plane.plane];
        EXPECT_NEAR(dot(plane.normal, p), plane.d, 1e-9);
        EXPECT_TRUE(shape.meet(*facet, ray).has_value());
        ++facets;
        continue;
      }
      const ConvexLeaf& convex = *shape.convex(leaf);
      if (face < convex.planes.size()) {
        const CsgPlane& plane = shape.planes()[convex.planes[face].plane];
        EXPECT_NEAR(dot(plane.normal, p), plane.d, 1e-9);
        ++flat;
      } else {
        EXPECT_EQ(face, convex.planes.size());
        EXPECT_NEAR(shape.csg().surfaces().value_of(*convex.quadric, p), 0, 1e-7);
        ++curved;
      }
    }
  }
  EXPECT_GT(flat, 400);
  EXPECT_GT(curved, 200);
  EXPECT_GT(facets, 100);
}

// Faces that coincide are crossed at once: nothing is seen between them.
TEST(ray_sight, sees_nothing_between_faces_that_coincide) {
  const CsgLeaf left{CsgBox{{-1, -1, -1}, {0, 1, 1}}, {}, {}};
  const CsgLeaf right{CsgBox{{0, -1, -1}, {1, 1, 1}}, {}, {}};
  const Ray ray{{-0.5, 0.1, 0.2}, {2, 0, 0}};
  const BeamShape both(flat_tree(CsgOperation::unite, {left, right}));
  const auto sight = see(std::vector<BeamSolid>{{&both, {}}}, {{0, both.root()}}, ray);
  ASSERT_TRUE(sight.has_value());
  EXPECT_DOUBLE_EQ(sight->depth, 0.75);
  EXPECT_FALSE(sight->seen.entering);
  const BeamShape none(flat_tree(CsgOperation::subtract, {left, left}));
  EXPECT_FALSE(see(std::vector<BeamSolid>{{&none, {}}}, {{0, none.root()}}, ray).has_value());
}

// A mesh's face against a box's: one plane, which the mesh sees from its back.
TEST(ray_sight, sees_meshes_of_which_a_face_lies_on_another_leafs) {
  CsgRandom random(4);
  CsgMesh cube = random_mesh(random);
  for (int i = 0; i < 8; ++i) {
    cube.vertices[std::size_t(i)] = {i & 1 ? 1.0 : 0.0, i & 2 ? 0.7 : -0.7, i & 4 ? 0.7 : -0.7};
  }
  const CsgLeaf box{CsgBox{{-1, -0.4, -0.4}, {0, 0.4, 0.4}}, {}, {}};
  const CsgTree tree = flat_tree(CsgOperation::unite, {box, {cube, {}, {}}});
  const CsgSolid solid(tree);
  const BeamShape shape(tree);
  const std::vector<BeamSolid> placed{{&shape, {}}};
  int flipped = 0;
  for (const std::uint32_t leaf : shape.root().leaves()) {
    flipped += shape.facet(leaf) != nullptr && shape.facet(leaf)->plane.flipped ? 1 : 0;
  }
  EXPECT_EQ(flipped, 2);
  Tally tally;
  for (int k = 0; k < 3000; ++k) {
    const Ray ray = random_ray(random, k % 2 == 0);
    compare(find_first(solid, ray), see(placed, {{0, shape.root()}}, ray), tally);
  }
  EXPECT_LE(tally.wrong, tally.rays / 1000);
  EXPECT_GT(tally.hits, tally.rays / 3);
}

}  // namespace
}  // namespace arris::test
