#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "arris/error.h"
#include "io/gltf_reader.h"
#include "io/gltf_test_file.h"
#include "io/picture_png.h"
#include "support/reading_problem.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using nlohmann::json;
using test::GltfTestFile;
using testing::HasSubstr;

Scene read_file(GltfTestFile file, const std::filesystem::path& folder = "/nonexistent") {
  return read_gltf(file.gltf(), "part.gltf", folder);
}

std::string refusal(GltfTestFile file) {
  try {
    read_file(std::move(file));
  } catch (const Error& error) {
    return error.what();
  }
  return "(was read)";
}

GltfTestFile file_with_material(json material) {
  GltfTestFile file = test::tetrahedron_file();
  file.json["materials"] = json::array({std::move(material)});
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  return file;
}

Material read_material(json material) {
  return read_file(file_with_material(std::move(material))).materials.at(0);
}

// A PNG file of 2 by 1 texels: red, half transparent, and green.
std::vector<std::uint8_t> two_texels() {
  return encode_png({2, 1, 4, {255, 0, 0, 128, 0, 255, 0, 255}});
}

GltfTestFile file_with_texture(json material) {
  GltfTestFile file = file_with_material(std::move(material));
  file.json["images"] = {
      {{"uri", "data:image/png;base64," + GltfTestFile::base64(two_texels())}, {"name", "paint"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      file.add_vec2({{0, 0}, {1, 0}, {0, 1}, {0.5F, 0.25F}});
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      file.add_vec2({{0, 0}, {0, 0}, {0, 0}, {7, 8}});
  return file;
}

json base_color_texture(json texture) {
  return {{"pbrMetallicRoughness", {{"baseColorTexture", std::move(texture)}}}};
}

TEST(GltfMaterial, has_the_defaults_of_the_format) {
  const Material material = read_material(json::object());
  EXPECT_EQ(material.base_color, Rgb(1, 1, 1));
  EXPECT_EQ(material.metallic, 1);
  EXPECT_EQ(material.roughness, 1);
  EXPECT_EQ(material.ior, 1.5F);
  EXPECT_EQ(material.opacity, 1);
  EXPECT_FALSE(material.alpha_cutoff);
}

TEST(GltfMaterial, reads_factors_and_extensions) {
  const Material material = read_material(
      {{"name", "paint"},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
         {"metallicFactor", 0.5},
         {"roughnessFactor", 0.6}}},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 1.3}}},
         {"KHR_materials_specular", {{"specularFactor", 0.7}, {"specularColorFactor", {2, 1, 0}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.8}}},
         {"KHR_materials_clearcoat",
          {{"clearcoatFactor", 0.9}, {"clearcoatRoughnessFactor", 0.05}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}});
  EXPECT_EQ(material.name, "paint");
  EXPECT_EQ(material.base_color, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(material.opacity, 0.4F);
  EXPECT_EQ(material.metallic, 0.5F);
  EXPECT_EQ(material.roughness, 0.6F);
  EXPECT_EQ(material.emission, Rgb(4, 2, 0));
  EXPECT_EQ(material.ior, 1.3F);
  EXPECT_EQ(material.specular, 0.7F);
  EXPECT_EQ(material.specular_color, Rgb(2, 1, 0));
  EXPECT_EQ(material.transmission, 0.8F);
  EXPECT_EQ(material.clearcoat, 0.9F);
  EXPECT_EQ(material.clearcoat_roughness, 0.05F);
}

TEST(GltfMaterial, follows_the_alpha_mode) {
  const json half = {{"baseColorFactor", {1, 1, 1, 0.5}}};
  EXPECT_EQ(read_material({{"pbrMetallicRoughness", half}}).opacity, 1);
  const Material mask = read_material({{"pbrMetallicRoughness", half}, {"alphaMode", "MASK"}});
  EXPECT_EQ(mask.opacity, 0.5F);
  EXPECT_EQ(mask.alpha_cutoff, 0.5F);
  EXPECT_EQ(read_material({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}).alpha_cutoff, 0.25F);
  EXPECT_THAT(refusal(file_with_material({{"alphaMode", "GLASS"}})),
              HasSubstr("materials[0].alphaMode"));
}

TEST(GltfMaterial, forgives_rounding_but_no_wrong_factors) {
  EXPECT_EQ(read_material({{"pbrMetallicRoughness", {{"roughnessFactor", 1.0000001}}}}).roughness,
            1);
  EXPECT_THAT(refusal(file_with_material({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}})),
              HasSubstr("roughnessFactor: 1.5 is outside"));
  EXPECT_THAT(
      refusal(file_with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 2, 0, 1}}}}})),
      HasSubstr("outside 0 to 1"));
  EXPECT_THAT(refusal(file_with_material({{"emissiveFactor", {-1, 0, 0}}})), HasSubstr("negative"));
  EXPECT_THAT(
      refusal(file_with_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}})),
      HasSubstr("below 1"));
}

