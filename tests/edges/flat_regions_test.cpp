#include "edges/flat_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "edges/inscribed_ball.h"
#include "geometry/shapes.h"
#include "support/convex_solids.h"

namespace arris {
namespace {

struct Analysed {
  WeldedMesh mesh;
  FlatRegions regions;
};

Analysed analyse(const Mesh& mesh, double min_angle = radians(30)) {
  Analysed a{make_welded_mesh({mesh.positions, mesh.triangles, mesh.sharp_edges}, mesh.name), {}};
  a.regions = make_flat_regions(a.mesh);
  if (!turn_inverted_shells(a.mesh, a.regions, min_angle).empty()) {
    a.regions = make_flat_regions(a.mesh);
  }
  return a;
}

std::size_t count_edges(const Analysed& a, EdgeKind kind, double min_angle = radians(30)) {
  std::size_t count = 0;
  for (std::uint32_t h = 0; h < a.mesh.twin.size(); ++h) {
    if (a.mesh.twin[h] <= kLastHalfEdge && a.mesh.twin[h] < h) continue;
    count += classify_edge(a.mesh, a.regions, h, min_angle) == kind ? 1 : 0;
  }
  return count;
}

Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TEST(FlatRegions, a_box_has_six_faces_and_twelve_convex_edges) {
  const Analysed a = analyse(make_box_mesh({1, 2, 3}));
  EXPECT_EQ(a.regions.planes.size(), 6U);
  EXPECT_EQ(count_edges(a, EdgeKind::convex), 12U);
  EXPECT_EQ(count_edges(a, EdgeKind::flat), 6U);
  for (const Plane& plane : a.regions.planes) EXPECT_GT(plane.d, 0.4);
}

TEST(FlatRegions, where_sharp_edges_are_named_no_angle_is_asked) {
  Mesh mesh = make_box_mesh({1, 2, 3});
  const auto find = [&](Vec3f p) {
    return std::uint32_t(std::ranges::find(mesh.positions, p) - mesh.positions.begin());
  };
  // Their numbers may be those of any vertex at the place, in any order, and twice.
  const VertexPair named{find({0.5F, 1, 1.5F}), find({0.5F, 1, -1.5F})};
  mesh.sharp_edges = {{named, {named[1], named[0]}}};
  for (const Mesh& one : {mesh, inside_out(mesh)}) {
    for (const double min_angle : {0.0, radians(30), radians(170)}) {
      const Analysed a = analyse(one, min_angle);
      EXPECT_EQ(count_edges(a, EdgeKind::convex, min_angle), 1U);
      EXPECT_EQ(count_edges(a, EdgeKind::smooth, min_angle), 11U);
      EXPECT_EQ(count_edges(a, EdgeKind::flat, min_angle), 6U);
    }
  }
  mesh.sharp_edges->clear();
  EXPECT_EQ(count_edges(analyse(mesh), EdgeKind::smooth), 12U);
}

TEST(FlatRegions, turn_is_the_angle_between_the_normals) {
  const Mesh mesh = make_dodecahedron_mesh(2);
  const Analysed a = analyse(mesh);
  EXPECT_EQ(a.regions.planes.size(), 12U);
  const double expected = kPi - std::acos(-1 / std::sqrt(5.0));
  for (std::uint32_t h = 0; h < a.mesh.twin.size(); ++h) {
    if (classify_edge(a.mesh, a.regions, h, radians(30)) == EdgeKind::flat) continue;
    EXPECT_NEAR(turn_at(a.mesh, a.regions, h), expected, 1e-6);
  }
}

TEST(FlatRegions, an_edge_of_just_the_minimum_angle_is_sharp) {
  // Twelve sides turn by 30 degrees each.
  const Analysed a = analyse(make_prism_mesh({1, 1, 2, 12}));
  EXPECT_EQ(count_edges(a, EdgeKind::convex), 12U + 24U);
  EXPECT_EQ(count_edges(a, EdgeKind::smooth), 0U);
  EXPECT_EQ(count_edges(a, EdgeKind::smooth, radians(30.1)), 12U);
}

TEST(FlatRegions, slivers_join_the_face_they_lie_in) {
  oracle::Random rng(7);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const oracle::Polyhedron& polyhedron : oracle::make_solids(seed)) {
      const oracle::SolidMesh mesh = oracle::make_mesh(polyhedron, oracle::random_style(rng), seed);
      WeldedMesh welded = make_welded_mesh(mesh.view(), mesh.name);
      EXPECT_EQ(make_flat_regions(welded).planes.size(), polyhedron.faces.size()) << mesh.name;
    }
  }
}

TEST(FlatRegions, a_closed_shell_inside_out_is_turned) {
  const Analysed a = analyse(inside_out(make_box_mesh({1, 1, 1})));
  EXPECT_TRUE(a.mesh.shells[0].turned);
  EXPECT_EQ(count_edges(a, EdgeKind::convex), 12U);
  for (std::uint32_t h = 0; h < a.mesh.twin.size(); ++h) {
    EXPECT_EQ(a.mesh.twin[a.mesh.twin[h]], h);
    EXPECT_EQ(a.mesh.origin(h), a.mesh.target(a.mesh.twin[h]));
  }
}

TEST(FlatRegions, a_hollow_in_another_solid_is_not_turned) {
  Mesh mesh = make_box_mesh({3, 3, 3});
  const Mesh hollow = inside_out(make_box_mesh({1, 1, 1}));
  const auto offset = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), hollow.positions.begin(), hollow.positions.end());
  for (const Triangle& t : hollow.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  const Analysed a = analyse(mesh);
  EXPECT_FALSE(is_cavity(a.mesh.shells[0]));
  EXPECT_TRUE(is_cavity(a.mesh.shells[1]));
  EXPECT_EQ(count_edges(a, EdgeKind::concave), 12U);
}

TEST(FlatRegions, an_open_room_seen_from_inside_is_turned) {
  Mesh room = inside_out(make_box_mesh({1, 1, 1}));
  room.triangles.resize(10);  // without its last wall
  const Analysed a = analyse(room);
  EXPECT_TRUE(a.mesh.shells[0].turned);
  EXPECT_EQ(count_edges(a, EdgeKind::convex), 8U);
}

TEST(InscribedBall, of_a_box_is_half_its_shortest_side) {
  const Analysed a = analyse(make_box_mesh({1, 2, 3}));
  const InscribedBall ball = largest_inscribed_ball(a.regions.planes, a.mesh.shells[0].size());
  EXPECT_NEAR(ball.radius, 0.5, 1e-9);
  for (const Plane& plane : a.regions.planes) {
    EXPECT_LE(dot(plane.normal, ball.center) + ball.radius, plane.d + 1e-9);
  }
}

TEST(InscribedBall, agrees_with_an_independent_solver_on_random_solids) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    oracle::Random rng(seed);
    for (const oracle::Polyhedron& polyhedron : oracle::make_solids(seed)) {
      const oracle::SolidMesh mesh = oracle::make_mesh(polyhedron, oracle::random_style(rng), seed);
      WeldedMesh welded = make_welded_mesh(mesh.view(), mesh.name);
      FlatRegions regions = make_flat_regions(welded);
      if (!turn_inverted_shells(welded, regions, 0).empty()) regions = make_flat_regions(welded);
      const double size = welded.shells[0].size();
      EXPECT_NEAR(largest_inscribed_ball(regions.planes, size).radius, oracle::inradius(mesh.solid),
                  1e-5 * size)
          << mesh.name;
    }
  }
}

}  // namespace
}  // namespace arris
