#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "io/mesh_readers.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/mesh_checks.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Files beside the model, in memory; pictures are one texel.
class ObjReader : public testing::Test {
 protected:
  ObjReader() {
    files_.find_library =
        [this](const std::string& name) -> std::optional<std::vector<std::uint8_t>> {
      const auto found = libraries_.find(name);
      if (found == libraries_.end()) return std::nullopt;
      return test::bytes_of(found->second);
    };
    files_.find_texture = [this](const std::string& name) -> std::optional<Texture> {
      asked_.push_back(name);
      if (name.find(".png") == std::string::npos) return std::nullopt;
      Texture texture;
      texture.name = name;
      texture.width_px = texture.height_px = 1;
      texture.texels.push_back({255, 255, 255, 255});
      return texture;
    };
  }

  Scene read(std::span<const std::uint8_t> bytes) { return read_obj(bytes, "part.obj", files_); }
  Scene read_text(const std::string& text) { return read(test::bytes_of(text)); }
  std::string message_of(const std::string& text) {
    return test::error_message([this](const auto& bytes) { return read(bytes); },
                               test::bytes_of(text));
  }
  // The first material of a library that holds one material "m" of these lines.
  Material material_of(const std::string& lines) {
    libraries_["m.mtl"] = "newmtl m\n" + lines;
    const Scene scene = read_text(kTriangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n");
    return scene.materials.at(scene.objects.at(0).material.index);
  }
  std::string material_message(const std::string& lines) {
    libraries_["m.mtl"] = "newmtl m\n" + lines;
    return message_of(kTriangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n");
  }

  const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string kCube =
      "# a cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  ObjFiles files_;
  std::map<std::string, std::string> libraries_;
  std::vector<std::string> asked_;
};

TEST_F(ObjReader, reads_a_cube_of_quads) {
  const Scene scene = read_text(kCube);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "part");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 8U);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_TRUE(mesh.triangle_materials.empty());
  EXPECT_TRUE(test::is_closed(mesh));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1);
}

TEST_F(ObjReader, cuts_a_concave_face_exactly) {
  const Scene scene =
      read_text("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf -6 -5 -4 -3 -2 -1\n");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(test::area_of(scene.meshes[0]), 3);
}

TEST_F(ObjReader, splits_vertices_by_their_corners) {
  const Scene scene = read_text(kTriangle +
                                "v 1 1 0\nvt 0 0\nvt 1 0.25\nvt 0.5\nvn 0 0 5\nvn 0 1 0\n"
                                "f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/1/2 3/3/1\n");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 4U);
  ASSERT_EQ(mesh.uvs.size(), 4U);
  EXPECT_EQ(mesh.uvs[1], (Vec2f{1, 0.75F}));
  EXPECT_EQ(mesh.uvs[2], (Vec2f{0.5F, 1}));
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[3], Vec3f(0, 1, 0));
  EXPECT_EQ(mesh.triangles[1], (Triangle{1, 3, 2}));
}

TEST_F(ObjReader, gives_corners_without_normal_that_of_their_triangle) {
  const Scene scene = read_text(kTriangle +
                                "v 0 0 1\nvn 1 0 0\nvn 0 0 0\nf 1//1 2//1 3//1\n"
                                "f 1 3 2\nf 1//2 2//2 4//2\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals[mesh.triangles[0][0]], Vec3f(1, 0, 0));
  EXPECT_EQ(mesh.normals[mesh.triangles[1][0]], Vec3f(0, 0, -1));
  EXPECT_EQ(mesh.normals[mesh.triangles[2][1]], Vec3f(0, -1, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[2][2]], Vec3f(0, 0, 1));
}

TEST_F(ObjReader, makes_objects_of_groups_and_joins_those_of_one_name) {
  const Scene scene = read_text(kTriangle +
                                "g empty\ng left side\nf 1 2 3\ng right\nf 1 3 2\n"
                                "g left side\nf 3 2 1\n");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "left side");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2U);
  EXPECT_EQ(scene.objects[1].name, "right");
}

