// STEP files, by way of arris-step where that was built
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arris/inspect.h"
#include "arris/io.h"
#include "io/mesh_readers.h"
#include "io/step_syntax.h"
#include "io/step_test_file.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/mesh_checks.h"
#include "support/reading_problem.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Scene read(const std::string& text) {
  return read_step(test::bytes_of(text), "part.step");
}

// The widest turn along an edge that apps/step/step_mesh.h allows.
constexpr double kAngle = 0.15;

class StepReader : public testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(ARRIS_BINARY_DIR "/arris-step")) {
      GTEST_SKIP() << "arris-step is not built (ARRIS_BUILD_STEP)";
    }
  }
};

test::StepPrism plate_with_hole() {
  test::StepPrism plate = test::step_box(4, 3, 1);
  plate.holes.push_back({1.5, 1.25, 0.5});
  return plate;
}

struct Bounds {
  Vec3d min = Vec3d(1e30), max = Vec3d(-1e30);
};
Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds;
  for (const Vec3f& p : mesh.positions) {
    bounds.min = min(bounds.min, Vec3d(p));
    bounds.max = max(bounds.max, Vec3d(p));
  }
  return bounds;
}

TEST_F(StepReader, reads_a_plate_with_a_hole) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const Scene scene = read(file.text());
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "plate");
  EXPECT_EQ(scene.name, "part");
  EXPECT_EQ(scene.notes, std::vector<std::string>());
  const Mesh& mesh = scene.meshes.read().at(0);
  EXPECT_TRUE(test::is_closed(mesh));
  const Bounds bounds = bounds_of(mesh);
  EXPECT_EQ(bounds.min, Vec3d(0, 0, 0));
  EXPECT_EQ(bounds.max, Vec3d(4, 3, 1));
  // Facets stand in the hole: n of them take n r²/2 sin 2π/n of πr².
  const double hole = kPi * 0.25;
  EXPECT_GE(test::volume_of(mesh), 12 - hole);
  EXPECT_LE(test::volume_of(mesh), 12 - hole * std::sin(kAngle) / kAngle);
}

TEST_F(StepReader, normals_are_those_of_the_surfaces) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const Scene scene = read(file.text());
  const Mesh& mesh = scene.meshes.read().at(0);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  std::size_t in_hole = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d from_axis = Vec3d(mesh.positions[i]) - Vec3d(1.5, 1.25, mesh.positions[i].z);
    const Vec3d n(mesh.normals[i]);
    const bool is_flat = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) == 1;
    if (is_flat && std::abs(length(from_axis) - 0.5) > 1e-6) continue;
    if (std::abs(n.z) == 1) continue;
    ++in_hole;
    EXPECT_LT(length(n + from_axis / 0.5), 1e-6) << "vertex " << i;
  }
  EXPECT_GE(in_hole, std::size_t(2 * 2 * kPi / kAngle));
}

TEST_F(StepReader, triangles_face_as_their_normals) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const Scene scene = read(file.text());
  const Mesh& mesh = scene.meshes.read().at(0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]);
    const Vec3d normal =
        normalize(cross(Vec3d(mesh.positions[t[1]]) - a, Vec3d(mesh.positions[t[2]]) - a));
    for (const std::uint32_t v : t) {
      EXPECT_GT(dot(normal, Vec3d(mesh.normals[v])), std::cos(kAngle));
    }
  }
}

EdgeCounts edges_of(const Scene& scene, double min_angle = radians(30)) {
  return inspect_scene(scene, min_angle).objects.at(0).edges;
}

TEST_F(StepReader, faces_that_touch_smoothly_have_no_sharp_edge) {
  test::StepFile file;
  const test::StepPrism slot{{{0, 0, {}}, {4, 0, {{4, 1}}}, {4, 2, {}}, {0, 2, {{0, 1}}}}, {}, 1};
  file.add_part("slot", {file.add_prism(slot).solid});
  const Scene scene = read(file.text());
  const Mesh& mesh = scene.meshes.read().at(0);
  EXPECT_TRUE(test::is_closed(mesh));
  std::size_t facets = 0;  // those of both half circles, and the two flat walls
  ASSERT_TRUE(mesh.sharp_edges);
  for (const auto& [a, b] : *mesh.sharp_edges) {
    EXPECT_EQ(mesh.positions[a].z, mesh.positions[b].z);
    facets += mesh.positions[a].z == 0 ? 1 : 0;
  }
  EXPECT_GE(facets, std::size_t(2 + 2 * kPi / kAngle));
  for (const double min_angle : {0.0, radians(30), kPi}) {
    const EdgeCounts edges = edges_of(scene, min_angle);
    EXPECT_EQ(edges.convex, 2 * facets);
    EXPECT_EQ(edges.concave, 0U);
    EXPECT_GE(edges.smooth, facets);
  }
}

