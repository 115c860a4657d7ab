// Leaves of the three kinds: what they are made of, and that together they are the solid.
#include "beam/beam_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "support/csg_oracle.h"

namespace arris::test {
namespace {

std::vector<MeshTriangle> triangles_of(const CsgMesh& mesh) {
  std::vector<MeshTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]},
                         std::uint32_t(10 + triangles.size())});
  }
  return triangles;
}

// Barycentric coordinates of where the line meets the plane, and the depth; nothing: it runs along it.
struct PlanePoint {
  double t, u, v;
  [[nodiscard]] double margin() const { return std::min({u, v, 1 - u - v}); }
};
PlanePoint meet_plane(const std::array<Vec3d, 3>& corners, const Ray& ray) {
  const Mat3d m{corners[1] - corners[0], corners[2] - corners[0], -ray.direction};
  const Vec3d solution = inverse(m) * (ray.origin - corners[0]);
  return {solution.z, solution.x, solution.y};
}

TEST(beam_shape, facets_keep_corners_and_share_edges) {
  CsgRandom random(1);
  const CsgMesh mesh = random_mesh(random);
  std::vector<MeshTriangle> triangles = triangles_of(mesh);
  const Vec3d a = mesh.vertices[0], b = mesh.vertices[1];
  triangles.push_back({{a, b, b}, 99});  // without area
  const BeamShape shape(triangles);
  EXPECT_EQ(shape.facet_count(), 12U);
  EXPECT_EQ(shape.leaf_count(), 12U);
  EXPECT_EQ(shape.edges().size(), 18U);  // Euler: 8 + 12 - 2
  std::vector<std::array<int, 2>> uses(shape.edges().size());
  for (std::uint32_t leaf = 0; leaf < 12; ++leaf) {
    const Facet* facet = shape.facet(leaf);
    ASSERT_NE(facet, nullptr);
    EXPECT_EQ(shape.convex(leaf), nullptr);
    EXPECT_EQ(shape.volume(leaf), nullptr);
    EXPECT_TRUE(shape.is_flat(leaf, 0));
    EXPECT_EQ(facet->triangle, 10 + leaf);
    const auto& corners = triangles[leaf].corners;
    const CsgPlane& plane = shape.planes()[facet->plane.plane];
    const Vec3d turn = cross(corners[1] - corners[0], corners[2] - corners[0]);
    EXPECT_NEAR(dot(plane.normal, turn), length(turn), 1e-12);
    EXPECT_FALSE(facet->plane.flipped);
    const Box3d& box = shape.leaf_box(leaf);
    for (std::size_t k = 0; k < 3; ++k) {
      const BeamShape::Edge& edge = shape.edges()[facet->edges[k]];
      ++uses[facet->edges[k]][facet->turned[k] ? 1 : 0];
      EXPECT_EQ(facet->turned[k] ? edge.b : edge.a, corners[k]);
      EXPECT_EQ(facet->turned[k] ? edge.a : edge.b, corners[(k + 1) % 3]);
      EXPECT_NEAR(dot(plane.normal, corners[k]), plane.d, 1e-12);
      EXPECT_FALSE(intersection(box, {corners[k], corners[k]}).is_empty());
      EXPECT_FALSE(intersection(shape.bounds(), {corners[k], corners[k]}).is_empty());
    }
  }
  // Of a closed mesh, each edge is run along once in either direction.
  for (const auto& both_ways : uses) EXPECT_EQ(both_ways, (std::array<int, 2>{1, 1}));
}

TEST(beam_shape, facets_are_met_where_their_triangles_are) {
  CsgRandom random(2);
  int met = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::array<Vec3d, 3> corners{random_vector(random, 1), random_vector(random, 1),
                                       random_vector(random, 1)};
    const BeamShape shape(std::vector<MeshTriangle>{{corners, 0}});
    const Vec3d origin = random_vector(random, 2);
    const Ray ray{origin, (random_vector(random, 1) - origin) * uniform(random, 0.2, 2)};
    const PlanePoint truth = meet_plane(corners, ray);
    if (std::abs(truth.margin()) < 1e-9 || std::abs(truth.t) < 1e-9) continue;
    const std::optional<double> t = shape.meet(*shape.facet(0), ray);
    ASSERT_EQ(t.has_value(), truth.margin() > 0 && truth.t > 0) << i;
    ASSERT_NEAR(t.value_or(truth.t), truth.t, 1e-9 * (1 + std::abs(truth.t))) << i;
    ++(t ? met : missed);
  }
  EXPECT_GT(met, 200);
  EXPECT_GT(missed, 2000);
}

// The nearest double to a point on an edge is on neither side for sure: but on one of both it is.
TEST(beam_shape, no_ray_passes_between_facets_that_share_an_edge) {
  CsgRandom random(3);
  for (int i = 0; i < 100; ++i) {
    const CsgMesh mesh = random_mesh(random);
    const BeamShape shape(triangles_of(mesh));
    const Vec3d origin = random_vector(random, 0.1);  // inside
    for (const BeamShape::Edge& edge : shape.edges()) {
      const double u = uniform(random, 0.05, 0.95);
      const Ray ray{origin, edge.a * (1 - u) + edge.b * u - origin};
      bool met = false;
      for (std::uint32_t leaf = 0; leaf < shape.leaf_count(); ++leaf) {
        met = met || shape.meet(*shape.facet(leaf), ray).has_value();
      }
      ASSERT_TRUE(met) << i;
    }
  }
}