TEST_F(ObjReader, prefers_objects_to_their_groups) {
  const Scene scene =
      read_text(kTriangle + "o box\ng front\nf 1 2 3\ng back\nf 1 3 2\no box\nf 3 2 1\n");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "box");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2U);
  EXPECT_EQ(scene.objects[1].name, "box");
  EXPECT_EQ(scene.meshes.at(1).positions.size(), 3U);
}

TEST_F(ObjReader, gives_each_triangle_its_material) {
  libraries_["two.mtl"] = "newmtl red\nKd 1 0 0\n\nnewmtl dark blue\nKd 0 0 .5\n";
  const Scene scene =
      read_text("mtllib two.mtl\n" + kTriangle +
                "o a\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl dark blue\nf 1 3 2\no b\nf 1 2 3\n");
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.triangle_materials.size(), 3U);
  EXPECT_EQ(scene.materials.at(mesh.triangle_materials[0].index).name, "default");
  EXPECT_EQ(scene.materials.at(mesh.triangle_materials[1].index).base_color, Rgb(1, 0, 0));
  EXPECT_EQ(scene.materials.at(mesh.triangle_materials[2].index).base_color, Rgb(0, 0, 0.5F));
  EXPECT_TRUE(scene.meshes.at(1).triangle_materials.empty());
  EXPECT_EQ(scene.materials.at(scene.objects[1].material.index).name, "dark blue");
}

TEST_F(ObjReader, names_materials_of_a_model_without_library) {
  const Scene scene = read_text(kTriangle + "usemtl brass\nf 1 2 3\nusemtl (null)\nf 1 3 2\n");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(scene.materials.at(mesh.triangle_materials.at(0).index).name, "brass");
  EXPECT_EQ(mesh.triangle_materials.at(1).index, 0U);
}

