#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/mesh_readers.h"
#include "support/cut_every_byte.h"
#include "support/mesh_checks.h"

namespace arris {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Facet = std::array<Vec3f, 3>;

// Outward facets of the tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1): volume 1/6.
std::vector<Facet> tetrahedron() {
  const Vec3f o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  return {{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}};
}

template <class T>
void append(Bytes& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

Bytes binary_stl(const std::vector<Facet>& facets, const std::string& header = "made for a test") {
  Bytes bytes(80);
  std::copy(header.begin(), header.end(), bytes.begin());
  append(bytes, std::uint32_t(facets.size()));
  for (const Facet& facet : facets) {
    append(bytes, Vec3f(0, 0, 1));
    append(bytes, facet);
    append(bytes, std::uint16_t(0));
  }
  return bytes;
}

std::string solid_text(const std::string& name, const std::vector<Facet>& facets) {
  std::string text = "solid " + name + "\n";
  for (const Facet& facet : facets) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (const Vec3f& p : facet) {
      text += "      vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
              std::to_string(p.z) + "\n";
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

Scene read(std::span<const std::uint8_t> bytes) {
  return read_stl(bytes, "part.stl");
}
Scene read_text(const std::string& text) {
  return read(test::bytes_of(text));
}

std::string message_of(const Bytes& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}
std::string message_of(const std::string& text) {
  return message_of(test::bytes_of(text));
}

using testing::AllOf;
using testing::HasSubstr;

TEST(StlReader, reads_binary_facets_into_an_indexed_mesh) {
  const Scene scene = read(binary_stl(tetrahedron()));
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "part");
  EXPECT_EQ(scene.materials.size(), 1U);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.positions.size(), 4U);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(test::is_closed(mesh));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 6);
}

TEST(StlReader, reads_ascii_facets) {
  const Scene scene = read_text(solid_text("a leg", tetrahedron()));
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "a leg");
  EXPECT_EQ(scene.meshes[0].positions.size(), 4U);
  EXPECT_DOUBLE_EQ(test::volume_of(scene.meshes[0]), 1.0 / 6);
}

TEST(StlReader, keeps_the_order_of_first_appearance) {
  const Scene scene = read(binary_stl(tetrahedron()));
  EXPECT_EQ(scene.meshes[0].positions[1], Vec3f(0, 1, 0));
  EXPECT_EQ(scene.meshes[0].triangles[3], (Triangle{2, 1, 3}));
}

TEST(StlReader, takes_a_binary_file_whose_header_starts_with_solid) {
  EXPECT_EQ(read(binary_stl(tetrahedron(), "solid leg")).meshes.at(0).triangles.size(), 4U);
  const std::string spaces = "solid " + std::string(74, ' ');
  EXPECT_EQ(read(binary_stl(tetrahedron(), spaces)).meshes.at(0).triangles.size(), 4U);
  Bytes padded = binary_stl(tetrahedron(), spaces);
  padded.push_back('!');
  EXPECT_EQ(read(padded).meshes.at(0).triangles.size(), 4U);
}

TEST(StlReader, makes_one_object_of_each_solid) {
  const Scene scene = read_text(solid_text("one", tetrahedron()) + solid_text("", tetrahedron()) +
                                solid_text("empty", {}) + solid_text("three", tetrahedron()));
  ASSERT_EQ(scene.objects.size(), 3U);
  EXPECT_EQ(scene.objects[0].name, "one");
  EXPECT_EQ(scene.objects[1].name, "part");
  EXPECT_EQ(scene.objects[2].name, "three");
  EXPECT_EQ(scene.meshes.at(scene.objects[2].mesh.index).triangles.size(), 4U);
}

TEST(StlReader, takes_any_case_line_end_and_layout) {
  std::string text = solid_text("leg", tetrahedron());
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return char(std::toupper(c)); });
  EXPECT_EQ(read_text(text).meshes.at(0).triangles.size(), 4U);
  std::string old_mac = solid_text("leg", tetrahedron());
  std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
  EXPECT_EQ(read_text(old_mac).meshes.at(0).triangles.size(), 4U);
  EXPECT_EQ(read_text("\xEF\xBB\xBF" + text).meshes.at(0).triangles.size(), 4U);
}

TEST(StlReader, reads_numbers_in_every_spelling) {
  const Scene scene = read_text(
      "solid\nfacet normal nan nan nan outer loop\nvertex +1.5e0 -.25 1E+2\n"
      "vertex 1e-60 -1e-400 0.1\nvertex 3 16777217 1.17549435e-38\nendloop endfacet endsolid");
  const std::vector<Vec3f>& p = scene.meshes.at(0).positions;
  EXPECT_EQ(p[0], Vec3f(1.5F, -0.25F, 100.0F));
  EXPECT_EQ(p[1], Vec3f(0.0F, 0.0F, 0.1F));
  EXPECT_EQ(p[2], Vec3f(3.0F, 16777216.0F, 1.17549435e-38F));
}