TEST_F(StepReader, edges_that_turn_little_are_sharp) {
  test::StepFile file;
  const test::StepPrism bent{{{0, 0, {}},
                              {2, 0, {}},
                              {4, 2 * std::tan(radians(10)), {}},
                              {4, 2, {}},
                              {2, 2 - 2 * std::tan(radians(5)), {}},
                              {0, 2, {}}},
                             {},
                             1};
  file.add_part("bent", {file.add_prism(bent).solid});
  const EdgeCounts edges = edges_of(read(file.text()));
  EXPECT_EQ(edges.convex, 12U + 5U);
  EXPECT_EQ(edges.concave, 1U);
  EXPECT_EQ(edges.smooth, 0U);
}

TEST_F(StepReader, rims_of_holes_are_sharp) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const Scene scene = read(file.text());
  std::size_t facets = 0;
  for (const auto& [a, b] : *scene.meshes.read().at(0).sharp_edges) {
    const Vec3f p = scene.meshes.read().at(0).positions[a];
    facets += p.z == 0 && p.x > 0 && p.x < 4 && p.y > 0 && p.y < 3 ? 1 : 0;
  }
  EXPECT_GE(facets, std::size_t(2 * kPi / kAngle));
  EXPECT_EQ(edges_of(scene).convex, 12 + 2 * facets);
  EXPECT_EQ(edges_of(scene).concave, 0U);
}

TEST_F(StepReader, instances_share_a_mesh) {
  test::StepFile file;
  const auto bolt = file.add_part("bolt", {file.add_prism(test::step_box(1, 1, 2)).solid});
  file.add_assembly("pair", bolt, {{"left", -5, 0, 0}, {"right", 5, 1, 2}});
  const Scene scene = read(file.text());
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.meshes.read().at(0).name, "bolt");
  EXPECT_EQ(scene.objects[0].name, "left");
  EXPECT_EQ(scene.objects[1].name, "right");
  EXPECT_EQ(scene.objects[0].world_from_object.translation, Vec3d(-5, 0, 0));
  EXPECT_EQ(scene.objects[1].world_from_object.translation, Vec3d(5, 1, 2));
  EXPECT_EQ(scene.objects[1].world_from_object.linear, Mat3d());
}

TEST_F(StepReader, assemblies_of_assemblies_are_placed) {
  test::StepFile file;
  const auto bolt = file.add_part("bolt", {file.add_prism(test::step_box(1, 1, 2)).solid});
  const auto pair = file.add_assembly("pair", bolt, {{"", -5, 0, 0}, {"", 5, 0, 0}});
  file.add_assembly("all", pair, {{"", 0, 0, 0}, {"", 0, 100, 0}});
  const Scene scene = read(file.text());
  ASSERT_EQ(scene.objects.size(), 4U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  std::vector<std::string> places;
  for (const Object& object : scene.objects) {
    const Vec3d t = object.world_from_object.translation;
    places.push_back(fmt::format("{:g} {:g} {:g}", t.x, t.y, t.z));
  }
  EXPECT_EQ(scene.objects[0].name, "bolt");
  EXPECT_THAT(places, testing::UnorderedElementsAre("-5 0 0", "5 0 0", "-5 100 0", "5 100 0"));
}

TEST_F(StepReader, solids_of_a_part_are_objects) {
  test::StepFile file;
  test::StepPrism far = test::step_box(1, 1, 1);
  for (auto& corner : far.outline) corner.x += 10;
  file.add_part("halves",
                {file.add_prism(test::step_box(1, 1, 1)).solid, file.add_prism(far).solid});
  const Scene scene = read(file.text());
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "halves 1");
  EXPECT_EQ(scene.objects[1].name, "halves 2");
  for (const Mesh& mesh : scene.meshes.read()) {
    EXPECT_TRUE(test::is_closed(mesh));
    EXPECT_NEAR(test::volume_of(mesh), 1, 1e-6);
  }
}

TEST_F(StepReader, lengths_become_millimetres) {
  test::StepFile file("SI_UNIT($,.METRE.)");
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const Scene scene = read(file.text());
  EXPECT_EQ(bounds_of(scene.meshes.read().at(0)).max, Vec3d(4000, 3000, 1000));
}