TEST_F(ObjReader, finds_libraries_whose_names_have_blanks) {
  libraries_["my parts.mtl"] = "newmtl a\n";
  libraries_["b.mtl"] = "newmtl b\n";
  libraries_["c.mtl"] = "newmtl c\n";
  const Scene scene = read_text("mtllib my parts.mtl\nmtllib b.mtl c.mtl\n" + kTriangle +
                                "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.size(), 4U);
}

TEST_F(ObjReader, maps_materials) {
  const Material plain =
      material_of("Kd 0.25 0.5 1\nKs 0.5 0.5 0.5\nNs 30\nNi 1.45\nd 0.5\nKe 1 2 3\n");
  EXPECT_EQ(plain.base_color, Rgb(0.25F, 0.5F, 1));
  EXPECT_FLOAT_EQ(plain.roughness, 0.5F);
  EXPECT_EQ(plain.specular, 1);
  EXPECT_EQ(plain.ior, 1.45F);
  EXPECT_EQ(plain.opacity, 0.5F);
  EXPECT_EQ(plain.emission, Rgb(1, 2, 3));
  const Material physical = material_of("Ns 900\nPr 0.75\nPm 1\nPc 0.5\nPcr 0.25\nNi 1\nTr 0.25\n");
  EXPECT_EQ(physical.roughness, 0.75F);
  EXPECT_EQ(physical.metallic, 1);
  EXPECT_EQ(physical.clearcoat, 0.5F);
  EXPECT_EQ(physical.clearcoat_roughness, 0.25F);
  EXPECT_EQ(physical.ior, 1.5F);
  EXPECT_EQ(physical.opacity, 0.75F);
  const Material tinted = material_of("Ks 0.2 0.1 0\n");
  EXPECT_FLOAT_EQ(tinted.specular, 0.4F);
  EXPECT_FLOAT_EQ(tinted.specular_color.y, 0.5F);
  EXPECT_EQ(material_of("Ks 0 0 0\n").specular, 0);
  EXPECT_EQ(material_of("illum 1\n").specular, 0);
  const Material glass = material_of("illum 7\nd 0.1\n");
  EXPECT_FLOAT_EQ(glass.transmission, 0.9F);
  EXPECT_EQ(glass.opacity, 1);
  EXPECT_EQ(material_of("Kd .5\n").base_color, Rgb(0.5F, 0.5F, 0.5F));
}

TEST_F(ObjReader, reads_textures_once_for_each_use) {
  libraries_["looks/two.mtl"] =
      "newmtl a\nmap_Kd -blendu on maps\\a b.png\nnewmtl b\nmap_Kd maps\\a b.png\nKd .5 .5 .5\n"
      "map_Ke -clamp on e.png\nnorm n.png\nmap_Bump x.png\n";
  const Scene scene = read_text("mtllib looks/two.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n");
  EXPECT_THAT(asked_, ElementsAre("looks/maps/a b.png", "looks/e.png", "looks/n.png"));
  const Material& a = scene.materials.at(1);
  const Material& b = scene.materials.at(2);
  EXPECT_EQ(a.base_color, Rgb(1, 1, 1));
  EXPECT_EQ(a.base_color_texture, b.base_color_texture);
  EXPECT_EQ(b.base_color, Rgb(0.5F, 0.5F, 0.5F));
  EXPECT_EQ(b.emission, Rgb(1, 1, 1));
  EXPECT_TRUE(scene.textures.at(a.base_color_texture->index).srgb);
  EXPECT_EQ(scene.textures.at(b.emission_texture->index).wrap_u, Texture::Wrap::clamp);
  EXPECT_FALSE(scene.textures.at(b.normal_texture->index).srgb);
  EXPECT_THAT(scene.notes,
              ElementsAre(AllOf(HasSubstr("two.mtl"), HasSubstr("\"map_Bump\" is not read"))));
}

TEST_F(ObjReader, rejects_materials_and_names_file_line_and_value) {
  EXPECT_THAT(material_message("Kd 1 0 1.5\n"),
              AllOf(HasSubstr("m.mtl:2:"), HasSubstr("\"1.5\""), HasSubstr("0 to 1")));
  EXPECT_THAT(material_message("Ns -1\n"), HasSubstr("0 or more"));
  EXPECT_THAT(material_message("Kd nan 0 0\n"), HasSubstr("not finite"));
  EXPECT_THAT(material_message("Kd spectral a.rfl\n"), HasSubstr("red, green and blue"));
  EXPECT_THAT(material_message("Kdd 1 1 1\n"), HasSubstr("\"Kdd\" is not known"));
  EXPECT_THAT(material_message("map_Kd gone.jpg\n"), AllOf(HasSubstr("\"gone.jpg\" is not there")));
  EXPECT_THAT(material_message("map_Kd -s 2 2 a.png\n"), HasSubstr("texture coordinates"));
  EXPECT_THAT(material_message("map_Kd\n"), HasSubstr("names no file"));
  libraries_["bare.mtl"] = "Kd 1 1 1\n";
  EXPECT_THAT(message_of("mtllib bare.mtl\n"), HasSubstr("before the first \"newmtl\""));
}

TEST_F(ObjReader, rejects_missing_libraries_and_materials) {
  libraries_["m.mtl"] = "newmtl brass\n";
  EXPECT_THAT(
      message_of("mtllib gone.mtl\n" + kTriangle + "f 1 2 3\n"),
      AllOf(HasSubstr("part.obj:1:"), HasSubstr("\"gone.mtl\" is not there"), HasSubstr("delete")));
  EXPECT_THAT(message_of("mtllib m.mtl\n" + kTriangle + "usemtl bras\nf 1 2 3\n"),
              AllOf(HasSubstr("part.obj:5:"), HasSubstr("did you mean \"brass\"?")));
}

TEST_F(ObjReader, names_line_and_value_of_what_is_wrong) {
  EXPECT_THAT(message_of(kTriangle + "f 1 2 4\n"),
              AllOf(HasSubstr("part.obj:4:"), HasSubstr("\"4\""), HasSubstr("3 are above")));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 0\n"), HasSubstr("\"0\""));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 -4\n"), HasSubstr("\"-4\""));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 99999999999999999999\n"), HasSubstr("is not there"));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 3/1\n"), HasSubstr("names a texture coordinate"));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 3//1\n"), HasSubstr("names a normal"));
  EXPECT_THAT(message_of(kTriangle + "f 1 2 3x\n"), HasSubstr("where a corner should be"));
  EXPECT_THAT(message_of(kTriangle + "f 1 2\n"), HasSubstr("2 corners; at least 3"));
  EXPECT_THAT(message_of("v 0 nan 0\n"), AllOf(HasSubstr("part.obj:1:"), HasSubstr("not finite")));
  EXPECT_THAT(message_of("v 0 0\n"), HasSubstr("where a vertex's z should be"));
  EXPECT_THAT(message_of("v 0 0 0 1 1\n"), HasSubstr("5 numbers"));
  EXPECT_THAT(message_of("vn 0 0 0 1\n"), HasSubstr("\"1\""));
  EXPECT_THAT(message_of(kTriangle), HasSubstr("no faces"));
  EXPECT_THAT(message_of(""), HasSubstr("no faces"));
  EXPECT_THAT(message_of("surf 0 1 0 1 1 2\n"), HasSubstr("export polygons"));
  EXPECT_THAT(message_of("call part.obj\n"), HasSubstr("join the files"));
  EXPECT_THAT(message_of("<html>\n"), HasSubstr("\"<html>\""));
  EXPECT_THAT(message_of("o K\xF6rper\n"), HasSubstr("is not UTF-8"));
}

