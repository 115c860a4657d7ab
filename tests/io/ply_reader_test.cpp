#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "io/mesh_readers.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/mesh_checks.h"

namespace arris {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::AllOf;
using testing::HasSubstr;

Scene read(std::span<const std::uint8_t> bytes) {
  return read_ply(bytes, "part.ply");
}
Scene read_text(const std::string& text) {
  return read(test::bytes_of(text));
}
std::string message_of(const std::string& text) {
  return test::error_message(read, test::bytes_of(text));
}

const std::string kCubeVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
const std::string kCubeFaces = "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

std::string header(const std::string& format, const std::string& vertices,
                   const std::string& faces) {
  return "ply\nformat " + format + " 1.0\ncomment made for a test\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ascii_cube() {
  return header("ascii", "8", "6") + kCubeVertices + kCubeFaces;
}

// Appends values to a file in either byte order.
class BinaryFile {
 public:
  BinaryFile(const std::string& header, std::endian order)
      : bytes(test::bytes_of(header)), order_(order) {}

  template <class T>
  void add(T value) {
    Bytes raw(sizeof value);
    std::memcpy(raw.data(), &value, sizeof value);
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }

  Bytes bytes;

 private:
  std::endian order_;
};

std::string format_name(std::endian order) {
  return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

// The unit cube with unread properties and elements between, in every type.
Bytes binary_cube(std::endian order) {
  BinaryFile file(
      "ply\r\nformat " + format_name(order) +
          " 1.0\r\nelement camera 2\r\nproperty double f\r\nproperty list ushort short k\r\n"
          "element vertex 8\r\nproperty uchar red\r\nproperty double x\r\n"
          "property short y\r\nproperty float z\r\nproperty list int char w\r\n"
          "element face 6\r\nproperty char flag\r\nproperty list uint ushort vertex_index\r\n"
          "property int8 last\r\nend_header\r\n",
      order);
  for (int camera = 0; camera < 2; ++camera) {
    file.add(1.5);
    file.add(std::uint16_t(camera));
    if (camera == 1) file.add(std::int16_t(-3));
  }
  for (int i = 0; i < 8; ++i) {
    file.add(std::uint8_t(200));
    const int column = (i + 1) % 4 / 2;
    const int row = i / 4;
    file.add(double(column));
    file.add(std::int16_t(i % 4 / 2));
    file.add(float(row));
    file.add(std::int32_t(1));
    file.add(std::int8_t(7));
  }
  const std::uint16_t faces[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& face : faces) {
    file.add(std::int8_t(1));
    file.add(std::uint32_t(4));
    for (const std::uint16_t corner : face) file.add(corner);
    file.add(std::int8_t(1));
  }
  return file.bytes;
}

void expect_unit_cube(const Scene& scene) {
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "part");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_TRUE(test::is_closed(mesh));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1);
}

TEST(PlyReader, reads_ascii) {
  expect_unit_cube(read_text(ascii_cube()));
}

TEST(PlyReader, reads_binary_of_either_order_and_any_types) {
  const Scene little = read(binary_cube(std::endian::little));
  expect_unit_cube(little);
  EXPECT_THAT(little.notes, testing::ElementsAre(HasSubstr("colours are not read")));
  expect_unit_cube(read(binary_cube(std::endian::big)));
}

TEST(PlyReader, takes_any_line_end) {
  std::string dos;
  for (const char c : ascii_cube()) dos += c == '\n' ? "\r\n" : std::string(1, c);
  expect_unit_cube(read_text(dos));
  std::string old_mac = ascii_cube();
  std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
  expect_unit_cube(read_text(old_mac));
}

TEST(PlyReader, reads_normals_and_texture_coordinates_under_each_name) {
  for (const std::string names : {"s t", "u v", "texture_u texture_v"}) {
    const std::string u = names.substr(0, names.find(' ')), v = names.substr(names.find(' ') + 1);
    const Scene scene = read_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float nx\nproperty float ny\n"
        "property float nz\nproperty float x\nproperty float y\nproperty float z\nproperty float " +
        v + "\nproperty float " + u +
        "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 3 0 0 0 0 0\n0 0 1 1 0 0 0.25 1\n0 0 1 0 1 0 1 0\n3 0 1 2\n");
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.normals.size(), 3U);
    EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.positions[1], Vec3f(1, 0, 0));
    ASSERT_EQ(mesh.uvs.size(), 3U);
    EXPECT_EQ(mesh.uvs[1], (Vec2f{1, 0.75F}));
  }
}

