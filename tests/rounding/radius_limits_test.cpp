#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "arris/io.h"
#include "arris/rounding.h"
#include "support/creased_solids.h"
#include "support/mesh_checks.h"
#include "support/render_scenes.h"

namespace arris {
namespace {

RadiusLimits limits_of(const Mesh& mesh) {
  return find_radius_limits({mesh.positions, mesh.triangles}, radians(30), mesh.name);
}

void add_quad(Mesh& mesh, std::array<std::uint32_t, 4> q) {
  mesh.triangles.push_back({q[0], q[1], q[2]});
  mesh.triangles.push_back({q[0], q[2], q[3]});
}

// A tube of outer radius 1, inner radius 0.7 and height 0.6: its wall is 0.3 thick.
Mesh make_tube(std::uint32_t facets) {
  Mesh mesh;
  for (const auto& [radius, z] : {std::pair(1.0, 0.0), {1.0, 0.6}, {0.7, 0.0}, {0.7, 0.6}}) {
    for (std::uint32_t i = 0; i < facets; ++i) {
      const double a = 2 * kPi * i / facets;
      mesh.positions.push_back(Vec3f(Vec3d(radius * std::cos(a), radius * std::sin(a), z)));
    }
  }
  const auto n = facets;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    add_quad(mesh, {i, j, n + j, n + i});
    add_quad(mesh, {(2 * n) + j, (2 * n) + i, (3 * n) + i, (3 * n) + j});
    add_quad(mesh, {n + i, n + j, (3 * n) + j, (3 * n) + i});
    add_quad(mesh, {j, i, (2 * n) + i, (2 * n) + j});
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other, Vec3f by) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const Vec3f& p : other.positions) mesh.positions.push_back(p + by);
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

TEST(RadiusLimits, are_the_inradius_of_a_convex_solid) {
  const RadiusLimits limits = limits_of(test::make_box_mesh({3, 2, 0.5}));
  EXPECT_NEAR(limits.smallest_inradius.value(), 0.5, 1e-6);
  EXPECT_NEAR(limits.typical_half_width.value(), 0.5, 1e-6);
}

TEST(RadiusLimits, do_not_depend_on_how_finely_a_rim_is_cut) {
  const double coarse = limits_of(make_tube(24)).typical_half_width.value();
  const double fine = limits_of(make_tube(768)).typical_half_width.value();
  EXPECT_NEAR(fine, coarse, 0.02 * coarse);
  EXPECT_GT(fine, 0.05);
  EXPECT_LT(fine, 0.15);  // half the wall
}

TEST(RadiusLimits, stay_below_half_the_wall_of_a_thin_frame) {
  // A square frame: the outline of 2 × 2, walls of 0.1, 3 high.
  Mesh frame;
  for (const auto& [half, z] : {std::pair(1.0F, 0.0F), {1.0F, 3.0F}, {0.9F, 0.0F}, {0.9F, 3.0F}}) {
    for (const auto& [x, y] :
         {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}}) {
      frame.positions.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    add_quad(frame, {i, j, 4 + j, 4 + i});
    add_quad(frame, {8 + j, 8 + i, 12 + i, 12 + j});
    add_quad(frame, {4 + i, 4 + j, 12 + j, 12 + i});
    add_quad(frame, {j, i, 8 + i, 8 + j});
  }
  const RadiusLimits limits = limits_of(frame);
  EXPECT_FALSE(limits.smallest_inradius);
  EXPECT_GT(limits.typical_half_width.value(), 0.04);
  EXPECT_LT(limits.typical_half_width.value(), 0.05);
}

TEST(RadiusLimits, take_the_faces_of_an_open_shell) {
  Mesh open_box = test::make_box_mesh({1, 1, 1});
  open_box.triangles.resize(open_box.triangles.size() - 2);
  const RadiusLimits limits = limits_of(open_box);
  EXPECT_FALSE(limits.smallest_inradius);
  EXPECT_NEAR(limits.typical_half_width.value(), 0.5, 1e-6);  // a square's area / outline
}

TEST(RadiusLimits, of_several_solids_are_those_of_the_middle_one) {
  Mesh mesh = make_tube(48);
  append(mesh, test::make_box_mesh({4, 4, 4}), {9, 0, 0});
  append(mesh, test::make_box_mesh({2, 2, 2}), {0, 9, 0});
  const RadiusLimits limits = limits_of(mesh);
  EXPECT_NEAR(limits.smallest_inradius.value(), 2, 1e-5);
  EXPECT_NEAR(limits.typical_half_width.value(), 2, 1e-5);
}

// A box of walls 0.1 thick: no ball between its outside and its hollow is larger than half of that.
TEST(RadiusLimits, of_a_box_with_a_hollow_are_half_its_walls) {
  Mesh mesh = test::make_box_mesh({2, 2, 2});
  Mesh hollow = test::make_box_mesh({1.9, 1.9, 1.9});
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  append(mesh, hollow, {0, 0, 0});
  const RadiusLimits limits = limits_of(mesh);
  EXPECT_FALSE(limits.smallest_inradius);
  EXPECT_NEAR(limits.typical_half_width.value(), 0.05, 0.001);
}

TEST(RadiusLimits, are_absent_where_there_is_no_edge_to_round) {
  const RadiusLimits limits = limits_of(test::make_square_mesh(1));
  EXPECT_FALSE(limits.smallest_inradius);
  EXPECT_FALSE(limits.typical_half_width);
}

// 2,172 convex edges, most of them short pieces of the rims of holes.
TEST(RadiusLimits, of_a_machined_part_fit_its_walls_rather_than_its_facets) {
  const auto file = test::shared_model("mesh/NIST_MBE_PMI_6.stl");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = load_scene(file);
  const double half_width = limits_of(scene.meshes.at(0)).typical_half_width.value();
  EXPECT_GT(half_width, 3);
  EXPECT_LT(half_width, 20);
}

std::optional<double> fitting_radius_of(const oracle::TriangleSoup& mesh, RoundEdges edges) {
  RoundingOptions options;
  options.edges = edges;
  options.radius = 10;
  return find_fitting_radius(mesh.view(), options, mesh.name);
}

TEST(FittingRadius, leaves_no_edge_sharp) {
  for (const oracle::CreasedCase& solid : oracle::make_creased_cases()) {
    SCOPED_TRACE(solid.mesh.name);
    for (const RoundEdges edges : {RoundEdges::convex, RoundEdges::concave, RoundEdges::both}) {
      RoundingOptions options;
      options.edges = edges;
      options.radius = fitting_radius_of(solid.mesh, edges).value();
      EXPECT_GT(options.radius, solid.radius);
      const auto rounding = make_rounding(solid.mesh.view(), options, solid.mesh.name);
      EXPECT_EQ(rounding.report().narrow_edges, 0U);
      options.radius *= 1.05;
      const auto larger = make_rounding(solid.mesh.view(), options, solid.mesh.name);
      EXPECT_GT(larger.report().narrow_edges, 0U);
    }
  }
}

// Two walls 0.5 thick, 0.3 apart, on a floor as thick as they are.
TEST(FittingRadius, is_half_the_width_of_walls_and_slots) {
  const oracle::Outline outline{{0, 0},     {1.3, 0},   {1.3, 2}, {0.8, 2},
                                {0.8, 0.5}, {0.5, 0.5}, {0.5, 2}, {0, 2}};
  const oracle::TriangleSoup slotted = oracle::prism_over("slotted", outline, {2, 1, 0});
  EXPECT_NEAR(fitting_radius_of(slotted, RoundEdges::convex).value(), 0.25, 0.0125);
  EXPECT_NEAR(fitting_radius_of(slotted, RoundEdges::concave).value(), 0.15, 0.0075);
  EXPECT_NEAR(fitting_radius_of(slotted, RoundEdges::both).value(), 0.15, 0.0075);
}

// 176 of its edges have no room for the automatic radius of 3.5, all have it for 2.
TEST(FittingRadius, of_a_machined_part_is_that_of_its_walls_rather_than_its_facets) {
  const auto file = test::shared_model("mesh/NIST_MBE_PMI_6.stl");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = load_scene(file);
  const Mesh& mesh = scene.meshes.at(0);
  RoundingOptions options;
  options.radius = 6;
  const auto fits = find_fitting_radius({mesh.positions, mesh.triangles}, options, mesh.name);
  ASSERT_TRUE(fits);
  EXPECT_GT(*fits, 1.2);
  EXPECT_LT(*fits, 3.5);
}

// Of a box with walls 0.2 thick: balls at its edges touch the edges of its hollow or, where most room is, a corner.
TEST(FittingRadius, sees_hollows) {
  Mesh mesh = test::make_box_mesh({2, 2, 2});
  Mesh hollow = test::make_box_mesh({1.8, 1.8, 1.8});
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  append(mesh, hollow, {0, 0, 0});
  RoundingOptions options;
  options.radius = 10;
  const double fits = find_fitting_radius({mesh.positions, mesh.triangles}, options).value();
  EXPECT_GT(fits, 0.95 * 0.2 * std::sqrt(2) / (1 + std::sqrt(2)));
  EXPECT_LT(fits, 0.2 * std::sqrt(3) / (1 + std::sqrt(3)));
}

}  // namespace
}  // namespace arris