TEST_F(StepReader, colours_become_materials) {
  test::StepFile file;
  const auto plate = file.add_prism(plate_with_hole());
  file.color(plate.solid, 1, 0.5, 0);
  file.color(plate.faces[1], 0, 0, 1);
  file.add_part("plate", {plate.solid});
  const Scene scene = read(file.text());
  const Mesh& mesh = scene.meshes.read().at(0);
  ASSERT_EQ(mesh.triangle_materials.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool is_top = std::ranges::all_of(
        mesh.triangles[i], [&](std::uint32_t v) { return mesh.positions[v].z == 1; });
    const Material& material = scene.materials.read()[mesh.triangle_materials[i].index];
    EXPECT_EQ(material.name, is_top ? "#0000ff" : "#ff8000");
    // 128/255 of sRGB.
    if (!is_top) {
      EXPECT_NEAR(material.base_color.y, 0.2140F, 0.002F);
    }
  }
}

TEST_F(StepReader, a_colour_of_the_whole_part_is_the_objects) {
  test::StepFile file;
  const auto bolt = file.add_prism(test::step_box(1, 1, 2));
  file.color(bolt.solid, 0, 1, 0);
  file.add_assembly("pair", file.add_part("bolt", {bolt.solid}), {{"a", 0, 0, 0}, {"b", 5, 0, 0}});
  const Scene scene = read(file.text());
  ASSERT_EQ(scene.objects.size(), 2U);
  for (const Object& object : scene.objects) {
    EXPECT_EQ(scene.materials.read().at(object.material.index).name, "#00ff00");
    EXPECT_EQ(scene.meshes.read().at(object.mesh.index).triangle_materials.size(), 0U);
  }
}

TEST_F(StepReader, says_what_is_missing_where_open_cascade_breaks_down) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  std::string text = file.text();
  const std::size_t point = text.find("CARTESIAN_POINT");
  const std::size_t begin = text.rfind('#', point), end = text.find('\n', point);
  const std::string name = text.substr(begin, text.find('=', begin) - begin);
  text.erase(begin, end - begin);
  EXPECT_THAT(test::refusal_of(read, text),
              AllOf(HasSubstr("part.step: Open CASCADE"), HasSubstr("names " + name + ","),
                    HasSubstr("export it again")));
}

TEST_F(StepReader, refuses_files_without_parts) {
  EXPECT_THAT(test::refusal_of(read, test::StepFile().text()), HasSubstr("export solids"));
}

// Any of these ends well, whether Open CASCADE takes it or breaks down.
TEST_F(StepReader, survives_what_is_not_sound) {
  test::StepFile file;
  file.add_part("plate", {file.add_prism(plate_with_hole()).solid});
  const std::string text = file.text();
  for (const auto& [what, instead] : std::vector<std::pair<std::string, std::string>>{
           {"0.5", "1.E300"},
           {"0.500000000000", "-1."},
           {"VERTEX_POINT", "EDGE_LOOP"},
           {"CLOSED_SHELL('',(", "CLOSED_SHELL('',(#1,"},
           {"PLANE(", "CYLINDRICAL_SURFACE("},
           {"LINE('',#", "LINE('',#999999"},
           {"ORIENTED_EDGE('',*,*,#", "ORIENTED_EDGE('',*,*,$"},
           {"4.000000000000", "4.E15"}}) {
    std::string changed = text;
    const std::size_t at = changed.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    changed.replace(at, what.size(), instead);
    EXPECT_EQ(test::problem_of_reading(test::bytes_of(changed),
                                       [](std::span<const std::uint8_t> bytes) {
                                         return read_step(bytes, "part.step");
                                       }),
              "")
        << what << " -> " << instead;
  }
}