TEST(StlReader, joins_minus_zero_with_zero) {
  const Scene scene = read(binary_stl({{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)},
                                       {Vec3f(-0.0F, 0, -0.0F), Vec3f(0, 1, 0), Vec3f(0, 0, 1)}}));
  EXPECT_EQ(scene.meshes.at(0).positions.size(), 4U);
}

TEST(StlReader, tolerates_padding_but_not_a_wrong_count) {
  Bytes padded = binary_stl(tetrahedron());
  padded.insert(padded.end(), 49, 0xAB);
  EXPECT_EQ(read(padded).meshes.at(0).triangles.size(), 4U);
  padded.push_back(0xAB);
  EXPECT_THAT(message_of(padded),
              HasSubstr("the header says 4 facets, but the file has bytes for 5"));
  Bytes zeros = binary_stl(tetrahedron());
  zeros.insert(zeros.end(), 4096, 0);
  EXPECT_EQ(read(zeros).meshes.at(0).triangles.size(), 4U);
}

TEST(StlReader, rejects_a_huge_count_without_taking_memory) {
  Bytes bytes = binary_stl(tetrahedron());
  std::memset(bytes.data() + 80, 0xFF, 4);
  EXPECT_THAT(message_of(bytes), AllOf(HasSubstr("4294967295 facets"), HasSubstr("after facet 4")));
}

TEST(StlReader, rejects_coordinates_that_are_not_finite) {
  std::vector<Facet> facets = tetrahedron();
  facets[2][1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of(binary_stl(facets)), HasSubstr("facet 3 (byte 184)"));
  facets[2][1].y = -std::numeric_limits<float>::infinity();
  EXPECT_THAT(message_of(binary_stl(facets)), HasSubstr("not a finite number"));
  const std::string start = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 ";
  EXPECT_THAT(message_of(start + "nan 0"), AllOf(HasSubstr("part.stl:4:"), HasSubstr("\"nan\"")));
  EXPECT_THAT(message_of(start + "-inf 0"), HasSubstr("not finite"));
  EXPECT_THAT(message_of(start + "1e39 0"), HasSubstr("beyond the largest number"));
  EXPECT_THAT(message_of(start + "1,5 0"), HasSubstr("with a point, not a comma"));
  EXPECT_THAT(message_of(start + "1.5x 0"), HasSubstr("\"1.5x\", which is not a number"));
}

TEST(StlReader, names_the_line_of_a_misplaced_word) {
  EXPECT_THAT(message_of("solid a\nfacet normal 0 0 1\nouter lop\n"),
              AllOf(HasSubstr("part.stl:3: found \"lop\""), HasSubstr("\"loop\"")));
  EXPECT_THAT(message_of("solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0"),
              HasSubstr("cut off"));
  EXPECT_THAT(message_of(solid_text("a", tetrahedron()) + "rubbish"), HasSubstr("\"rubbish\""));
}

TEST(StlReader, rejects_files_without_facets) {
  EXPECT_THAT(message_of(Bytes()), HasSubstr("is empty"));
  EXPECT_THAT(message_of("abc"), HasSubstr("no STL file"));
  EXPECT_THAT(message_of("solid nothing\nendsolid nothing\n"), HasSubstr("no solid has a facet"));
  EXPECT_THAT(message_of(binary_stl({})), HasSubstr("no facets"));
}

TEST(StlReader, rejects_names_that_are_not_utf8_or_too_long) {
  EXPECT_THAT(message_of(solid_text("K\xF6rper", tetrahedron())), HasSubstr("is not UTF-8"));
  EXPECT_THAT(message_of(solid_text(std::string(100000, 'x'), tetrahedron())),
              HasSubstr("100000 bytes; use at most 1000"));
  EXPECT_EQ(read_text(solid_text("Körper", tetrahedron())).objects[0].name, "Körper");
}

TEST(StlReader, survives_cuts_and_changes_everywhere) {
  const Bytes binary = binary_stl(tetrahedron());
  test::cut_every_byte(binary, read);
  test::change_every_byte(binary, read);
  const Bytes ascii =
      test::bytes_of(solid_text("a leg", tetrahedron()) + solid_text("b", tetrahedron()));
  test::cut_every_byte(ascii, read);
  test::change_every_byte(ascii, read);
}

TEST(StlReader, reads_a_real_part_as_a_closed_mesh) {
  const std::filesystem::path path = test::shared_model("mesh/NIST_MBE_PMI_6.stl");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  const Scene scene = read(read_file_bytes(path));
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 10872U);
  EXPECT_TRUE(test::is_closed(scene.meshes[0]));
  EXPECT_GT(test::volume_of(scene.meshes[0]), 0);
}

}  // namespace
}  // namespace arris
