#include "io/gltf_reader.h"
#include "scene/scene_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <tuple>
#include <vector>

#include "arris/error.h"
#include "arris/io.h"
#include "io/gltf_test_file.h"
#include "support/cut_every_byte.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using nlohmann::json;
using test::GltfTestFile;
using test::tetrahedron_corners;
using test::tetrahedron_file;
using testing::HasSubstr;

Scene read(std::span<const std::uint8_t> bytes) {
  return read_gltf(bytes, "part.gltf", "/nonexistent");
}
Scene read_file(GltfTestFile file) {
  return read(file.gltf());
}

// The message with which the file is refused.
std::string refusal(GltfTestFile file) {
  try {
    read_file(std::move(file));
  } catch (const Error& error) {
    return error.what();
  }
  return "(was read)";
}

std::vector<Vec3f> corners_of(const Mesh& mesh) {
  std::vector<Vec3f> corners;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t i : t) corners.push_back(mesh.positions[i]);
  }
  return corners;
}

std::vector<Vec3f> tetrahedron_triangles() {
  std::vector<Vec3f> corners;
  for (const auto i : test::tetrahedron_indices()) corners.push_back(tetrahedron_corners()[i]);
  return corners;
}

void expect_near(Vec3d a, Vec3d b) {
  EXPECT_LT(length(a - b), 1e-9) << a.x << " " << a.y << " " << a.z;
}

// ------------------------------------------------------------------------------------------ meshes

TEST(GltfReader, reads_an_indexed_mesh_from_a_data_uri) {
  const Scene scene = read_file(tetrahedron_file());
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(corners_of(scene.meshes[0]), tetrahedron_triangles());
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "tet");
  EXPECT_EQ(scene.up, Vec3d(0, 1, 0));
  EXPECT_EQ(scene.materials.size(), 1U);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(GltfReader, reads_the_same_mesh_from_a_glb) {
  const Scene scene = read(tetrahedron_file().glb());
  EXPECT_EQ(corners_of(scene.meshes.at(0)), tetrahedron_triangles());
}

TEST(GltfReader, reads_buffers_beside_the_file) {
  const test::TemporaryFolder folder;
  GltfTestFile file = tetrahedron_file();
  file.json["buffers"] = {{{"byteLength", file.binary.size()}, {"uri", "my%20part.bin"}}};
  std::ofstream(folder.path() / "my part.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(file.binary.data()),
             std::streamsize(file.binary.size()));
  const std::string text = file.json.dump();
  std::ofstream(folder.path() / "part.gltf") << text;
  EXPECT_EQ(load_scene(folder.path() / "part.gltf").objects.size(), 1U);
  std::filesystem::remove(folder.path() / "my part.bin");
  EXPECT_THAT(refusal(file), HasSubstr("buffers[0]"));
  EXPECT_THAT(refusal(file), HasSubstr("my part.bin"));
}

TEST(GltfReader, takes_indices_of_every_unsigned_type) {
  for (const int component : {5121, 5123, 5125}) {
    GltfTestFile file = tetrahedron_file();
    std::vector<std::uint8_t> bytes;
    const int width = component == 5121 ? 1 : component == 5123 ? 2 : 4;
    for (const auto i : test::tetrahedron_indices()) {
      bytes.push_back(std::uint8_t(i));
      bytes.resize(bytes.size() + std::size_t(width) - 1);
    }
    file.json["meshes"][0]["primitives"][0]["indices"] =
        file.add_accessor(bytes, component, "SCALAR", 12);
    EXPECT_EQ(corners_of(read_file(file).meshes[0]), tetrahedron_triangles()) << component;
  }
}