TEST(PlyReader, cuts_a_concave_face_exactly) {
  const Scene scene = read_text(header("ascii", "6", "1") +
                                "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(test::area_of(scene.meshes[0]), 3);
}

// An L of 6 corners as one face, whose vertices have values, and with edges that have values of their own.
std::string face_with_radii(const std::string& vertex_radii, const std::string& edges) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nproperty float arris_radius\nelement face 1\n"
      "property list uchar int vertex_indices\nelement edge " +
      std::to_string(std::count(edges.begin(), edges.end(), '\n')) +
      "\nproperty uchar red\nproperty int vertex1\nproperty int vertex2\n"
      "property float radius\nend_header\n";
  std::istringstream radii(vertex_radii);
  for (const char* position : {"0 0 0", "2 0 0", "2 1 0", "1 1 0", "1 2 0", "0 2 0"}) {
    std::string radius;
    radii >> radius;
    text += std::string(position) + " " + radius + "\n";
  }
  return text + "6 0 1 2 3 4 5\n" + edges;
}

TEST(PlyReader, gives_sides_of_faces_the_smaller_radius_of_their_ends) {
  const Scene scene = read_text(face_with_radii("0.5 0.25 0 nan -1 0.75", ""));
  EXPECT_EQ(scene.meshes.at(0).edge_radii,
            (std::vector<EdgeRadius>{{{0, 1}, 0.25F}, {{0, 5}, 0.5F}, {{1, 2}, 0}}));
  EXPECT_TRUE(read_text(face_with_radii("-1 1 -1 1 -1 nan", "")).meshes.at(0).edge_radii.empty());
}

TEST(PlyReader, gives_edges_their_own_radius_before_that_of_their_vertices) {
  const Scene scene = read_text(
      face_with_radii("1 1 1 -1 -1 -1", "9 1 0 0.25\n9 4 3 0.5\n9 2 1 -1\n9 4 3 0.125\n"));
  EXPECT_EQ(scene.meshes.at(0).edge_radii,
            (std::vector<EdgeRadius>{{{0, 1}, 0.25F}, {{3, 4}, 0.125F}}));
}

TEST(PlyReader, reads_edges_with_radii_from_binary_data_before_faces) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    BinaryFile file("ply\nformat " + format_name(order) +
                        " 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                        "property float z\nproperty double arris_radius\nelement edge 2\n"
                        "property ushort vertex1\nproperty uint vertex2\nproperty double radius\n"
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n",
                    order);
    for (int i = 0; i < 3; ++i) {
      for (const float x : {float(i % 2), float(i / 2), 0.0F}) file.add(x);
      file.add(0.125);
    }
    for (const std::uint32_t i : {1U, 2U}) {
      file.add(std::uint16_t(0));
      file.add(i);
      file.add(i == 1 ? 0.75 : std::numeric_limits<double>::quiet_NaN());
    }
    file.add(std::uint8_t(3));
    for (const int i : {0, 1, 2}) file.add(i);
    EXPECT_EQ(read(file.bytes).meshes.at(0).edge_radii,
              (std::vector<EdgeRadius>{{{0, 1}, 0.75F}, {{1, 2}, 0.125F}}));
    test::cut_every_byte(file.bytes, read);
    test::change_every_byte(file.bytes, read);
  }
}

TEST(PlyReader, names_what_is_wrong_with_edges) {
  const auto message = [](const std::string& edge) {
    return message_of(face_with_radii("1 1 1 1 1 1", "9 0 1 1\n" + edge + "\n"));
  };
  EXPECT_THAT(message("9 6 0 1"),
              AllOf(HasSubstr("part.ply:24: vertex 6 is out of range: the file has 6, ")));
  EXPECT_THAT(message("9 0 -1 1"), HasSubstr("vertex -1 is out of range"));
  EXPECT_THAT(message("9 2 2 1"), HasSubstr("both ends of the edge are vertex 2"));
  EXPECT_THAT(message("9 0 1 inf"), HasSubstr("radius is \"inf\", which is not finite"));
  EXPECT_THAT(message("9 000 1"), HasSubstr("the line ends where radius should be"));
  const std::string vertex =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string edge = "element edge 1\nproperty float vertex1\nproperty int vertex2\n";
  EXPECT_THAT(
      message_of("ply\nformat ascii 1.0\n" + edge + "property float radius\n" + vertex + face),
      HasSubstr("\"edge\" comes before \"vertex\""));
  EXPECT_THAT(
      message_of("ply\nformat ascii 1.0\n" + vertex + edge + "property float radius\n" + face),
      HasSubstr("the vertices of an edge have a type that is no integer"));
  // Without radii edges are skipped.
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\n" + edge + vertex + face +
                         "7 7\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
              HasSubstr("no error"));
}

