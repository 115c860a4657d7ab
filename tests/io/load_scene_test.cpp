#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "arris/io.h"
#include "base/nearest_name.h"
#include "io/file_bytes.h"
#include "io/scene_bytes.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/mesh_checks.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";

class LoadScene : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_ / name;
    write_file_whole(path, test::bytes_of(text));
    return path;
  }
  std::string message_of(const std::filesystem::path& path) {
    return test::error_message([](const auto& p) { return load_scene(p); }, path);
  }

  test::TemporaryFolder folder_;
};

TEST_F(LoadScene, reads_each_format_by_its_extension) {
  for (const auto& [name, text] : {std::pair("a.stl", kStl), std::pair("b.OBJ", kObj),
                                   std::pair("c.Ply", kPly), std::pair("d.off", kOff)}) {
    const Scene scene = load_scene(write(name, text));
    ASSERT_EQ(scene.objects.size(), 1U) << name;
    EXPECT_EQ(scene.objects[0].name, std::string(1, name[0]));
    EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1U);
    EXPECT_EQ(scene.materials.size(), 1U);
  }
}

TEST_F(LoadScene, names_the_format_of_a_wrong_extension) {
  EXPECT_THAT(message_of(write("a.stl", kPly)),
              AllOf(HasSubstr("a.stl: holds PLY data, not STL"), HasSubstr(".ply")));
  EXPECT_THAT(message_of(write("a.ply", kOff)), HasSubstr("holds OFF data, not PLY"));
  EXPECT_THAT(message_of(write("a.obj", kStl)), HasSubstr("holds STL data, not OBJ"));
  EXPECT_THAT(message_of(write("a.off", kStl)), HasSubstr("holds STL data, not OFF"));
}

TEST_F(LoadScene, suggests_an_extension_for_an_unknown_one) {
  EXPECT_THAT(message_of("part.slt"),
              AllOf(HasSubstr("\".slt\""), HasSubstr("did you mean \".stl\"?"), HasSubstr(".ply")));
  EXPECT_THAT(message_of("part.jpeg"),
              AllOf(HasSubstr("\".jpeg\" is not known"), HasSubstr(".obj")));
  EXPECT_THAT(message_of("part"), HasSubstr("has no extension"));
}

TEST_F(LoadScene, says_what_is_wrong_with_the_file_itself) {
  EXPECT_THAT(message_of(folder_ / "gone.stl"), HasSubstr("No such file"));
  EXPECT_THAT(message_of(write("empty.obj", "")), HasSubstr("is empty"));
  std::filesystem::create_directory(folder_ / "folder.stl");
  EXPECT_THAT(message_of(folder_ / "folder.stl"), HasSubstr("is a folder"));
}

TEST_F(LoadScene, finds_the_libraries_and_pictures_beside_a_model) {
  write("looks.mtl", "newmtl red\nKd 1 0 0\n");
  const Scene scene = load_scene(write("a.obj", "mtllib looks.mtl\nusemtl red\n" + kObj));
  EXPECT_EQ(scene.materials.at(scene.objects.at(0).material.index).base_color, Rgb(1, 0, 0));
  EXPECT_THAT(message_of(write("b.obj", "mtllib gone.mtl\n" + kObj)),
              HasSubstr("\"gone.mtl\" is not there"));
  EXPECT_THAT(message_of(write("c.obj", "mtllib .\n" + kObj)), HasSubstr("is a folder"));
  write("pictures.mtl", "newmtl red\nmap_Kd bad.png\n");
  write("bad.png", "no picture");
  EXPECT_THAT(message_of(write("d.obj", "mtllib pictures.mtl\n" + kObj)), HasSubstr("bad.png"));
}

