#include "io/csg_reader.h"

#include <gmock/gmock.h>

#include <cmath>

#include "csg_test_tools.h"
#include "io/csg_openscad.h"
#include "io/file_bytes.h"
#include "support/cut_every_byte.h"
#include "support/mesh_checks.h"

namespace arris {
namespace {

using test::csg_message;
using test::expect_inside_where;
using test::kAsWritten;
using test::only;
using test::read_csg_text;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

bool in_box(Vec3d p, Vec3d low, Vec3d high) {
  return min(p, low) == low && max(p, high) == high;
}
double across(Vec3d p) {
  return std::hypot(p.x, p.y);
}
const std::string kCube = "cube(size = [1, 1, 1], center = false);";

// ----------------------------------------------------------------------------------------------- primitives

TEST(CsgReader, reads_boxes_spheres_and_cones) {
  EXPECT_EQ(only<CsgBox>(read_csg_text("cube(size = [1, 2, 3], center = false);")).high,
            Vec3d(1, 2, 3));
  EXPECT_EQ(only<CsgBox>(read_csg_text("cube(size = [2, 4, 6], center = true);")).low,
            Vec3d(-1, -2, -3));
  EXPECT_EQ(only<CsgSphere>(read_csg_text("sphere($fn = 0, $fa = 12, $fs = 2, r = 25);")).radius,
            25);
  const Scene cone =
      read_csg_text("cylinder($fn = 0, $fa = 12, $fs = 2, h = 4, r1 = 2, r2 = 0, center = true);");
  EXPECT_EQ(only<CsgCone>(cone).radius_high, 0);
  expect_inside_where(cone, {{-2, -2, -3}, {2, 2, 3}},
                      [](Vec3d p) { return std::abs(p.z) <= 2 && across(p) <= 1 - p.z / 2; });
}

TEST(CsgReader, names_scene_and_up) {
  const Scene scene = read_csg_text(kCube);
  EXPECT_EQ(scene.name, "part");
  EXPECT_EQ(scene.objects.at(0).name, "part");
  EXPECT_EQ(scene.up, Vec3d(0, 0, 1));
}

TEST(CsgReader, makes_an_object_of_each_part) {
  const Scene scene = read_csg_text("group() {\n difference() { " + kCube +
                                    " sphere(r = 1); }\n}\n%cube(size = 3);\n#sphere(r = 2);");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "difference (line 2)");
  EXPECT_EQ(scene.objects[1].name, "sphere (line 5)");
}

TEST(CsgReader, keeps_small_explicit_facets) {
  // The hexagon's flat sides are nearer than its corners.
  const Scene hexagon =
      read_csg_text("cylinder($fn = 6, $fa = 12, $fs = 2, h = 1, r1 = 2, r2 = 2, center = false);");
  EXPECT_EQ(only<CsgPolyhedron>(hexagon).faces.size(), 8U);
  EXPECT_FALSE(test::is_inside(hexagon, {1.9 * std::cos(kPi / 6), 1.9 * std::sin(kPi / 6), 0.5}));
  EXPECT_TRUE(test::is_inside(hexagon, {1.99, 0, 0.5}));
  EXPECT_EQ(
      only<CsgPolyhedron>(read_csg_text("cylinder($fn = 12, h = 1, r1 = 1, r2 = 1);")).faces.size(),
      14U);
  only<CsgCone>(read_csg_text("cylinder($fn = 13, h = 1, r1 = 1, r2 = 1);"));
  EXPECT_EQ(
      only<CsgPolyhedron>(read_csg_text("cylinder($fn = 1, h = 1, r1 = 1, r2 = 1);")).faces.size(),
      5U);
}

TEST(CsgReader, puts_a_faceted_spheres_rings_off_its_poles) {
  const Scene sphere = read_csg_text("sphere($fn = 5, r = 1);");
  double top = 0;
  for (const Vec3d& p : only<CsgPolyhedron>(sphere).vertices) top = std::max(top, p.z);
  EXPECT_NEAR(top, std::cos(kPi / 6), 1e-12);
}

TEST(CsgReader, as_written_cuts_all_round_things) {
  const Scene cylinder =
      read_csg_text("cylinder($fn = 0, $fa = 12, $fs = 2, h = 1, r1 = 10, r2 = 10);", kAsWritten);
  EXPECT_EQ(only<CsgPolyhedron>(cylinder).faces.size(), 32U);  // 360/12 beside the ends
  const Scene small =
      read_csg_text("cylinder($fn = 0, $fa = 12, $fs = 2, h = 1, r1 = 2, r2 = 2);", kAsWritten);
  EXPECT_EQ(only<CsgPolyhedron>(small).faces.size(), 9U);  // 2π·2/2 = 6.3
  const CsgMesh ball = only<CsgMesh>(read_csg_text("sphere($fn = 40, r = 1);", kAsWritten));
  EXPECT_EQ(ball.vertices.size(), 40U * 20U);
}

TEST(CsgReader, reads_numbers_of_all_kinds) {
  EXPECT_EQ(
      only<CsgBox>(
          read_csg_text("cube(size = [1e+06, .5, 2.], center = false, $fe = undef, x = \"y\");"))
          .high,
      Vec3d(1e6, 0.5, 2));
  const Scene moved = read_csg_text(
      "multmatrix([[1, 0, 0, -0], [0, 1, 0, -5e-1], [0, 0, 1, +3], [0, 0, 0, 1]]) { " + kCube +
      "}");
  EXPECT_TRUE(test::is_inside(moved, {0.5, 0, 3.5}));
}

TEST(CsgReader, leaves_out_what_has_no_size) {
  for (const std::string nothing :
       {"cube(size = [1, 0, 1]);", "cube(size = [1, -2, 1]);", "cube(size = [1, -nan, 1]);",
        "cube(size = [inf, 1, 1]);", "sphere(r = 0);", "cylinder(h = -1, r1 = 1, r2 = 1);",
        "cylinder(h = 1, r1 = -1, r2 = 1);", "cylinder(h = 1, r1 = 0, r2 = 0);",
        "linear_extrude(height = 0) { square(size = [1, 1]); }",
        "linear_extrude(height = -1) { square(size = [1, 1]); }",
        "rotate_extrude(angle = 0) { square(size = [1, 1]); }",
        "multmatrix([[nan, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = 1); "
        "}",
        "multmatrix([[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = 1); }",
        "group();", "render(convexity = 2);", "hull() { }"}) {
    EXPECT_THAT(csg_message(nothing), HasSubstr("holds no solid")) << nothing;
    // Empty in a union, a minuend, an intersection.
    EXPECT_EQ(read_csg_text("union() { " + nothing + kCube + "}").csg_trees.at(0).leaves.size(),
              1U);
    EXPECT_THAT(csg_message("difference() { " + nothing + kCube + "}"),
                HasSubstr("holds no solid"));
    EXPECT_EQ(
        read_csg_text("difference() { " + kCube + nothing + "}").csg_trees.at(0).leaves.size(), 1U);
    EXPECT_THAT(csg_message("intersection() { " + kCube + nothing + "}"),
                HasSubstr("holds no solid"));
  }
}

// ------------------------------------------------------------------------------------------------ operations

TEST(CsgReader, subtracts_and_intersects) {
  const Scene scene = read_csg_text(
      "difference() { cube(size = [4, 4, 4], center = true); %cube(size = 9); sphere(r = 2.3); "
      "group() { "
      "cylinder(h = 9, r1 = 1, r2 = 1, center = true); } }");
  expect_inside_where(scene, {Vec3d(-2.2), Vec3d(2.2)}, [](Vec3d p) {
    return in_box(p, Vec3d(-2), Vec3d(2)) && length(p) > 2.3 && across(p) > 1;
  });
  const Scene common = read_csg_text(
      "intersection() { sphere(r = 1); multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], "
      "[0, 0, 0, 1]]) { sphere(r = 1); } cube(size = [2, 2, 2]); }");
  expect_inside_where(common, {Vec3d(-0.1), Vec3d(1.1)}, [](Vec3d p) {
    return length(p) <= 1 && length(p - Vec3d(1, 0, 0)) <= 1 && in_box(p, Vec3d(0), Vec3d(2));
  });
}

TEST(CsgReader, hidden_nodes_leave_their_place_to_the_next) {
  const Scene scene =
      read_csg_text("difference() { %cube(size = 9); sphere(r = 2); cube(size = [5, 5, 5]); }");
  EXPECT_TRUE(test::is_inside(scene, {-1, -1, -1}));
  EXPECT_FALSE(test::is_inside(scene, {1, 1, 1}));
  EXPECT_FALSE(test::is_inside(scene, {4, 4, 4}));
}

TEST(CsgReader, mends_rotations_of_six_digits) {
  const Scene scene = read_csg_text(
      "multmatrix([[0.866025, -0.5, 0, 0], [0.5, 0.866025, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) "
      "{ multmatrix([[1, 0, 0, 0], [0, 0.707107, -0.707107, 0], [0, 0.707107, 0.707107, 0], [0, 0, "
      "0, 1]]) { " +
      kCube + "} }");
  const Mat3d m = scene.csg_trees.at(0).leaves.at(0).object_from_primitive.linear;
  EXPECT_NEAR(dot(m.x, m.y), 0, 1e-15);
  EXPECT_NEAR(length(m.z), 1, 1e-15);
  EXPECT_NEAR(m.x.x, std::cos(kPi / 6), 1e-15);
  EXPECT_NEAR(m.z.z, std::sqrt(0.5), 1e-15);
  // Three turns at once are no whole angle, but a rotation all the same.
  const Scene odd = read_csg_text(
      "multmatrix([[0.813798, -0.44097, 0.378522, 0], [0.469846, 0.882564, 0.0180283, 0], "
      "[-0.34202, 0.163176, 0.925417, 0], [0, 0, 0, 1]]) { " +
      kCube + "}");
  const Mat3d r = odd.csg_trees.at(0).leaves.at(0).object_from_primitive.linear;
  EXPECT_NEAR(determinant(r), 1, 1e-13);
  EXPECT_NEAR(dot(r.y, r.z), 0, 1e-13);
}

TEST(CsgReader, divides_by_the_last_element_and_refuses_perspective) {
  const Scene half = read_csg_text(
      "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 2]]) { " + kCube + "}");
  EXPECT_TRUE(test::is_inside(half, Vec3d(0.49)));
  EXPECT_FALSE(test::is_inside(half, Vec3d(0.51)));
  EXPECT_THAT(
      csg_message("multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]) { " +
                  kCube + "}"),
      HasSubstr("perspective"));
}

// ---------------------------------------------------------------------------------------------------- colours

const Material& material_at(const Scene& scene, std::size_t leaf) {
  return scene.materials.at(scene.csg_trees.at(0).leaves.at(leaf).material.index);
}

TEST(CsgReader, outermost_colour_wins_and_unset_is_none) {
  const Scene scene = read_csg_text(
      "union() { color([1, 0, 0, 1]) { color([0, 1, 0, 1]) { cube(size = 1); } } color([-1, -1, "
      "-1, -1]) { color([0, 0, 1, 0.25]) "
      "{ sphere(r = 1); } } cube(size = 3); color([1, 0, 0, 1]) { sphere(r = 3); } }");
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(material_at(scene, 0).base_color, Rgb(1, 0, 0));
  EXPECT_EQ(material_at(scene, 1).base_color, Rgb(0, 0, 1));
  EXPECT_EQ(material_at(scene, 1).opacity, 0.25F);
  EXPECT_EQ(material_at(scene, 2).name, "openscad");
  EXPECT_EQ(material_at(scene, 3).name, material_at(scene, 0).name);
}

TEST(CsgReader, holes_without_a_colour_take_that_of_the_part) {
  const Scene scene = read_csg_text(
      "difference() { color([1, 0, 0, 1]) { cube(size = 3); } sphere(r = 1); color([0, 0, 1, 1]) { "
      "sphere(r = 0.5); } }");
  EXPECT_EQ(material_at(scene, 1).base_color, Rgb(1, 0, 0));
  EXPECT_EQ(material_at(scene, 2).base_color, Rgb(0, 0, 1));
}

// ------------------------------------------------------------------------------------------------- polyhedra

TEST(CsgReader, reads_polyhedra_clockwise_concave_and_turned) {
  const std::string points =
      "points = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0], [0, 2, 0], [0, 0, 1], [2, 0, 1], "
      "[2, 2, 1], [1, 0.5, 1], [0, 2, 1]]";
  const std::string sides = "[5, 6, 1, 0], [6, 7, 2, 1], [7, 8, 3, 2], [8, 9, 4, 3], [9, 5, 0, 4]";
  const auto truth = [](Vec3d p) {
    return in_box(p, {0, 0, 0}, {2, 2, 1}) && p.y <= 0.5 + 1.5 * std::abs(p.x - 1);
  };
  const test::Box box{{-0.1, -0.1, -0.1}, {2.1, 2.1, 1.1}};
  const Scene sound = read_csg_text(
      "polyhedron(" + points + ", faces = [[0, 1, 2, 3, 4], [9, 8, 7, 6, 5], " + sides + "]);");
  EXPECT_THAT(sound.notes, IsEmpty());
  expect_inside_where(sound, box, truth);
  const Scene turned = read_csg_text(
      "polyhedron(" + points + ", faces = [[4, 3, 2, 1, 0], [9, 8, 7, 6, 5], " + sides + "]);");
  EXPECT_THAT(turned.notes, testing::Contains(HasSubstr("turned")));
  expect_inside_where(turned, box, truth);
  EXPECT_GT(test::winding_number(only<CsgMesh>(turned), {0.2, 0.2, 0.5}), 0.5);
  EXPECT_THAT(csg_message("polyhedron(" + points + ", faces = [[0, 1, 2, 3, 4], " + sides + "]);"),
              AllOf(HasSubstr("part.csg:1: polyhedron"),
                    HasSubstr("5 edges have a face on one side only")));
  EXPECT_THAT(csg_message("\npolyhedron(" + points + ", faces = [[0, 1, 10]]);"),
              HasSubstr("part.csg:2: polyhedron: face 0 names point 10"));
}

TEST(CsgReader, convex_polyhedra_have_planes) {
  const Scene scene = read_csg_text(
      "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, "
      "3, 1], [0, 2, 3], [1, 3, 2]], convexity = 1);");
  EXPECT_EQ(only<CsgPolyhedron>(scene).faces.size(), 4U);
  expect_inside_where(scene, {Vec3d(-0.1), Vec3d(1.1)},
                      [](Vec3d p) { return min(p, Vec3d(0)) == Vec3d(0) && p.x + p.y + p.z <= 1; });
}

// ------------------------------------------------------------------------------------------------ extrusions

TEST(CsgReader, extrudes_circles_to_cylinders_and_cones) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 2, center = true, scale = [0.5, 0.5]) { difference() { circle(r = "
      "3); "
      "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } "
      "square(size = [9, 9]); } }");
  expect_inside_where(scene, {{-3.1, -3.1, -1.2}, {3.1, 3.1, 1.2}}, [](Vec3d p) {
    const double s = 1 - 0.25 * (p.z + 1);
    const double x = p.x / s, y = p.y / s;
    return std::abs(p.z) <= 1 && std::hypot(x, y) <= 3 && std::hypot(x - 1, y - 0.5) > 1 &&
           !(x >= 0 && y >= 0);
  });
  for (const CsgLeaf& leaf : scene.csg_trees[0].leaves)
    EXPECT_FALSE(std::holds_alternative<CsgMesh>(leaf.primitive));
}

TEST(CsgReader, faces_of_extruded_differences_do_not_coincide) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 1) { difference() { circle(r = 3); circle(r = 1); } }");
  const std::vector<CsgLeaf>& leaves = scene.csg_trees.at(0).leaves;
  EXPECT_EQ(std::get<CsgCone>(leaves.at(0).primitive).z_high, 1);
  EXPECT_GT(std::get<CsgCone>(leaves.at(1).primitive).z_high, 1.1);
  EXPECT_LT(std::get<CsgCone>(leaves.at(1).primitive).z_low, -0.1);
}