TEST(PlyReader, rejects_huge_counts_without_taking_memory) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(message_of(header("ascii", "3", "4294967295") + three + "3 0 1 2\n"),
              AllOf(HasSubstr("4294967295 times \"face\""), HasSubstr("bytes are left")));
  EXPECT_THAT(message_of(header("binary_little_endian", "4294967295", "1") + three),
              HasSubstr("at most 4294967294"));
  EXPECT_THAT(message_of(header("binary_little_endian", "4294967294", "1") + three),
              HasSubstr("4294967294 times \"vertex\" of at least 12 bytes"));
  EXPECT_THAT(message_of(header("ascii", "99999999999999999999", "1")),
              HasSubstr("\"99999999999999999999\""));
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\nelement nothing 9000000000000000000\n" +
                         ascii_cube().substr(21)),
              HasSubstr("no error"));
  BinaryFile list(
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nproperty list uint double w\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n",
      std::endian::little);
  for (int i = 0; i < 3; ++i) list.add(0.0F);
  list.add(std::uint32_t(0xFFFFFFFF));
  for (int i = 0; i < 100; ++i) list.add(0.0);
  EXPECT_THAT(test::error_message(read, list.bytes),
              AllOf(HasSubstr("vertex 0 (byte"), HasSubstr("4294967295 items")));
}

TEST(PlyReader, names_place_and_value_of_what_is_wrong) {
  const std::string head = header("ascii", "3", "1");  // 10 lines
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(
      message_of(head + three + "3 0 1 3\n"),
      AllOf(HasSubstr("part.ply:14: vertex 3 is out of range"), HasSubstr("3, numbered from 0")));
  EXPECT_THAT(message_of(head + three + "3 0 1 -1\n"), HasSubstr("vertex -1"));
  EXPECT_THAT(message_of(head + three + "2 0 1 2\n"), HasSubstr("after the element's last value"));
  EXPECT_THAT(message_of(head + three + "-3 0 1 2\n"), HasSubstr("-3 items"));
  EXPECT_THAT(message_of(head + three + "3 0 1 2\n4\n"), HasSubstr("more lines follow"));
  EXPECT_THAT(message_of(head + "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n"),
              AllOf(HasSubstr("part.ply:11:"), HasSubstr("\"inf\"")));
  EXPECT_THAT(message_of(head + "0 0\n1 0 0\n0 1 0\n3 0 1 2 \n"), HasSubstr("where z should be"));
  BinaryFile nan(header("binary_big_endian", "1", "1"), std::endian::big);
  nan.add(0.0F);
  nan.add(std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < 10; ++i) nan.add(0.0F);
  EXPECT_THAT(test::error_message(read, nan.bytes),
              AllOf(HasSubstr("part.ply: vertex 0 (byte"), HasSubstr("y is not a finite number")));
}

TEST(PlyReader, rejects_a_double_beyond_float) {
  BinaryFile file(
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n"
      "property double y\nproperty double z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n",
      std::endian::little);
  for (const double value : {0.0, 1e39, 0.0, 0.0, 0.0, 0.0}) file.add(value);
  EXPECT_THAT(test::error_message(read, file.bytes), HasSubstr("y is 1e+39, beyond the largest"));
}

TEST(PlyReader, rejects_headers_it_can_not_read) {
  const std::string rest =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(message_of(""), HasSubstr("does not start with the line \"ply\""));
  EXPECT_THAT(message_of("ply\nformat ascii 2.0\n"), HasSubstr("\"2.0\"; only 1.0"));
  EXPECT_THAT(message_of("ply\nformat xml 1.0\n"), HasSubstr("\"xml\""));
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\n" + rest), HasSubstr("before \"end_header\""));
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\n" + rest + "end_header\n0 0 0\n"),
              HasSubstr("cloud of points"));
  EXPECT_THAT(message_of("ply\n" + rest + "end_header\n"), HasSubstr("no line \"format\""));
  EXPECT_THAT(message_of("ply\nelement \xFF 1\n"), HasSubstr("is not UTF-8"));
  EXPECT_THAT(message_of("ply\nelement a\x1B[1m 1\n"), HasSubstr("control character"));
  EXPECT_THAT(message_of("ply\nproperty float x\n"), HasSubstr("before the first element"));
  EXPECT_THAT(message_of("ply\n" + rest + "property float x\n"), HasSubstr("appears twice"));
  EXPECT_THAT(message_of("ply\n" + rest + "property long w\n"), HasSubstr("\"long\""));
  EXPECT_THAT(message_of("ply\nformat ascii 1.0\n" + rest +
                         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"),
              HasSubstr("strips are not read"));
}

TEST(PlyReader, survives_cuts_and_changes_everywhere) {
  const Bytes ascii = test::bytes_of(ascii_cube());
  test::cut_every_byte(ascii, read);
  test::change_every_byte(ascii, read);
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    test::cut_every_byte(binary_cube(order), read);
    test::change_every_byte(binary_cube(order), read);
  }
}

}  // namespace
}  // namespace arris