TEST_F(ObjReader, takes_comments_continued_lines_and_any_line_end) {
  const Scene scene = read_text(
      "\xEF\xBB\xBF# \xF6\r\nv 0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\nv 0 1 0 1.0\r\n"
      "s off\r\nf 1 2 \\\r\n3\r\nl 1 2\r\nf 1 2 3 #no\r\n"
      "");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2U);
}

TEST_F(ObjReader, notes_what_it_leaves_out) {
  const Scene scene =
      read_text("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\nl 1 2\np 1\n");
  EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("colours"), HasSubstr("lines and points")));
}

TEST_F(ObjReader, reads_a_very_long_line) {
  std::string text;
  std::string face = "f";
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * kPi * i / kCount;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += fmt::format(" {}", i + 1);
  }
  const Scene scene = read_text(text + face);
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), std::size_t(kCount - 2));
  EXPECT_NEAR(test::area_of(scene.meshes[0]), kPi, 1e-4);
}

TEST_F(ObjReader, survives_cuts_and_changes_everywhere) {
  libraries_["a.mtl"] = "newmtl a\nKd 1 0 0\nnewmtl b\nmap_Kd a.png\n";
  const auto file =
      test::bytes_of("mtllib a.mtl\n" + kTriangle +
                     "v -1e-1 .5 2 # c\nvt 0 1\nvn 0 0 1\no one\nusemtl a\nf 1/1/1 2//1 3\n"
                     "s 1\ng two\nusemtl b\nf -1 -2 \\\n -3 1\nf 1 2 3 4\n");
  const auto read_it = [this](std::span<const std::uint8_t> bytes) { return read(bytes); };
  test::cut_every_byte(file, read_it);
  test::change_every_byte(file, read_it);
}

TEST_F(ObjReader, survives_cuts_and_changes_of_the_library) {
  const auto library = test::bytes_of(
      "# x\nnewmtl a\nKd .1 .2 .3\nKs .5\nNs 10\nd 0.5\nillum 2\nmap_Kd -clamp on -bm 2 a.png\n"
      "newmtl b\nKe 1 1 1\nPr .5\nPm 1\nNi 1.5\nTr .1\nmap_Ks x\n");
  const auto read_it = [this](std::span<const std::uint8_t> bytes) {
    libraries_["a.mtl"] = std::string(bytes.begin(), bytes.end());
    return read_text("mtllib a.mtl\n" + kTriangle + "f 1 2 3\n");
  };
  test::cut_every_byte(library, read_it);
  test::change_every_byte(library, read_it);
}

}  // namespace
}  // namespace arris