TEST_F(StepReader, agrees_with_the_stl_of_a_real_part) {
  const auto step = test::shared_model("mesh/NIST_MBE_PMI_6.stp");
  const auto stl = test::shared_model("mesh/NIST_MBE_PMI_6.stl");
  if (!std::filesystem::exists(step) || !std::filesystem::exists(stl)) {
    GTEST_SKIP() << "no " << step;
  }
  const Scene scene = load_scene(step), other = load_scene(stl);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "Document");
  const Mesh &mesh = scene.meshes.read().at(0), &coarse = other.meshes.read().at(0);
  EXPECT_TRUE(test::is_closed(mesh));
  const Bounds bounds = bounds_of(mesh), expected = bounds_of(coarse);
  EXPECT_LT(length(bounds.min - expected.min), 1e-3);
  EXPECT_LT(length(bounds.max - expected.max), 1e-3);
  // That is made with a deflection of 0.05; here it is 0.0005 of the diagonal. No point is further away than both.
  const double deflection = 0.05 + 0.0005 * length(bounds.max - bounds.min);
  EXPECT_NEAR(test::volume_of(mesh), test::volume_of(coarse), deflection * test::area_of(coarse));
  // By Open CASCADE's integrals over the surfaces themselves.
  EXPECT_NEAR(test::volume_of(mesh) / 3328108.2, 1, 5e-4);
  EXPECT_NEAR(test::area_of(mesh) / 282233.1, 1, 5e-4);
}

// Before Open CASCADE sees them.

std::string syntax_problem(const std::string& text) {
  return test::refusal_of(
      [](const std::vector<std::uint8_t>& bytes) { check_step_syntax(bytes, "part.step"); },
      test::bytes_of(text));
}

const std::string kBegin = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n";
const std::string kEnd = "ENDSEC;\nEND-ISO-10303-21;\n";

TEST(StepSyntax, takes_comments_quotes_and_blanks) {
  EXPECT_EQ(syntax_problem("\xEF\xBB\xBF \r\n" + kBegin + kEnd), "no error");
  EXPECT_EQ(
      syntax_problem(kBegin + "/* ; ' ( */ #1 = A ( 'it''s ; (' , (\"0FF\", 1.E-3) ) ;" + kEnd),
      "no error");
  EXPECT_EQ(syntax_problem(kBegin + "#1=A/* b */('\xE4');" + kEnd), "no error");
}

TEST(StepSyntax, names_line_and_cause) {
  EXPECT_THAT(syntax_problem("solid x"), HasSubstr("part.step:1: the file ends"));
  EXPECT_THAT(syntax_problem("solid x;"), HasSubstr("begins with \"ISO-10303-21;\""));
  EXPECT_THAT(syntax_problem("ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;"),
              HasSubstr("part.step:4: has no section DATA"));
  EXPECT_THAT(syntax_problem(kBegin + "#1=A('x"),
              AllOf(HasSubstr("part.step:5: the text in quotes that begins in line 5"),
                    HasSubstr("was cut off")));
  EXPECT_THAT(syntax_problem(kBegin + "\n/* x \n\n"), HasSubstr("comment that begins in line 6"));
  EXPECT_THAT(syntax_problem(kBegin + "#1=A(;" + kEnd),
              HasSubstr("part.step:5: a statement ends within"));
  EXPECT_THAT(syntax_problem(kBegin + "#1=A());" + kEnd), HasSubstr("did not begin"));
  EXPECT_THAT(syntax_problem(kBegin + "#1=\x01;" + kEnd), HasSubstr("byte 0x01"));
  for (const std::string number : {"NaN", "-inf", "1.#INF", "-1.#IND"}) {
    EXPECT_THAT(syntax_problem(kBegin + "#1=A((1.," + number + ",2.));" + kEnd),
                HasSubstr("part.step:5: found \"" + number + "\" where a number should be"));
  }
  EXPECT_THAT(syntax_problem(kBegin + std::string(100'000, '(')), HasSubstr("200 levels"));
}

TEST(StepSyntax, refuses_every_cut) {
  test::StepFile file;
  file.add_part("bolt", {file.add_prism(test::step_box(1, 1, 2)).solid});
  const std::string text = file.text();
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    EXPECT_THAT(syntax_problem(text.substr(0, size)), HasSubstr("was cut off")) << size;
  }
}

TEST(StepSyntax, knows_step_by_its_content) {
  EXPECT_TRUE(looks_like_step(test::bytes_of(" \nISO-10303-21;")));
  EXPECT_FALSE(looks_like_step(test::bytes_of("solid ISO-10303-21;")));
  EXPECT_FALSE(looks_like_step({}));
}

TEST(StepSyntax, finds_the_first_missing_entity) {
  const auto find = [](const std::string& text) {
    return find_missing_entity(test::bytes_of(text), "part.step").value_or("none");
  };
  EXPECT_EQ(find(kBegin + "#1=A(#2,$);#2 = B(('#9',#1));" + kEnd), "none");
  EXPECT_EQ(find(kBegin + "#1=A(#2,$);\n#3 = B();" + kEnd), "line 5 names #2, which is not there");
}

}  // namespace
}  // namespace arris
