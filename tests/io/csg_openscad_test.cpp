// What OpenSCAD itself makes of the same texts; skipped where there is no openscad program.
#include "io/csg_openscad.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>

#include "csg_test_tools.h"
#include "io/file_bytes.h"
#include "io/mesh_readers.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using testing::Contains;
using testing::HasSubstr;

class OpenScad : public testing::Test {
 protected:
  void SetUp() override {
    program_ = find_openscad();
    if (!program_) GTEST_SKIP() << "no openscad on the PATH";
  }

  // Random points lie in the tree where they lie in OpenSCAD's mesh of the text.
  void expect_same_solid(const std::string& text, const LoadOptions& options, double margin) {
    SCOPED_TRACE(text);
    const OpenScadOutput output = mesh_by_openscad(*program_, text);
    ASSERT_TRUE(std::holds_alternative<std::vector<std::uint8_t>>(output))
        << std::get<std::string>(output);
    const Scene meshed = read_off(std::get<std::vector<std::uint8_t>>(output), "x.off");
    CsgMesh mesh;
    test::Box box{Vec3d(1e9), Vec3d(-1e9)};
    for (const Vec3f& p : meshed.meshes.at(0).positions) {
      mesh.vertices.emplace_back(p);
      box = {min(box.low, Vec3d(p)), max(box.high, Vec3d(p))};
    }
    mesh.triangles = meshed.meshes[0].triangles;
    const Vec3d size = box.high - box.low;
    test::expect_inside_where(
        test::read_csg_text(text, options), {box.low - size * 0.1, box.high + size * 0.1},
        [&](Vec3d p) { return test::is_inside(mesh, p); }, margin * max_component(size), 600);
  }

  std::optional<std::filesystem::path> program_;
};

TEST_F(OpenScad, agrees_on_facets) {
  for (const std::string text :
       {"sphere($fn = 7, r = 2);", "cylinder($fn = 5, h = 2, r1 = 2, r2 = 0.5, center = true);",
        "sphere($fn = 0, $fa = 12, $fs = 2, r = 10);",
        "difference() { cube(size = [8, 8, 8], center = true); sphere($fn = 0, $fa = 12, $fs = 2, "
        "r = 5); cylinder($fn = 0, $fa = 12, $fs = 2, h = 9, r1 = 2, r2 = 3); }",
        "rotate_extrude(angle = 360, $fn = 5) { multmatrix([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, "
        "0], [0, 0, 0, 1]]) { circle($fn = 6, r = 2); } }",
        "rotate_extrude(angle = 200, $fn = 7) { multmatrix([[1, 0, 0, -4], [0, 1, 0, 0], [0, 0, 1, "
        "0], [0, 0, 0, 1]]) { circle($fn = 6, r = 2); } }"}) {
    expect_same_solid(text, test::kAsWritten, 1e-4);
  }
}

TEST_F(OpenScad, agrees_on_extrusions) {
  for (const std::string text :
       {"linear_extrude(height = 5, twist = 100, scale = [1, 1], $fn = 0, $fa = 12, $fs = 2) { "
        "square(size = [4, 2], center = false); }",
        "linear_extrude(height = 5, twist = -60, slices = 6, scale = [0.5, 0.5]) { difference() { "
        "square(size = [6, 4], center = true); polygon(points = [[0, 0], [1, 0], [0, 1]], paths = "
        "undef); } }",
        "linear_extrude(height = 5, scale = [0, 0]) { polygon(points = [[0, 0], [4, 0], [4, 4], "
        "[1, 1], [0, 4]], paths = undef); }",
        "linear_extrude(height = 5, center = true) { polygon(points = [[0, 0], [4, 4], [4, 0], [0, "
        "3]], paths = undef); }"}) {
    expect_same_solid(text, test::kAsWritten, 2e-3);
  }
}