TEST(CsgReader, extrudes_to_a_point) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 2, scale = [0, 0]) { difference() { square(size = [2, 2], center = "
      "true); "
      "multmatrix([[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 0.3); } "
      "} }");
  expect_inside_where(scene, {{-1, -1, -0.1}, {1, 1, 2.1}}, [](Vec3d p) {
    const double s = 1 - p.z / 2;
    return p.z >= 0 && s > 0 && std::max(std::abs(p.x), std::abs(p.y)) <= s &&
           std::hypot(p.x / s - 0.5, p.y / s) > 0.3;
  });
}

TEST(CsgReader, takes_polygons_even_odd) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 1) { polygon(points = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, "
      "1], [3, 3], [1, 3]], "
      "paths = [[0, 1, 2, 3], [4, 5, 6, 7]], convexity = 1); }");
  expect_inside_where(scene, {{-0.5, -0.5, -0.5}, {4.5, 4.5, 1.5}}, [](Vec3d p) {
    return in_box(p, {0, 0, 0}, {4, 4, 1}) && !(p.x > 1 && p.x < 3 && p.y > 1 && p.y < 3);
  });
  // A pentagram's middle is outside.
  const Scene star = read_csg_text(
      "linear_extrude(height = 1) { polygon(points = [[0, 1], [0.587785, -0.809017], [-0.951057, "
      "0.309017], "
      "[0.951057, 0.309017], [-0.587785, -0.809017]], paths = undef); }");
  EXPECT_FALSE(test::is_inside(star, {0, 0, 0.5}));
  EXPECT_TRUE(test::is_inside(star, {0, 0.7, 0.5}));
  EXPECT_TRUE(test::is_inside(star, {0.5, -0.7, 0.5}));
  EXPECT_FALSE(test::is_inside(star, {0, -0.7, 0.5}));
}

