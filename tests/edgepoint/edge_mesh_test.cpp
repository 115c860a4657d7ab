// Edges of a mesh: which there are, and which of them a viewpoint sees as outline.
#include "edgepoint/edge_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "edgepoint/finder_meshes.h"

namespace arris {
namespace {

using test::edges_of;
using test::FinderRandom;

std::ptrdiff_t sharp_count(const EdgeMesh& mesh) {
  std::ptrdiff_t n = 0;
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) n += mesh.is_sharp(e) ? 1 : 0;
  return n;
}

TEST(EdgeMesh, lists_each_edge_once) {
  const EdgeMesh mesh = edges_of(make_box_mesh({1, 2, 3}));
  EXPECT_EQ(mesh.edges.size(), 18U);
  EXPECT_EQ(sharp_count(mesh), 12);
  EXPECT_TRUE(mesh.closed);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const std::uint32_t e : mesh.around(v)) {
      EXPECT_TRUE(mesh.edges[e].v0 == v || mesh.edges[e].v1 == v);
    }
  }
}

TEST(EdgeMesh, open_edges_are_sharp) {
  const EdgeMesh mesh = edges_of(make_plane_mesh({1, 1}));
  EXPECT_EQ(mesh.edges.size(), 5U);
  EXPECT_EQ(sharp_count(mesh), 4);
  EXPECT_FALSE(mesh.closed);
}

TEST(EdgeMesh, the_angle_decides_which_edges_are_sharp) {
  const Mesh ball = make_icosahedron_mesh(1);  // its faces turn by 41.8 degrees
  EXPECT_EQ(sharp_count(edges_of(ball, {.min_sharp_angle = radians(41), .is_marked = {}})), 30);
  EXPECT_EQ(sharp_count(edges_of(ball, {.min_sharp_angle = radians(42), .is_marked = {}})), 0);
}

TEST(EdgeMesh, marked_edges_are_sharp) {
  EdgeMeshOptions options;
  options.is_marked = [](std::uint32_t h, std::uint32_t twin) {
    return h / 3 == 0 || twin / 3 == 0;
  };
  EXPECT_EQ(sharp_count(edges_of(make_icosphere_mesh(1, 2), options)), 3);
}

TEST(EdgeMesh, tells_concave_edges) {
  const EdgeMesh torus = edges_of(test::make_torus_mesh(1, 0.4, 40, 20));
  int concave = 0;
  for (std::uint32_t e = 0; e < torus.edges.size(); ++e) concave += torus.is_concave(e) ? 1 : 0;
  EXPECT_GT(concave, 100);
  const EdgeMesh ball = edges_of(make_icosphere_mesh(1, 3));
  for (std::uint32_t e = 0; e < ball.edges.size(); ++e) EXPECT_FALSE(ball.is_concave(e));
}

// A triangle of no area between two others is seen through: what is left is the ball with other triangles.
TEST(EdgeMesh, looks_through_triangles_of_no_area) {
  FinderRandom random(3);
  const EdgeMesh mesh = edges_of(test::with_empty_triangles(make_icosphere_mesh(1, 2), random));
  EXPECT_TRUE(mesh.closed);
  EXPECT_EQ(sharp_count(mesh), 0);
  EXPECT_LT(mesh.edges.size(), mesh.triangles.size() * 3 / 2);
}

TEST(EdgeMesh, outlines_close) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    FinderRandom random(seed);
    for (const test::NamedMesh& m : test::make_finder_meshes(seed)) {
      const EdgeMesh mesh = edges_of(m.mesh);
      if (!mesh.closed) continue;
      for (int i = 0; i < 30; ++i) {
        const HomogeneousPoint from = test::random_viewpoint(mesh, random);
        std::vector<int> ends(mesh.vertices.size(), 0);
        for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
          if (!is_silhouette(mesh, e, from)) continue;
          ++ends[mesh.edges[e].v0];
          ++ends[mesh.edges[e].v1];
        }
        EXPECT_TRUE(std::ranges::all_of(ends, [](int n) { return n % 2 == 0; })) << m.name;
      }
    }
  }
}

TEST(EdgeMesh, silhouettes_move_with_affine_maps) {
  FinderRandom random(5);
  const Mesh ball = test::make_scan_like_mesh(3, 0.03, 1);
  // Exact in float: powers of two, a mirror and a swap of axes.
  const Affine3d map{{{0, 2, 0}, {-0.5, 0, 0}, {0, 0, 4}}, {}};
  const Affine3d mirror{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
  const EdgeMesh mesh = edges_of(ball);
  for (const Affine3d& m : {map, mirror}) {
    Mesh moved = ball;
    for (Vec3f& p : moved.positions) p = Vec3f(transform_point(m, Vec3d(p)));
    if (determinant(m.linear) < 0) {
      for (Triangle& t : moved.triangles) t = {t[0], t[2], t[1]};  // outward again
    }
    const EdgeMesh world = edges_of(moved);
    ASSERT_EQ(world.edges.size(), mesh.edges.size());
    for (int i = 0; i < 50; ++i) {
      const HomogeneousPoint from{test::random_point(random, 5), i % 2 == 0 ? 1.0 : 0.0};
      const HomogeneousPoint object = transform(inverse(m), from);
      int count = 0, world_count = 0;
      for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
        count += is_silhouette(mesh, e, object) ? 1 : 0;
        world_count += is_silhouette(world, e, from) ? 1 : 0;
      }
      EXPECT_EQ(count, world_count);
    }
  }
}

TEST(EdgeMesh, sharp_edges_show_from_their_front_only) {
  const EdgeMesh box = edges_of(make_box_mesh({1, 1, 1}));
  const HomogeneousPoint corner{{5, 6, 7}, 1}, front{{5, 0, 0}, 1};
  int from_corner = 0, from_front = 0;
  for (std::uint32_t e = 0; e < box.edges.size(); ++e) {
    from_corner += is_drawn(box, e, corner) ? 1 : 0;
    from_front += is_drawn(box, e, front) ? 1 : 0;
  }
  EXPECT_EQ(from_corner, 9);
  EXPECT_EQ(from_front, 4);
}

}  // namespace
}  // namespace arris