// What the files name exists: it is not looked at, and nothing of it is told.
TEST_F(LoadScene, reads_no_other_file_where_none_is_allowed) {
  const LoadOptions alone{.other_files = LoadOptions::OtherFiles::none};
  const auto path_of = [&](const std::string& name) { return (folder_ / name).string(); };
  write("secret.mtl", "secret text\n");
  write("secret.stl", kStl);
  write("secret.dat", "1 2\n3 4\n");
  const Scene model = load_scene(
      write("a.obj", "mtllib " + path_of("secret.mtl") + "\n" + kObj + "usemtl x\nf 1 2 3\n"),
      alone);
  EXPECT_EQ(model.meshes.at(0).triangles.size(), 2U);
  EXPECT_THAT(model.notes.at(0), HasSubstr("other files may not be read"));
  const auto refusal_of = [&](const std::filesystem::path& path) {
    return test::error_message([&](const auto& p) { return load_scene(p, alone); }, path);
  };
  for (const char* call : {"import", "surface"}) {
    const std::string file = path_of(call[0] == 'i' ? "secret.stl" : "secret.dat");
    const std::string message =
        refusal_of(write("a.csg", std::string(call) + "(file = \"" + file + "\");\n"));
    EXPECT_THAT(message, HasSubstr("may not be used here")) << call;
  }
  const std::string asset = R"({"asset": {"version": "2.0"}, )";
  for (const std::string uri : {"secret.dat", "gone.dat"}) {
    const std::string message = refusal_of(
        write("a.gltf", asset + R"("buffers": [{"byteLength": 4, "uri": ")" + uri + "\"}]}"));
    EXPECT_THAT(message, HasSubstr("may not be read here; put all into one .glb")) << uri;
  }
  EXPECT_THAT(refusal_of(write("a.toml", "[[object]]\nfile = \"secret.stl\"\n")),
              HasSubstr("may not be read here"));
  EXPECT_THAT(refusal_of(write("a.scad", "cube(1);")), HasSubstr("may not be read here"));
}

TEST(SceneBytes, are_told_apart_by_their_content) {
  const auto extension = [](const std::string& text) {
    return find_scene_extension(test::bytes_of(text), "stdin");
  };
  EXPECT_EQ(extension(kStl), ".stl");
  EXPECT_EQ(extension(kPly), ".ply");
  EXPECT_EQ(extension(kOff), ".off");
  EXPECT_EQ(extension(kObj), ".obj");
  EXPECT_EQ(extension("\xEF\xBB\xBF# a comment\r\n\r\n  mtllib a = b.mtl\n"), ".obj");
  EXPECT_EQ(extension("# a comment\r\n\r\n  o part\n" + kObj), ".obj");
  EXPECT_EQ(extension(std::string("glTF\x02\0\0\0", 8) + std::string(20, '\0')), ".glb");
  EXPECT_EQ(extension("\n {\n\"asset\": {}}"), ".gltf");
  EXPECT_EQ(extension("# a scene\n[image]\nsize = [4, 4]\n"), ".toml");
  EXPECT_EQ(extension("round=0.5\n"), ".toml");
  EXPECT_EQ(extension("// a part\ngroup() {\n\tcube(size = 1);\n}\n"), ".csg");
  EXPECT_EQ(extension("  cube(size = 1, center = false);\n"), ".csg");
  EXPECT_THAT(test::error_message(extension, "hello there"),
              HasSubstr("holds no model that Arris knows"));
  EXPECT_THAT(test::error_message(extension, ""), HasSubstr("is empty"));
}

TEST(SceneBytes, become_the_scene_of_a_file) {
  const Scene scene = read_scene(test::bytes_of(kObj), ".obj", "stdin");
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "stdin");
  EXPECT_THAT(
      test::error_message(
          [](const std::string& text) { return read_scene(test::bytes_of(text), ".obj", "stdin"); },
          "v x\n"),
      HasSubstr("stdin:1"));
}

TEST(NearestName, finds_mistyped_ones_only) {
  const std::vector<std::string> known = {"radius", "roughness", "Round", "fov"};
  EXPECT_EQ(find_nearest_name("raduis", known), "radius");
  EXPECT_EQ(find_nearest_name("roughnes", known), "roughness");
  EXPECT_EQ(find_nearest_name("round", known), "Round");
  EXPECT_EQ(find_nearest_name("fvo", known), "fov");
  EXPECT_EQ(find_nearest_name("colour", known), std::nullopt);
  EXPECT_EQ(find_nearest_name("xyz", known), std::nullopt);
  EXPECT_EQ(find_nearest_name("", known), std::nullopt);
  EXPECT_EQ(find_nearest_name(std::string(1000, 'r'), known), std::nullopt);
}

}  // namespace
}  // namespace arris