TEST_F(OpenScad, agrees_on_hulls_and_sums) {
  for (const std::string text :
       {"hull() { cube(size = [2, 2, 2]); multmatrix([[1, 0, 0, 5], [0, 1, 0, 1], [0, 0, 1, 3], "
        "[0, 0, 0, 1]]) { sphere($fn = 8, r = 1); } }",
        "minkowski() { cube(size = [3, 2, 1]); sphere($fn = 8, r = 1); }",
        "resize(newsize = [10, 0, 3], auto = [0, 1, 0]) { union() { cube(size = [1, 2, 3]); "
        "cube(size = [2, 1, 1]); } }"}) {
    expect_same_solid(text, test::kAsWritten, 1e-4);
  }
  // Round things: OpenSCAD's facets lie within.
  expect_same_solid("minkowski() { cube(size = [3, 2, 1]); sphere($fn = 40, r = 1); }", {}, 0.01);
  expect_same_solid(
      "hull() { sphere($fn = 40, r = 1); multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, "
      "0, 0, 1]]) { sphere($fn = 40, r = 2); } }",
      {}, 0.02);
  expect_same_solid(
      "linear_extrude(height = 2) { offset(r = 1, $fn = 60) { square(size = [3, 2]); } }", {},
      0.01);
}

class WithOpenScad : public OpenScad {
 protected:
  Scene read(const std::string& text) {
    return read_csg(test::bytes_of(text), (folder_ / "part.csg").string(),
                    csg_files_beside(folder_ / "part.csg"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(WithOpenScad, makes_what_only_it_can) {
  const Scene scene = read(
      "linear_extrude(height = 1) { difference() { offset(delta = -0.5) { square(size = [4, 4]); } "
      "circle(r = 1); } }");
  EXPECT_THAT(scene.notes, Contains(HasSubstr("line 1: offset is cut into triangles by OpenSCAD")));
  test::expect_inside_where(scene, {{-0.1, -0.1, -0.1}, {4.1, 4.1, 1.1}}, [](Vec3d p) {
    return p.z >= 0 && p.z <= 1 && std::min(p.x, p.y) >= 0.5 && std::max(p.x, p.y) <= 3.5 &&
           std::hypot(p.x, p.y) > 1;
  });
  const Scene hull =
      read("hull() { difference() { cube(size = [2, 2, 2]); cube(size = [1, 1, 1]); } }");
  test::expect_inside_where(hull, {Vec3d(-0.1), Vec3d(2.1)}, [](Vec3d p) {
    return min(p, Vec3d(0)) == Vec3d(0) && max(p, Vec3d(2)) == Vec3d(2) && p.x + p.y + p.z >= 1;
  });
}

TEST_F(WithOpenScad, finds_files_beside_the_model) {
  write_file_whole(folder_ / "d.dat", test::bytes_of("1 1 1\n1 3 1\n1 1 1\n"));
  const Scene scene =
      read("surface(file = \"d.dat\", center = false, invert = false, timestamp = 1);");
  EXPECT_TRUE(test::is_inside(scene, {1, 1, 2.5}));
  EXPECT_FALSE(test::is_inside(scene, {0.2, 0.2, 2.5}));
  try {
    read("\nimport(file = \"none.amf\");\nimport(file = \"none.stl\");");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(),
                testing::AllOf(HasSubstr("part.csg:3: import"), HasSubstr("none.stl")));
  }
}

TEST_F(WithOpenScad, flattens_scad_files) {
  write_file_whole(
      folder_ / "plate.scad",
      test::bytes_of("for (i = [0:2]) translate([4 * i, 0, 0]) cylinder(r = 1, h = 2);"));
  const Scene scene = load_scene(folder_ / "plate.scad");
  EXPECT_EQ(scene.objects.at(0).name, "plate");
  EXPECT_EQ(scene.csg_trees.at(0).leaves.size(), 3U);
  write_file_whole(folder_ / "bad.scad", test::bytes_of("cube(\n"));
  EXPECT_THAT(
      test::error_message([](const auto& p) { return load_scene(p); }, folder_ / "bad.scad"),
      HasSubstr("bad.scad: openscad ended with 1"));
}

TEST(WithoutOpenScad, says_what_scad_files_need) {
  const char* const path = std::getenv("PATH");
  const std::string kept = path != nullptr ? path : "";
  ::setenv("PATH", "/nonexistent", 1);
  const std::string message = test::error_message([](const auto& p) { return read_scad(p); },
                                                  std::filesystem::path("part.scad"));
  ::setenv("PATH", kept.c_str(), 1);
  EXPECT_THAT(message, testing::AllOf(HasSubstr("part.scad: reading .scad files takes OpenSCAD"),
                                      HasSubstr("PATH")));
}

}  // namespace
}  // namespace arris
