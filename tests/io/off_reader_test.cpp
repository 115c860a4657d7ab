#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/mesh_readers.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/mesh_checks.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Scene read(std::span<const std::uint8_t> bytes) {
  return read_off(bytes, "part.off");
}
Scene read_text(const std::string& text) {
  return read(test::bytes_of(text));
}
std::string message_of(const std::string& text) {
  return test::error_message(read, test::bytes_of(text));
}

const std::string kCubeVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
const std::string kCubeFaces = "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
const std::string kCube = "OFF\n8 6 12\n" + kCubeVertices + kCubeFaces;

TEST(OffReader, reads_a_cube_of_quads) {
  const Scene scene = read_text(kCube);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "part");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_TRUE(test::is_closed(mesh));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1);
  EXPECT_DOUBLE_EQ(test::area_of(mesh), 6);
}

TEST(OffReader, takes_counts_on_the_first_line_and_comments) {
  const Mesh one = read_text("OFF 8 6 0\n" + kCubeVertices + kCubeFaces).meshes.at(0);
  EXPECT_DOUBLE_EQ(test::volume_of(one), 1);
  const Mesh glued = read_text("OFF8 6 0\n" + kCubeVertices + kCubeFaces).meshes.at(0);
  EXPECT_DOUBLE_EQ(test::volume_of(glued), 1);
  const Mesh commented = read_text("# a cube\n\nOFF # here\n# counts:\n8 6\n\n" + kCubeVertices +
                                   "# faces\n" + kCubeFaces + "# end\n\n")
                             .meshes.at(0);
  EXPECT_DOUBLE_EQ(test::volume_of(commented), 1);
}

TEST(OffReader, reads_normals_and_texture_coordinates) {
  const Scene scene = read_text(
      "STCNOFF\n3 1 3\n0 0 0  0 0 2  255 0 0 255  0 0\n1 0 0  0 0 1  1 0 0  1 0.25\n"
      "0 1 0  0 0 1  0 0 0 0  0 1\n3 0 1 2\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.normals.size(), 3U);
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
  ASSERT_EQ(mesh.uvs.size(), 3U);
  EXPECT_EQ(mesh.uvs[1], (Vec2f{1, 0.75F}));
  EXPECT_THAT(scene.notes, testing::ElementsAre(HasSubstr("colours are not read")));
}

TEST(OffReader, shades_flat_where_a_normal_has_no_direction) {
  const Scene scene = read_text("NOFF\n3 1 0\n0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_TRUE(scene.meshes.at(0).normals.empty());
  EXPECT_THAT(scene.notes, testing::ElementsAre(HasSubstr("shaded flat")));
}

TEST(OffReader, ignores_colours_of_faces) {
  const Scene scene = read_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 128 0\n");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1U);
  EXPECT_EQ(scene.notes.size(), 1U);
}

TEST(OffReader, cuts_a_concave_face_exactly) {
  const Scene scene =
      read_text("OFF\n6 1 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(test::area_of(scene.meshes[0]), 3);
}

TEST(OffReader, rejects_huge_counts_without_taking_memory) {
  EXPECT_THAT(
      message_of("OFF\n4294967294 1 0\n0 0 0\n"),
      AllOf(HasSubstr("part.off:2:"), HasSubstr("4294967294 vertices"), HasSubstr("6 bytes")));
  EXPECT_THAT(message_of("OFF\n3 4000000000 0\n0 0 0\n0 0 0\n0 0 0\n"),
              HasSubstr("4000000000 faces"));
  EXPECT_THAT(message_of("OFF\n18446744073709551616 1 0\n"), HasSubstr("not a number from 0"));
  EXPECT_THAT(message_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4294967290 0 1 2\n"),
              HasSubstr("its first number says 4294967290"));
}

TEST(OffReader, names_line_and_value_of_what_is_wrong) {
  const std::string three = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(
      message_of(three + "3 0 1 3\n"),
      AllOf(HasSubstr("part.off:6: vertex 3 is out of range"), HasSubstr("3, numbered from 0")));
  EXPECT_THAT(message_of(three + "3 0 1 -1\n"), HasSubstr("vertex -1 is out of range"));
  EXPECT_THAT(message_of(three + "2 0 1\n"), HasSubstr("2 corners; at least 3"));
  EXPECT_THAT(message_of(three + "3 0 1 x\n"), HasSubstr("\"x\""));
  EXPECT_THAT(message_of(three + "3 0 1 2\n3 0 1 2\n"), HasSubstr("counts are wrong"));
  EXPECT_THAT(message_of("OFF\n3 1 0\n0 nan 0\n"), AllOf(HasSubstr(":2:"), HasSubstr("cut off")));
  EXPECT_THAT(message_of("OFF\n1 1 0\n0 nan 0\n3 0 0 0\n"),
              AllOf(HasSubstr(":3:"), HasSubstr("\"nan\"")));
  EXPECT_THAT(message_of("OFF\n1 1 0\n0 0 0 255 0 0\n3 0 0 0\n"), HasSubstr("C for a colour"));
  EXPECT_THAT(message_of("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), HasSubstr("no faces"));
  EXPECT_THAT(message_of("OFF BINARY\n"), HasSubstr("save it as ASCII"));
  EXPECT_THAT(message_of("4OFF\n"), HasSubstr("\"4OFF\""));
  EXPECT_THAT(message_of(""), HasSubstr("holds no text"));
}

TEST(OffReader, survives_cuts_and_changes_everywhere) {
  const auto cube = test::bytes_of(kCube);
  test::cut_every_byte(cube, read);
  test::change_every_byte(cube, read);
  const auto rich = test::bytes_of(
      "STCNOFF # all\n3 1 3\n0 0 0  0 0 2  255 0 0 255  0 0\n1 0 0  0 0 1  1 0 0  1 0.25\n"
      "0 1 0  0 0 1  0 0 0 0  0 1\n3 0 1 2 7\n");
  test::cut_every_byte(rich, read);
  test::change_every_byte(rich, read);
}

}  // namespace
}  // namespace arris