TEST(GltfReader, reads_triangles_without_indices) {
  GltfTestFile file;
  const auto positions = file.add_vec3(tetrahedron_triangles());
  file.add("nodes", {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
  EXPECT_EQ(corners_of(read_file(file).meshes[0]), tetrahedron_triangles());
}

TEST(GltfReader, turns_strips_and_fans_into_triangles_of_one_orientation) {
  const std::vector<Vec3f> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  for (const int mode : {5, 6}) {
    GltfTestFile file;
    const std::vector<Vec3f> fan = {p[0], p[1], p[3], p[4], p[2]};
    const auto positions = file.add_vec3(mode == 5 ? p : fan);
    file.add(
        "nodes",
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", mode}})}});
    const std::vector<Vec3f> corners = corners_of(read_file(file).meshes[0]);
    ASSERT_EQ(corners.size(), 9U);
    float area = 0;
    for (std::size_t i = 0; i < 9; i += 3) {
      const float z = cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]).z;
      EXPECT_GE(z, 0) << "mode " << mode << " triangle " << i / 3;
      area += z / 2;
    }
    EXPECT_FLOAT_EQ(area, 1.5F);
  }
}

TEST(GltfReader, leaves_out_the_degenerate_joints_of_strips) {
  GltfTestFile file = tetrahedron_file();
  json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["indices"] = file.add_indices({0, 1, 2, 2, 3, 3, 1, 0});
  primitive["mode"] = 5;
  EXPECT_EQ(read_file(file).meshes[0].triangles.size(), 2U);
}

TEST(GltfReader, joins_the_primitives_of_a_mesh_and_keeps_their_materials) {
  GltfTestFile file;
  const auto positions = file.add_vec3(tetrahedron_corners());
  file.add("materials", {{"name", "red"}});
  file.add("materials", {{"name", "blue"}});
  json primitives;
  primitives.push_back({{"attributes", {{"POSITION", positions}}},
                        {"indices", file.add_indices({0, 2, 1, 0, 1, 3})},
                        {"material", 1}});
  primitives.push_back({{"attributes", {{"POSITION", positions}}},
                        {"indices", file.add_indices({0, 3, 2, 1, 2, 3})},
                        {"material", 0}});
  file.add("meshes", {{"primitives", primitives}});
  file.add("nodes", {{"mesh", 0}});
  const Scene scene = read_file(file);
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(corners_of(scene.meshes[0]), tetrahedron_triangles());
  EXPECT_EQ(scene.meshes[0].triangle_materials, (std::vector<MaterialId>{{1}, {1}, {0}, {0}}));
  EXPECT_EQ(scene.objects[0].material, MaterialId{1});
}

TEST(GltfReader, gives_a_mesh_of_one_material_to_the_object_alone) {
  GltfTestFile file = tetrahedron_file();
  file.add("materials", {{"name", "a"}});
  file.add("materials", {{"name", "b"}});
  file.json["meshes"][0]["primitives"][0]["material"] = 1;
  const Scene scene = read_file(file);
  EXPECT_TRUE(scene.meshes[0].triangle_materials.empty());
  EXPECT_EQ(scene.objects[0].material, MaterialId{1});
  EXPECT_EQ(scene.materials.size(), 2U);
}

TEST(GltfReader, keeps_only_the_vertices_that_a_mesh_uses) {
  GltfTestFile file;
  std::vector<Vec3f> many(1000, Vec3f(9, 9, 9));
  std::ranges::copy(tetrahedron_corners(), many.begin() + 500);
  const auto positions = file.add_vec3(many);
  const auto indices = file.add_indices({500, 502, 501});
  file.add(
      "nodes",
      {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
  EXPECT_EQ(read_file(file).meshes[0].positions.size(), 3U);
}

TEST(GltfReader, follows_byte_stride_and_offsets) {
  GltfTestFile file = tetrahedron_file();
  std::vector<float> interleaved = {-1};
  for (const Vec3f& p : tetrahedron_corners()) {
    for (const float f : {p.x, p.y, p.z, 77.0F, 78.0F}) interleaved.push_back(f);
  }
  const auto view = file.add_view(interleaved);
  file.json["bufferViews"][view]["byteStride"] = 20;
  file.json["accessors"][0]["bufferView"] = view;
  file.json["accessors"][0]["byteOffset"] = 4;
  EXPECT_EQ(corners_of(read_file(file).meshes[0]), tetrahedron_triangles());
}

TEST(GltfReader, reads_quantised_and_normalised_attributes) {
  GltfTestFile file = tetrahedron_file();
  file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  const std::vector<std::int16_t> positions = {0, 0,     0, 0, 32767, 0, 0,      0,
                                               0, 16384, 0, 0, 0,     0, -32768, 0};
  attributes["POSITION"] = file.add_accessor(positions, 5122, "VEC3", 4);
  file.json["bufferViews"].back()["byteStride"] = 8;
  file.json["accessors"].back()["normalized"] = true;
  const std::vector<std::int8_t> normals = {127, 0, 0,    0, 0,    127, 0, 0,
                                            0,   0, -127, 0, -128, 0,   0, 0};
  attributes["NORMAL"] = file.add_accessor(normals, 5120, "VEC3", 4);
  file.json["bufferViews"].back()["byteStride"] = 4;
  file.json["accessors"].back()["normalized"] = true;
  const std::vector<std::uint8_t> uvs = {0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 51, 102, 0, 0};
  attributes["TEXCOORD_0"] = file.add_accessor(uvs, 5121, "VEC2", 4);
  file.json["bufferViews"].back()["byteStride"] = 4;
  file.json["accessors"].back()["normalized"] = true;
  const Mesh mesh = read_file(file).meshes[0];
  const auto has = [&](Vec3f p, Vec3f n, Vec2f uv) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      if (length(mesh.positions[i] - p) < 1e-4F && length(mesh.normals[i] - n) < 1e-4F &&
          std::abs(mesh.uvs[i].x - uv.x) < 1e-6F && std::abs(mesh.uvs[i].y - uv.y) < 1e-6F) {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has({1, 0, 0}, {0, 1, 0}, {1, 0}));
  EXPECT_TRUE(has({0, 0.50002F, 0}, {0, 0, -1}, {0, 1}));
  EXPECT_TRUE(has({0, 0, -1}, {-1, 0, 0}, {0.2F, 0.4F}));
}

GltfTestFile tetrahedron_with_radii(const std::vector<float>& radii) {
  GltfTestFile file = tetrahedron_file();
  file.json["meshes"][0]["primitives"][0]["attributes"]["_ARRIS_RADIUS"] =
      file.add_accessor(radii, 5126, "SCALAR", radii.size());
  return file;
}

// By the places of their ends, for vertices are numbered anew.
std::vector<std::tuple<Vec3f, Vec3f, float>> placed_radii(const Mesh& mesh) {
  std::vector<std::tuple<Vec3f, Vec3f, float>> placed;
  for (const EdgeRadius& edge : mesh.edge_radii) {
    placed.emplace_back(mesh.positions[edge.vertices[0]], mesh.positions[edge.vertices[1]],
                        edge.radius);
  }
  return placed;
}

TEST(GltfReader, gives_edges_the_smaller_radius_of_their_ends) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto& p = tetrahedron_corners();  // numbered 0, 2, 1, 3
  EXPECT_THAT(placed_radii(read_file(tetrahedron_with_radii({0.5F, -1, 0.25F, 0})).meshes[0]),
              testing::ElementsAre(std::tuple(p[0], p[2], 0.25F), std::tuple(p[0], p[3], 0.0F),
                                   std::tuple(p[2], p[3], 0.0F)));
  EXPECT_TRUE(read_file(tetrahedron_with_radii({1, nan, nan, -1})).meshes[0].edge_radii.empty());
}

TEST(GltfReader, keeps_radii_of_one_primitive_beside_others_without) {
  GltfTestFile file = tetrahedron_with_radii({1, 1, 1, 1});
  json& primitives = file.json["meshes"][0]["primitives"];
  json plain = primitives[0];
  plain["attributes"].erase("_ARRIS_RADIUS");
  primitives[0]["indices"] = file.add_indices({0, 1, 2});
  primitives.insert(primitives.begin(), plain);
  primitives.push_back(plain);
  const Mesh mesh = read_file(file).meshes[0];
  ASSERT_EQ(mesh.edge_radii.size(), 3U);
  for (const EdgeRadius& edge : mesh.edge_radii) {
    for (const std::uint32_t i : edge.vertices) EXPECT_TRUE(i >= 4 && i < 7) << i;
  }
}

TEST(GltfReader, refuses_radii_of_another_type_or_number) {
  EXPECT_THAT(refusal(tetrahedron_with_radii({1, 1, 1})),
              HasSubstr("meshes[0].primitives[0]: _ARRIS_RADIUS has 3 elements, POSITION 4"));
  EXPECT_THAT(refusal(tetrahedron_with_radii({1, std::numeric_limits<float>::infinity(), 1, 1})),
              HasSubstr("the _ARRIS_RADIUS of vertex 1 is infinite"));
  GltfTestFile file = tetrahedron_with_radii({1, 1, 1, 1});
  file.json["accessors"].back()["componentType"] = 5125;
  EXPECT_THAT(refusal(file), HasSubstr("the values must be floats"));
  file.json["accessors"].back()["componentType"] = 5126;
  file.json["accessors"].back()["type"] = "VEC2";
  EXPECT_THAT(refusal(file), HasSubstr("has 2 components where 1 are needed"));
}

TEST(GltfReader, replaces_the_elements_of_sparse_accessors) {
  GltfTestFile file = tetrahedron_file();
  const auto indices = file.add_view(std::vector<std::uint8_t>{1, 3});
  const auto values = file.add_view(std::vector<Vec3f>{{5, 0, 0}, {0, 0, 7}});
  file.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  const std::vector<Vec3f> corners = corners_of(read_file(file).meshes[0]);
  EXPECT_EQ(corners[2], Vec3f(5, 0, 0));
  EXPECT_EQ(corners[1], Vec3f(0, 1, 0));
  EXPECT_EQ(corners[5], Vec3f(0, 0, 7));
}

TEST(GltfReader, starts_sparse_accessors_without_data_from_zeros) {
  GltfTestFile file = tetrahedron_file();
  const auto indices = file.add_view(std::vector<std::uint16_t>{1, 2, 3});
  const auto values = file.add_view(std::vector<Vec3f>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  file.json["accessors"][0].erase("bufferView");
  file.json["accessors"][0]["sparse"] = {
      {"count", 3},
      {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  EXPECT_EQ(corners_of(read_file(file).meshes[0]), tetrahedron_triangles());
}

TEST(GltfReader, replaces_normals_that_are_zero_or_not_finite) {
  GltfTestFile file = tetrahedron_file();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.add_vec3({{0, 0, 0}, {0, 0, 2}, {nan, 0, 0}, {0, 1, 0}});
  const Mesh mesh = read_file(file).meshes[0];
  for (const Vec3f& n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-6);
}

TEST(GltfReader, keeps_primitives_without_normals_flat_beside_smooth_ones) {
  GltfTestFile file = tetrahedron_file();
  const json smooth = {
      {"attributes",
       {{"POSITION", 0}, {"NORMAL", file.add_vec3({{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}})}}},
      {"indices", file.add_indices({0, 1, 2})}};
  file.json["meshes"][0]["primitives"].push_back(smooth);
  const Mesh mesh = read_file(file).meshes[0];
  ASSERT_EQ(mesh.triangles.size(), 5U);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t t = 0; t < 4; ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const Vec3f flat = normalize(cross(mesh.positions[triangle[1]] - mesh.positions[triangle[0]],
                                       mesh.positions[triangle[2]] - mesh.positions[triangle[0]]));
    for (const std::uint32_t i : triangle) EXPECT_LT(length(mesh.normals[i] - flat), 1e-6F);
  }
  EXPECT_EQ(mesh.normals[mesh.triangles[4][0]], Vec3f(0, 1, 0));
}

TEST(GltfReader, leaves_out_lines_with_a_note_and_refuses_a_file_of_lines_alone) {
  GltfTestFile file = tetrahedron_file();
  json lines = file.json["meshes"][0]["primitives"][0];
  lines["mode"] = 1;
  file.json["meshes"][0]["primitives"].push_back(lines);
  const Scene scene = read_file(file);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 4U);
  EXPECT_THAT(scene.notes, testing::ElementsAre("1 primitives of points and lines left out"));
  file.json["meshes"][0]["primitives"].erase(0);
  EXPECT_THAT(refusal(file), HasSubstr("no triangles"));
}

// ------------------------------------------------------------------------------------------- nodes

TEST(GltfReader, multiplies_transforms_down_the_tree_and_shares_meshes) {
  GltfTestFile file = tetrahedron_file();
  const double s = std::sqrt(0.5);
  file.json["nodes"] = {
      {{"children", {1, 2}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
      {{"mesh", 0}, {"rotation", {0, 0, s, s}}, {"translation", {1, 2, 3}}},
      {{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}}};
  const Scene scene = read_file(file);
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
  // 90 degrees about z, then the parent's scale and translation
  expect_near(transform_point(scene.objects[0].world_from_object, {1, 0, 0}), {12, 6, 6});
  expect_near(transform_point(scene.objects[1].world_from_object, {1, 0, 0}), {18, 12, 12});
}

TEST(GltfReader, shows_the_default_scene_else_the_first_else_all_roots) {
  GltfTestFile file = tetrahedron_file();
  file.json["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}};
  EXPECT_EQ(read_file(file).objects.size(), 2U);
  file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(read_file(file).objects.at(0).name, "a");
  file.json["scene"] = 1;
  EXPECT_EQ(read_file(file).objects.at(0).name, "b");
}

TEST(GltfReader, refuses_nodes_that_are_no_trees) {
  GltfTestFile file = tetrahedron_file();
  file.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
  EXPECT_THAT(refusal(file), HasSubstr("its own ancestor"));
  file.json["nodes"] = {{{"mesh", 0}, {"children", {0}}}};
  EXPECT_THAT(refusal(file), HasSubstr("its own ancestor"));
  file.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(refusal(file), HasSubstr("child of another node"));
  file.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
  EXPECT_THAT(refusal(file), HasSubstr("child of another node"));
  file.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
  file.json["scenes"] = {{{"nodes", {0, 1}}}};
  EXPECT_THAT(refusal(file), HasSubstr("scenes[0].nodes[1]"));
}

TEST(GltfReader, reads_a_chain_of_100000_nodes) {
  GltfTestFile file = tetrahedron_file();
  json nodes = json::array();
  for (int i = 1; i < 100000; ++i) nodes.push_back({{"children", {i}}});
  nodes.push_back({{"mesh", 0}});
  file.json["nodes"] = std::move(nodes);
  EXPECT_EQ(read_file(file).objects.size(), 1U);
}

TEST(GltfReader, leaves_out_objects_of_scale_0_with_a_note) {
  GltfTestFile file = tetrahedron_file();
  file.add("nodes", {{"mesh", 0}, {"scale", {1, 0, 1}}});
  const Scene scene = read_file(file);
  EXPECT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.notes.size(), 1U);
}

// --------------------------------------------------------------------------------- rounding extras

TEST(GltfReader, takes_the_rounding_radius_from_node_else_mesh_else_scene_else_asset) {
  GltfTestFile file = tetrahedron_file();
  file.json["nodes"] = {{{"mesh", 0}, {"extras", {{"arris_radius", "12%"}}}}, {{"mesh", 0}}};
  file.json["scenes"] = {{{"nodes", {0, 1}}}};
  file.json["asset"]["extras"] = {{"arris_radius", "auto"}};
  Scene scene = read_file(file);
  EXPECT_EQ(std::get<PercentOfInradius>(scene.objects[0].rounding->radius).percent, 12);
  EXPECT_EQ(scene.objects[0].rounding->method, RoundMethod::exact);
  EXPECT_FALSE(scene.objects[1].rounding);
  EXPECT_TRUE(std::holds_alternative<AutoRadius>(scene.rounding->radius));
  file.json["meshes"][0]["extras"] = {{"arris_radius", 0.25}};
  file.json["scenes"][0]["extras"] = {{"arris_radius", "none"}};
  scene = read_file(file);
  EXPECT_EQ(std::get<double>(scene.objects[1].rounding->radius), 0.25);
  EXPECT_EQ(scene.rounding->method, RoundMethod::none);
  file.json["meshes"][0]["extras"] = {{"arris_radius", -1}};
  EXPECT_THAT(refusal(file), HasSubstr("meshes[0].extras.arris_radius"));
  file.json["meshes"][0]["extras"] = {{"arris_radius", "soft"}};
  EXPECT_THAT(refusal(file), HasSubstr("\"12%\""));
}

// ------------------------------------------------------------------------------ cameras and lights

// What it turns about in a viewer.
TEST(GltfReader, cameras_look_at_what_is_beside_the_middle_of_the_model) {
  GltfTestFile file = tetrahedron_file();
  file.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  file.add("nodes", {{"camera", 0}, {"translation", {0.25, 0.5, 300}}});
  const Scene scene = read_file(file);
  const Bounds bounds = world_bounds(scene);
  expect_near(scene.camera->target, {0.25, 0.5, bounds.center().z});
}

TEST(GltfReader, takes_the_first_perspective_camera) {
  GltfTestFile file = tetrahedron_file();
  file.json["cameras"] = {
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", kPi / 6}, {"znear", 0.1}}}}};
  file.add("nodes", {{"camera", 0}});
  file.add("nodes", {{"camera", 1}, {"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}});
  const Scene scene = read_file(file);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->position, Vec3d(1, 2, 3));
  expect_near(scene.camera->target, {1, 2, 4});
  expect_near(scene.camera->up, {0, 1, 0});
  EXPECT_NEAR(scene.camera->fov_deg, 30, 1e-9);
  EXPECT_THAT(scene.notes, testing::ElementsAre(HasSubstr("orthographic")));
}

TEST(GltfReader, converts_punctual_lights_by_683_lumens_per_watt) {
  GltfTestFile file = tetrahedron_file();
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
      {{"type", "spot"},
       {"intensity", 1366},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}},
      {{"type", "directional"}, {"intensity", 2049}}};
  for (int i = 0; i < 3; ++i) {
    file.add("nodes", {{"translation", {i, 7, 0}},
                       {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  const Scene scene = read_file(file);
  ASSERT_EQ(scene.lights.size(), 3U);
  const auto& point = std::get<PointLight>(scene.lights[0]);
  EXPECT_EQ(point.position, Vec3d(0, 7, 0));
  EXPECT_EQ(point.intensity, Rgb(1, 0.5F, 0));
  const auto& spot = std::get<SpotLight>(scene.lights[1]);
  EXPECT_EQ(spot.position, Vec3d(1, 7, 0));
  EXPECT_EQ(spot.direction, Vec3d(0, 0, -1));
  EXPECT_EQ(spot.intensity, Rgb(2, 2, 2));
  EXPECT_EQ(spot.inner_angle, 0.1);
  EXPECT_EQ(spot.outer_angle, 0.4);
  EXPECT_EQ(std::get<DirectionalLight>(scene.lights[2]).irradiance, Rgb(3, 3, 3));
}

// -------------------------------------------------------------------------------------- hostile files

TEST(GltfReader, stays_sound_when_cut_at_every_byte) {
  test::cut_every_byte(tetrahedron_file().glb(), read);
  test::cut_every_byte(tetrahedron_file().gltf(), read);
}

TEST(GltfReader, stays_sound_when_any_byte_changes) {
  test::change_every_byte(tetrahedron_file().glb(), read);
  test::change_every_byte(tetrahedron_file().gltf(), read);
}

TEST(GltfReader, refuses_numbers_that_lead_outside_the_buffers) {
  const auto with = [](const char* pointer, const json& value) {
    GltfTestFile file = tetrahedron_file();
    file.gltf();
    file.json[json::json_pointer(pointer)] = value;
    return refusal(file);
  };
  EXPECT_THAT(with("/accessors/0/count", 5), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/accessors/0/count", 4294967295U), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/accessors/0/count", 9007199254740992), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/accessors/0/count", -1), HasSubstr("accessors[0].count"));
  EXPECT_THAT(with("/accessors/0/count", 1e300), HasSubstr("accessors[0].count"));
  EXPECT_THAT(with("/accessors/0/count", 1.5), HasSubstr("accessors[0].count"));
  EXPECT_THAT(with("/accessors/0/byteOffset", 9007199254740991), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/accessors/0/bufferView", 2), HasSubstr("the file has 2 bufferViews"));
  EXPECT_THAT(with("/accessors/0/type", "VEC2"), HasSubstr("2 components where 3"));
  EXPECT_THAT(with("/accessors/1/componentType", 5126), HasSubstr("unsigned integers"));
  EXPECT_THAT(with("/bufferViews/0/byteLength", 1e15), HasSubstr("bufferViews[0]"));
  EXPECT_THAT(with("/bufferViews/0/byteOffset", 1e15), HasSubstr("bufferViews[0]"));
  EXPECT_THAT(with("/bufferViews/0/byteStride", 252), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/bufferViews/0/byteStride", 8), HasSubstr("overlap"));
  EXPECT_THAT(with("/buffers/0/byteLength", 1e12), HasSubstr("only 72 are there"));
  EXPECT_THAT(with("/meshes/0/primitives/0/indices", 7),
              HasSubstr("meshes[0].primitives[0].indices"));
  EXPECT_THAT(with("/meshes/0/primitives/0/material", 0), HasSubstr("the file has 0 materials"));
  EXPECT_THAT(with("/nodes/0/mesh", 1), HasSubstr("nodes[0].mesh: 1 is out of range"));
  EXPECT_THAT(with("/nodes/0/matrix", {1, 2}), HasSubstr("16 numbers"));
  EXPECT_THAT(with("/nodes/0/rotation", {0, 0, 0, 0}), HasSubstr("quaternion"));
}

TEST(GltfReader, refuses_indices_beyond_the_vertices) {
  GltfTestFile file = tetrahedron_file();
  file.json["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 1, 4});
  EXPECT_THAT(refusal(file), HasSubstr("index 4 at position 2 is beyond the 4 vertices"));
}

TEST(GltfReader, refuses_positions_that_are_not_finite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfTestFile file;
    const auto positions = file.add_vec3({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}});
    file.add("nodes", {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_THAT(refusal(file), HasSubstr("vertex 2 is not finite"));
  }
}

TEST(GltfReader, refuses_zeros_that_are_not_in_the_file) {
  GltfTestFile file;
  const auto zeros =
      file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3e9}});
  file.add("nodes", {{"mesh", file.add_mesh({{"attributes", {{"POSITION", zeros}}}})}});
  EXPECT_THAT(refusal(file), HasSubstr("far more than the file holds"));
}

TEST(GltfReader, refuses_meshes_that_repeat_the_same_data_without_end) {
  GltfTestFile file;
  const auto positions = file.add_vec3(std::vector<Vec3f>(3000));
  json primitives = json::array();
  for (int i = 0; i < 3000; ++i) primitives.push_back({{"attributes", {{"POSITION", positions}}}});
  file.add("meshes", {{"primitives", primitives}});
  file.add("nodes", {{"mesh", 0}});
  EXPECT_THAT(refusal(file), HasSubstr("far more than the file holds"));
}

TEST(GltfReader, refuses_json_nested_without_end) {
  std::string text = R"({"asset":{"version":"2.0"},"extras":)" + std::string(500000, '[');
  EXPECT_EQ(test::problem_of_reading(test::bytes_of(text), read), "");
  text += std::string(500000, ']') + "}";
  EXPECT_THROW(read(test::bytes_of(text)), Error);
}

TEST(GltfReader, names_required_extensions_that_it_lacks_and_the_remedy) {
  GltfTestFile file = tetrahedron_file();
  file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(refusal(file), HasSubstr("KHR_draco_mesh_compression"));
  EXPECT_THAT(refusal(file), HasSubstr("without mesh compression"));
  file.json["extensionsRequired"] = {"ACME_magic"};
  EXPECT_THAT(refusal(file), HasSubstr("ACME_magic"));
  file.json.erase("extensionsRequired");
  file.json["extensionsUsed"] = {"ACME_magic", "KHR_materials_ior"};
  EXPECT_THAT(read_file(file).notes, testing::ElementsAre("extensions left out: \"ACME_magic\""));
}

TEST(GltfReader, refuses_other_versions_and_other_files) {
  GltfTestFile file = tetrahedron_file();
  file.json["asset"]["version"] = "1.0";
  EXPECT_THAT(refusal(file), HasSubstr("glTF version \"1.0\""));
  EXPECT_EQ(test::problem_of_reading(test::bytes_of("solid x"), read), "");
  EXPECT_EQ(test::problem_of_reading(test::bytes_of("[]"), read), "");
  EXPECT_EQ(test::problem_of_reading(test::bytes_of("{\"asset\":\"\xFF\"}"), read), "");
}

// ----------------------------------------------------------------------------------------- real files

std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("ARRIS_DATA_DIR")) return folder;
  return std::filesystem::path(ARRIS_SOURCE_DIR) / "../shared/data";
}

struct RealFile {
  const char* name;
  std::size_t objects, meshes, triangles;  // triangles of all objects
};

class RealGltf : public testing::TestWithParam<RealFile> {};

TEST_P(RealGltf, has_the_known_counts) {
  const auto path = data_folder() / "mesh" / GetParam().name;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Scene scene = load_scene(path);
  std::size_t triangles = 0;
  for (const Object& object : scene.objects) {
    triangles += scene.meshes[object.mesh.index].triangles.size();
  }
  EXPECT_EQ(scene.objects.size(), GetParam().objects);
  EXPECT_EQ(scene.meshes.size(), GetParam().meshes);
  EXPECT_EQ(triangles, GetParam().triangles);
  EXPECT_EQ(test::problem_of(scene), "");
}

INSTANTIATE_TEST_SUITE_P(Shared, RealGltf,
                         testing::Values(RealFile{"2CylinderEngine.glb", 67, 29, 121496},
                                         RealFile{"scene1_none.glb", 2001, 2001, 41442},
                                         RealFile{"blocks_none.glb", 727, 727, 275882}));

}  // namespace
}  // namespace arris
