#include "edges/welded_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "arris/error.h"
#include "geometry/shapes.h"

namespace arris {
namespace {

WeldedMesh weld(const Mesh& mesh) {
  return make_welded_mesh({mesh.positions, mesh.triangles}, mesh.name);
}

Mesh moved(Mesh mesh, Vec3f by) {
  for (Vec3f& p : mesh.positions) p += by;
  return mesh;
}

Mesh joined(Mesh a, const Mesh& b) {
  const auto offset = std::uint32_t(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return a;
}

// Every triangle with corners of its own, as STL has them.
Mesh exploded(const Mesh& mesh) {
  Mesh out;
  for (const Triangle& t : mesh.triangles) {
    const auto first = std::uint32_t(out.positions.size());
    for (const std::uint32_t v : t) out.positions.push_back(mesh.positions[v]);
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

bool twins_agree(const WeldedMesh& mesh) {
  for (std::uint32_t h = 0; h < mesh.twin.size(); ++h) {
    const std::uint32_t twin = mesh.twin[h];
    if (twin > kLastHalfEdge) continue;
    if (mesh.twin[twin] != h || mesh.origin(h) != mesh.target(twin)) return false;
  }
  return true;
}

TEST(WeldedMesh, joins_corners_at_the_same_place) {
  const WeldedMesh mesh = weld(exploded(make_box_mesh({1, 2, 3})));
  EXPECT_EQ(mesh.vertices.size(), 8U);
  ASSERT_EQ(mesh.shells.size(), 1U);
  EXPECT_TRUE(mesh.shells[0].closed);
  EXPECT_NEAR(mesh.shells[0].volume, 6, 1e-6);
  EXPECT_TRUE(twins_agree(mesh));
}

TEST(WeldedMesh, joins_negative_and_positive_zero) {
  Mesh mesh = exploded(make_box_mesh({1, 1, 1}));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i].x += 0.5F;
    if (mesh.positions[i].x == 0 && i % 2 == 0) mesh.positions[i].x = -0.0F;
  }
  EXPECT_EQ(weld(mesh).vertices.size(), 8U);
}

// One mesh of two boxes that share a face: four triangles meet at each of its edges.
TEST(WeldedMesh, keeps_touching_solids_apart) {
  const Mesh box = make_box_mesh({1, 1, 1});
  const WeldedMesh mesh = weld(exploded(joined(box, moved(box, {1, 0, 0}))));
  ASSERT_EQ(mesh.shells.size(), 2U);
  for (const Shell& shell : mesh.shells) {
    EXPECT_TRUE(shell.closed);
    EXPECT_NEAR(shell.volume, 1, 1e-6);
    EXPECT_EQ(shell.triangle_count, 12U);
  }
  EXPECT_TRUE(twins_agree(mesh));
}

TEST(WeldedMesh, keeps_solids_apart_that_share_an_edge_only) {
  const Mesh box = make_box_mesh({1, 1, 1});
  const WeldedMesh mesh = weld(exploded(joined(box, moved(box, {1, 1, 0}))));
  ASSERT_EQ(mesh.shells.size(), 2U);
  EXPECT_NEAR(mesh.shells[0].volume, 1, 1e-6);
  EXPECT_NEAR(mesh.shells[1].volume, 1, 1e-6);
}

TEST(WeldedMesh, two_equal_faces_one_way_round_are_not_manifold) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.triangles.push_back(mesh.triangles.front());
  const WeldedMesh welded = weld(mesh);
  EXPECT_GT(std::ranges::count(welded.twin, kNonManifold), 0);
  EXPECT_TRUE(twins_agree(welded));
}

TEST(WeldedMesh, heals_t_junctions) {
  // One face of a box is cut in four triangles about the middle of one of its edges; the neighbour is not.
  Mesh mesh = make_box_mesh({1, 1, 1});
  Mesh cut;
  cut.positions = mesh.positions;
  const auto middle = std::uint32_t(cut.positions.size());
  const Triangle first = mesh.triangles[0];
  cut.positions.push_back((mesh.positions[first[0]] + mesh.positions[first[1]]) * 0.5F);
  cut.triangles = {{first[0], middle, first[2]}, {middle, first[1], first[2]}};
  cut.triangles.insert(cut.triangles.end(), mesh.triangles.begin() + 1, mesh.triangles.end());
  const WeldedMesh welded = weld(cut);
  EXPECT_EQ(welded.healed_junctions, 1U);
  ASSERT_EQ(welded.shells.size(), 1U);
  EXPECT_TRUE(welded.shells[0].closed);
  EXPECT_NEAR(welded.shells[0].volume, 1, 1e-6);
}

TEST(WeldedMesh, leaves_out_triangles_with_two_corners_in_one_place) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.triangles.push_back({0, 0, 1});
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.degenerate_triangles, 1U);
  EXPECT_EQ(welded.shell.back(), kNone);
  EXPECT_TRUE(welded.shells[0].closed);
}

// Their sides are told from no others by an angle: they are left out, and what they lay between meets.
TEST(WeldedMesh, leaves_out_triangles_whose_corners_lie_in_one_line) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  const auto middle = std::uint32_t(mesh.positions.size());
  const Triangle first = mesh.triangles[0];
  mesh.positions.push_back((mesh.positions[first[0]] + mesh.positions[first[1]]) * 0.5F);
  for (const bool is_twice : {true, false}) {
    Mesh more = mesh;
    more.triangles.push_back({first[0], middle, first[1]});
    if (is_twice) more.triangles.push_back({first[0], first[1], middle});
    const WeldedMesh welded = weld(more);
    EXPECT_EQ(welded.degenerate_triangles, is_twice ? 2U : 1U);
    ASSERT_EQ(welded.shells.size(), 1U);
    EXPECT_TRUE(welded.shells[0].closed);
    EXPECT_TRUE(twins_agree(welded));
  }
  // One that lies between a whole side and a side in two parts.
  Mesh cut = mesh;
  cut.triangles[0] = {first[0], middle, first[2]};
  cut.triangles.push_back({middle, first[1], first[2]});
  cut.triangles.push_back({first[0], first[1], middle});
  const WeldedMesh welded = weld(cut);
  EXPECT_EQ(welded.healed_junctions, 1U);
  ASSERT_EQ(welded.shells.size(), 1U);
  EXPECT_TRUE(welded.shells[0].closed);
}

TEST(WeldedMesh, says_which_index_is_out_of_range) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.triangles[7][1] = 99;
  mesh.name = "crate";
  try {
    weld(mesh);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("crate: triangle 7 uses vertex 99"), std::string::npos)
        << error.what();
  }
}

TEST(WeldedMesh, rejects_positions_that_are_not_finite) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(weld(mesh), Error);
}

TEST(WeldedMesh, rejects_sharp_edges_of_vertices_that_are_not_there) {
  const Mesh mesh = make_box_mesh({1, 1, 1});
  const auto count = std::uint32_t(mesh.positions.size());
  const std::vector<VertexPair> good{{0, count - 1}}, bad{{0, 1}, {count, 0}};
  EXPECT_NO_THROW(make_welded_mesh({mesh.positions, mesh.triangles, good}, "box"));
  EXPECT_THROW(make_welded_mesh({mesh.positions, mesh.triangles, bad}, "box"), Error);
}

}  // namespace
}  // namespace arris