TEST(GltfMaterial, decodes_textures_for_each_use) {
  GltfTestFile file = file_with_texture(
      {{"alphaMode", "BLEND"},
       {"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}},
       {"normalTexture", {{"index", 0}, {"scale", 0.5}}}});
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  file.json["textures"][0]["sampler"] = 0;
  const Scene scene = read_file(file);
  const Material& material = scene.materials.at(0);
  ASSERT_EQ(scene.textures.size(), 2U);  // sRGB with alpha; linear without
  const Texture& color = scene.textures.at(material.base_color_texture->index);
  EXPECT_TRUE(color.srgb);
  EXPECT_EQ(color.name, "paint");
  EXPECT_EQ(color.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(color.wrap_v, Texture::Wrap::mirror);
  EXPECT_EQ(color.texels,
            (std::vector<std::array<std::uint8_t, 4>>{{255, 0, 0, 128}, {0, 255, 0, 255}}));
  EXPECT_FALSE(scene.textures.at(material.normal_texture->index).srgb);
  EXPECT_EQ(material.normal_texture, material.metallic_roughness_texture);
  EXPECT_EQ(material.normal_scale, 0.5F);
}

TEST(GltfMaterial, makes_textures_of_opaque_materials_opaque) {
  const Scene scene = read_file(file_with_texture(base_color_texture({{"index", 0}})));
  EXPECT_EQ(scene.textures.at(0).texels.at(0)[3], 255);
}

TEST(GltfMaterial, reads_images_from_buffer_views_and_from_files) {
  GltfTestFile file = file_with_texture(base_color_texture({{"index", 0}}));
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> png = two_texels();
  std::ofstream(folder / "paint.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  file.json["images"] = {{{"uri", "paint.png"}}};
  EXPECT_EQ(read_file(file, folder.path()).textures.at(0).width_px, 2);
  EXPECT_THAT(refusal(file), testing::AllOf(HasSubstr("images[0]"), HasSubstr("paint.png")));
  file.json["images"] = {{{"bufferView", file.add_view(png)}, {"mimeType", "image/png"}}};
  EXPECT_EQ(read_file(file).textures.at(0).width_px, 2);
  file.json["images"] = {{{"uri", "https://example.org/paint.png"}}};
  EXPECT_THAT(refusal(file), HasSubstr("not a file beside the model"));
  file.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  EXPECT_THAT(refusal(file), HasSubstr("images[0]"));
}

TEST(GltfMaterial, takes_the_coordinate_set_that_the_texture_names) {
  const Scene scene =
      read_file(file_with_texture(base_color_texture({{"index", 0}, {"texCoord", 1}})));
  const auto& uvs = scene.meshes.at(0).uvs;
  EXPECT_NE(std::ranges::find(uvs, Vec2f{7, 8}), uvs.end());
}

TEST(GltfMaterial, applies_texture_transforms_to_the_coordinates) {
  const json transform = {{"offset", {10, 20}}, {"rotation", kPi / 2}, {"scale", {2, 4}}};
  const Scene scene = read_file(file_with_texture(
      base_color_texture({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}})));
  // (0.5, 0.25) scaled is (1, 1); turned by the format's matrix (c s; -s c) it is (1, -1)
  bool found = false;
  for (const Vec2f uv : scene.meshes.at(0).uvs) {
    found = found || (std::abs(uv.x - 11) < 1e-5F && std::abs(uv.y - 19) < 1e-5F);
  }
  EXPECT_TRUE(found);
}

TEST(GltfMaterial, notes_textures_that_disagree_about_their_coordinates) {
  GltfTestFile file = file_with_texture(base_color_texture({{"index", 0}}));
  file.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
  EXPECT_THAT(read_file(file).notes,
              testing::ElementsAre(HasSubstr("differ in their coordinates")));
}

TEST(GltfMaterial, notes_textures_without_coordinates) {
  GltfTestFile file = file_with_texture(base_color_texture({{"index", 0}, {"texCoord", 5}}));
  EXPECT_THAT(read_file(file).notes,
              testing::ElementsAre(HasSubstr("lack the texture coordinates")));
}

TEST(GltfMaterial, refuses_textures_that_are_not_there) {
  EXPECT_THAT(refusal(file_with_texture(base_color_texture({{"index", 1}}))),
              HasSubstr("the file has 1 textures"));
  GltfTestFile file = file_with_texture(base_color_texture({{"index", 0}}));
  file.json["textures"][0]["source"] = 3;
  EXPECT_THAT(refusal(file), HasSubstr("the file has 1 images"));
  file.json["textures"][0].erase("source");
  EXPECT_THAT(refusal(file), HasSubstr("no PNG or JPEG"));
}

}  // namespace
}  // namespace arris