TEST(CsgReader, twists_in_slices) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 3, twist = 90, slices = 90) { difference() { square(size = [4, 2], "
      "center = true); circle(r = 0.5); } }");
  expect_inside_where(
      scene, {{-2.3, -2.3, -0.2}, {2.3, 2.3, 3.2}},
      [](Vec3d p) {
        const double angle = radians(30 * p.z);  // back, counter-clockwise
        const double x = p.x * std::cos(angle) - p.y * std::sin(angle),
                     y = p.x * std::sin(angle) + p.y * std::cos(angle);
        return p.z >= 0 && p.z <= 3 && std::abs(x) <= 2 && std::abs(y) <= 1 && across(p) > 0.5;
      },
      0.02, 1500);
}

TEST(CsgReader, turns_circles_to_spheres_and_tori) {
  const Scene torus = read_csg_text(
      "rotate_extrude(angle = 360, convexity = 2) { multmatrix([[1, 0, 0, 4], [0, 1, 0, 1], [0, 0, "
      "1, 0], [0, 0, 0, 1]]) { circle(r = 1); } }");
  EXPECT_EQ(only<CsgTorus>(torus).ring_radius, 4);
  expect_inside_where(torus, {{-5.1, -5.1, -0.2}, {5.1, 5.1, 2.1}},
                      [](Vec3d p) { return std::hypot(across(p) - 4, p.z - 1) <= 1; });
  const Scene ball = read_csg_text(
      "rotate_extrude() { difference() { circle(r = 2); multmatrix([[1, 0, 0, -5], [0, 1, 0, -5], "
      "[0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = [5, 10]); } } }");
  expect_inside_where(ball, {Vec3d(-2.1), Vec3d(2.1)}, [](Vec3d p) { return length(p) <= 2; });
}

TEST(CsgReader, turns_outlines_by_an_angle) {
  const auto ring = [](Vec3d p) {
    return across(p) >= 3 && across(p) <= 5 && p.z >= 0 && p.z <= 1;
  };
  const std::string square =
      "{ multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = [2, "
      "1]); } }";
  const std::string left =
      "{ multmatrix([[1, 0, 0, -5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = [2, "
      "1]); } }";
  const test::Box box{{-5.2, -5.2, -0.1}, {5.2, 5.2, 1.1}};
  const auto angle = [](Vec3d p) { return degrees(std::atan2(p.y, p.x)) + (p.y < 0 ? 360 : 0); };
  expect_inside_where(read_csg_text("rotate_extrude(angle = 90)" + square), box,
                      [&](Vec3d p) { return ring(p) && angle(p) <= 90; });
  expect_inside_where(read_csg_text("rotate_extrude(angle = 270)" + square), box,
                      [&](Vec3d p) { return ring(p) && angle(p) <= 270; });
  expect_inside_where(read_csg_text("rotate_extrude(angle = -60)" + square), box,
                      [&](Vec3d p) { return ring(p) && angle(p) >= 300; });
  // From the -x axis, clockwise.
  expect_inside_where(read_csg_text("rotate_extrude(angle = -90)" + left), box,
                      [&](Vec3d p) { return ring(p) && angle(p) >= 90 && angle(p) <= 180; });
  EXPECT_THAT(csg_message("rotate_extrude() { square(size = [2, 2], center = true); }"),
              HasSubstr("both sides of the y axis"));
}

// --------------------------------------------------------------------------------------------- hull, minkowski

std::string moved(double x, double y, double z, const std::string& what) {
  return "multmatrix([[1, 0, 0, " + std::to_string(x) + "], [0, 1, 0, " + std::to_string(y) +
         "], [0, 0, 1, " + std::to_string(z) + "], [0, 0, 0, 1]]) { " + what + " }";
}
double to_box(Vec3d p, Vec3d low, Vec3d high) {
  return length(p - max(low, min(high, p)));
}

TEST(CsgReader, hulls_of_equal_balls_are_rounded) {
  std::string balls;
  for (int i = 0; i < 8; ++i)
    balls += moved(i & 1 ? 4 : 0, i & 2 ? 3 : 0, i & 4 ? 2 : 0, "sphere(r = 1);");
  const Scene box = read_csg_text("hull() { " + balls + " }");
  EXPECT_EQ(only<CsgRounded>(box).core.faces.size(), 6U);
  expect_inside_where(box, {Vec3d(-1.1), {5.1, 4.1, 3.1}}, [](Vec3d p) {
    return to_box(p, Vec3d(0), {4, 3, 2}) <= 1;
  });
  const Scene capsule =
      read_csg_text("hull() { sphere(r = 1); " + moved(1, 2, 3, "sphere(r = 1);") + " }");
  expect_inside_where(capsule, {Vec3d(-1.1), {2.1, 3.1, 4.1}}, [](Vec3d p) {
    return test::distance_to_segment({0, 0, 0}, {1, 2, 3}, p) <= 1;
  });
  const Scene plate =
      read_csg_text("hull() { sphere(r = 1); " + moved(4, 0, 0, "sphere(r = 1);") +
                    moved(4, 3, 0, "sphere(r = 1);") + moved(0, 3, 0, "sphere(r = 1);") + " }");
  expect_inside_where(plate, {Vec3d(-1.1), {5.1, 4.1, 1.1}}, [](Vec3d p) {
    return to_box(p, Vec3d(0), {4, 3, 0}) <= 1;
  });
}

TEST(CsgReader, hulls_of_upright_cylinders_are_exact) {
  const std::string pin = "cylinder(h = 2, r1 = 1, r2 = 1);";
  const Scene plate = read_csg_text(
      "multmatrix([[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]) { hull() { " + pin +
      moved(5, 0, 0, pin) + moved(0, 4, 0, pin) + moved(5, 4, 0, pin) + " } }");
  EXPECT_THAT(plate.notes, IsEmpty());
  expect_inside_where(plate, {{-0.1, -1.1, -6.1}, {2.1, 5.1, 1.1}}, [](Vec3d p) {
    return p.x >= 0 && p.x <= 2 && to_box({-p.z, p.y, 0}, Vec3d(0), {5, 4, 0}) <= 1;
  });
  const Scene cam = read_csg_text(
      "linear_extrude(height = 1) { hull() { circle(r = 2); multmatrix([[1, 0, 0, 5], [0, 1, 0, "
      "0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } } }");
  expect_inside_where(
      cam, {{-2.1, -2.1, -0.1}, {6.1, 2.1, 1.1}},
      [](Vec3d p) {
        // Of all discs between the two, by their centre s in 0..1.
        bool in = false;
        for (int i = 0; i <= 2000; ++i)
          in |= std::hypot(p.x - 5 * i / 2000.0, p.y) <= 2 - i / 2000.0;
        return in && p.z >= 0 && p.z <= 1;
      },
      1e-3, 800);
}

TEST(CsgReader, minkowski_with_a_sphere_rounds) {
  const Scene scene = read_csg_text(
      "minkowski(convexity = 0) { cube(size = [4, 3, 2], center = false); sphere($fn = 0, r = "
      "0.5); }");
  EXPECT_EQ(only<CsgRounded>(scene).radius, 0.5);
  expect_inside_where(scene, {Vec3d(-0.6), {4.6, 3.6, 2.6}}, [](Vec3d p) {
    return to_box(p, Vec3d(0), {4, 3, 2}) <= 0.5;
  });
  const Scene upright =
      read_csg_text("minkowski() { cube(size = [4, 3, 2]); cylinder(h = 1, r1 = 0.5, r2 = 0.5); }");
  expect_inside_where(upright, {Vec3d(-0.6), {4.6, 3.6, 3.1}}, [](Vec3d p) {
    return p.z >= 0 && p.z <= 3 && to_box({p.x, p.y, 0}, Vec3d(0), {4, 3, 0}) <= 0.5;
  });
}

TEST(CsgReader, offsets_outlines_that_grow) {
  const Scene scene = read_csg_text(
      "linear_extrude(height = 1) { offset(r = 0.5, $fn = 0) { polygon(points = [[0, 0], [4, 0], "
      "[4, 4], [3, 4], [3, 1], [0, 1]], paths = undef); } }");
  expect_inside_where(scene, {{-0.6, -0.6, -0.1}, {4.6, 4.6, 1.1}}, [](Vec3d p) {
    const Vec3d q(p.x, p.y, 0);
    return p.z >= 0 && p.z <= 1 &&
           std::min(to_box(q, Vec3d(0), {4, 1, 0}), to_box(q, {3, 0, 0}, {4, 4, 0})) <= 0.5;
  });
}

TEST(CsgReader, resizes_what_it_can_measure) {
  const Scene scene =
      read_csg_text("resize(newsize = [10,0,2], auto = [0,1,0], convexity = 0) { sphere(r = 1); }");
  expect_inside_where(scene, {{-5.1, -5.1, -1.1}, {5.1, 5.1, 1.1}},
                      [](Vec3d p) { return length(Vec3d(p.x / 5, p.y / 5, p.z)) <= 1; });
}

// ----------------------------------------------------------------------------------------------------- errors

TEST(CsgReader, names_line_and_node_of_bad_text) {
  EXPECT_THAT(csg_message("cube(size = [1, 1, 1]\n"),
              HasSubstr("part.csg:2: found the end of the file"));
  EXPECT_THAT(csg_message("\n\ncube(size = \"x\");"),
              HasSubstr("part.csg:3: cube: size must be a list"));
  EXPECT_THAT(csg_message("a = 5;"), AllOf(HasSubstr("part.csg:1"), HasSubstr(".scad")));
  EXPECT_THAT(csg_message("group() {\n" + kCube), HasSubstr("ends inside \"group\" of line 1"));
  EXPECT_THAT(csg_message("square(size = [1, 1]);"), HasSubstr("flat shapes only"));
  EXPECT_THAT(csg_message("cube(size = 1e30);"), HasSubstr("part.csg:1: cube: reaches to 1e+30"));
}

TEST(CsgReader, names_all_nodes_that_only_openscad_can_make) {
  const std::string message = csg_message(
      "linear_extrude(height = 1) {\n text(text = \"A\\\"b\", size = 5);\n}\nsurface(file = "
      "\"x.dat\");\nlinear_extrude(height = 1) "
      "{\n projection(cut = true) { cube(size = 1); }\n}\n" +
      kCube);
  EXPECT_THAT(message, AllOf(HasSubstr("part.csg:2: text"), HasSubstr("line 4: surface"),
                             HasSubstr("line 6: projection"), HasSubstr("openscad")));
}

TEST(CsgReader, limits_nesting) {
  std::string deep, lists;
  for (int i = 0; i < 100'000; ++i) deep += "group() { ", lists += '[';
  EXPECT_THAT(csg_message(deep), HasSubstr("nested more than 400 deep"));
  EXPECT_THAT(csg_message("cube(size = " + lists), HasSubstr("nested more than 16 deep"));
  EXPECT_THAT(csg_message("sphere($fn = 1e9, r = 1);"), "no error");
}

// Together one file, each for itself another.
const std::string kParts[] = {
    "// a comment\ngroup() {\n difference() {\n  color([1, 0, 0, 0.5]) { cube(size = [3, 3, 3], "
    "center = true); }\n  %sphere(r = 9);\n  "
    "multmatrix([[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]) { cylinder($fn = 6, $fa "
    "= 12, $fs = 2, h = 9, r1 = 1, r2 = 0.5, center = true); }\n }\n}\n",
    "linear_extrude(height = 1, center = false, twist = 20, slices = 2, scale = [1, 2]) { "
    "difference() { polygon(points = [[0, 0], [4, 0], [0, 4], [4, 4]], paths = [[0, 1, 2, 3]]); "
    "circle(r = 1, $fn = 8); } }\n",
    "rotate_extrude(angle = 90, $fn = 5) { square(size = [2, 1]); }\n",
    "hull() { sphere(r = 1, $fn = 6); cube(size = 3); }\n",
    "minkowski() { cube(size = 1); sphere(r = 1); }\n",
    "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, "
    "1], [0, 2, 3], [1, 3, 2]], convexity = 1);\n"};

TEST(CsgReader, stays_sound_when_cut_or_changed) {
  std::string all;
  for (const std::string& part : kParts) {
    all += part;
    test::change_every_byte(test::bytes_of(part), test::read_csg_bytes);
  }
  const std::vector<std::uint8_t> file = test::bytes_of(all);
  EXPECT_EQ(test::problem_of_reading(file, test::read_csg_bytes), "");
  test::cut_every_byte(file, test::read_csg_bytes);
}

// -------------------------------------------------------------------------------------------------- real files

TEST(CsgReader, reads_the_examples_that_come_with_openscad) {
  const std::filesystem::path folder = test::shared_model("openscad");
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".csg") continue;
    // Without an openscad program.
    const Scene scene = read_csg(read_file_bytes(entry.path()), entry.path().string(), {});
    EXPECT_THAT(validate_scene(scene), IsEmpty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 12U);
}

}  // namespace
}  // namespace arris