// As an eye sees it, a facet stands for what is behind it: points are in the solid where the expression says so.
TEST(beam_shape, meshes_in_trees_hold_the_same_points_as_any_eye_sees_them) {
  CsgRandom random(4);
  int inside = 0, eyes_inside = 0, volumes = 0, points = 0;
  for (int i = 0; i < 150; ++i) {
    CsgTree tree = random_tree(random, 1 + i % 2);
    for (CsgLeaf& leaf : tree.leaves) {
      if (random() % 2 == 0 && &leaf != tree.leaves.data()) leaf.primitive = random_mesh(random);
    }
    const BeamShape shape(tree);
    const std::vector<std::uint32_t>& leaves = shape.root().leaves();
    for (int k = 0; k < 40; ++k) {
      const Vec3d eye = random_vector(random, k % 2 == 0 ? 0.8 : 3);
      const Vec3d p = random_vector(random, 1.2);
      const bool in = shape.root().eval([&](std::uint32_t slot) {
        const std::uint32_t leaf = leaves[slot];
        if (const Facet* facet = shape.facet(leaf)) {
          const std::optional<double> t = shape.meet(*facet, {eye, p - eye});
          return t && *t < 1;
        }
        if (const ClosedMesh* volume = shape.volume(leaf)) {
          ++volumes;
          const bool starts = volume->contains(eye);
          eyes_inside += starts ? 1 : 0;
          return starts;
        }
        const CsgSolid& csg = shape.csg();
        return contains(csg.leaf(leaf), csg.surfaces(), p);
      });
      ASSERT_EQ(in, tree_holds(tree, p)) << i << ", " << k;
      inside += in ? 1 : 0;
      ++points;
    }
  }
  EXPECT_GT(inside, points / 10);
  EXPECT_GT(eyes_inside, volumes / 10);
  EXPECT_LT(eyes_inside, volumes / 2);
}

TEST(beam_shape, leaves_are_of_one_kind_each_and_facets_name_their_meshes) {
  CsgRandom random(5);
  const CsgTree tree = flat_tree(CsgOperation::unite, {{random_mesh(random), {}, {}},
                                                       {CsgTorus{0.6, 0.2}, {}, {}},
                                                       {CsgCone{-1, 1, 0.5, 0.2}, {}, {}},
                                                       {random_mesh(random), {{}, {1, 0, 0}}, {}}});
  const BeamShape shape(tree);
  const std::size_t solids = shape.csg().leaf_count();
  EXPECT_EQ(shape.facet_count(), 24U);
  EXPECT_EQ(shape.leaf_count(), solids + 26);
  std::set<std::uint32_t> numbers;
  std::multiset<std::uint32_t> sources;
  for (std::uint32_t leaf = 0; leaf < shape.leaf_count(); ++leaf) {
    const bool is_csg = leaf < solids;
    const bool is_volume = leaf >= solids + 24;
    EXPECT_EQ(shape.facet(leaf) != nullptr, !is_csg && !is_volume) << leaf;
    EXPECT_EQ(shape.volume(leaf) != nullptr, is_volume) << leaf;
    EXPECT_EQ(shape.convex(leaf) != nullptr || shape.is_whole(leaf), is_csg) << leaf;
    EXPECT_TRUE(!is_volume || std::isinf(shape.leaf_box(leaf).high.x));
    if (const Facet* facet = shape.facet(leaf)) {
      numbers.insert(facet->triangle);
      sources.insert(facet->source);
      const MeshLeaf& mesh = std::get<MeshLeaf>(shape.csg().leaf(facet->source).shape);
      const auto corner = [&](std::size_t k) {
        return mesh.mesh.vertices()[mesh.mesh.triangles()[facet->triangle][k]];
      };
      for (std::size_t k = 0; k < 3; ++k) {
        const BeamShape::Edge& edge = shape.edges()[facet->edges[k]];
        EXPECT_EQ(facet->turned[k] ? edge.b : edge.a, corner(k)) << leaf;
      }
    }
  }
  EXPECT_EQ(numbers.size(), 12U);
  EXPECT_EQ(sources.size(), 24U);
  EXPECT_EQ(sources.count(*sources.begin()), 12U);
  const auto leaf_of = [&](const auto& is_wanted) {
    std::uint32_t leaf = 0;
    while (!is_wanted(leaf)) ++leaf;
    return leaf;
  };
  const std::uint32_t cone = leaf_of([&](std::uint32_t i) { return shape.convex(i) != nullptr; });
  EXPECT_TRUE(shape.is_flat(cone, 0));
  EXPECT_FALSE(shape.is_flat(cone, std::uint32_t(shape.convex(cone)->planes.size())));
  const std::uint32_t torus =
      leaf_of([&](std::uint32_t i) { return shape.leaf_box(i).high.z < 0.3; });
  EXPECT_TRUE(shape.is_whole(torus));
  EXPECT_FALSE(shape.is_flat(torus, 0));
}

}  // namespace
}  // namespace arris::test
