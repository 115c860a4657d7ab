#include "shading/surface_material.h"

#include <gtest/gtest.h>

#include <vector>

namespace arris {
namespace {

// 2 × 1 texels: left a, right b.
Texture pair_texture(std::array<std::uint8_t, 4> a, std::array<std::uint8_t, 4> b) {
  Texture t;
  t.width_px = 2;
  t.height_px = 1;
  t.texels = {a, b};
  return t;
}

Material textured() {
  Material m;
  m.base_color = {1, 1, 1};
  m.base_color_texture = TextureId{0};
  return m;
}

float red_at(const Texture& texture, float u) {
  return eval_material(textured(), std::vector{texture}, {u, 0.5F}).base_color.x;
}

TEST(SurfaceMaterial, interpolates_between_texel_centres) {
  const Texture t = pair_texture({0, 0, 0, 255}, {255, 255, 255, 255});
  EXPECT_NEAR(red_at(t, 0.25F), 0.0F, 1e-6F);
  EXPECT_NEAR(red_at(t, 0.75F), 1.0F, 1e-6F);
  EXPECT_NEAR(red_at(t, 0.5F), 0.5F, 1e-6F);
  EXPECT_NEAR(red_at(t, 0.6F), 0.7F, 1e-6F);
}

TEST(SurfaceMaterial, wraps_as_the_texture_says) {
  Texture t = pair_texture({0, 0, 0, 255}, {255, 255, 255, 255});
  EXPECT_NEAR(red_at(t, 1.75F), 1.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, -0.75F), 0.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, 1.0F), 0.5F, 1e-5F);  // between the last and the first
  t.wrap_u = Texture::Wrap::mirror;
  EXPECT_NEAR(red_at(t, 1.25F), 1.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, 1.75F), 0.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, -0.25F), 0.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, 1.0F), 1.0F, 1e-5F);
  t.wrap_u = Texture::Wrap::clamp;
  EXPECT_NEAR(red_at(t, 7.0F), 1.0F, 1e-5F);
  EXPECT_NEAR(red_at(t, -7.0F), 0.0F, 1e-5F);
}

TEST(SurfaceMaterial, row_zero_is_at_v_zero) {
  Texture t;
  t.width_px = 1;
  t.height_px = 2;
  t.texels = {{255, 0, 0, 255}, {0, 255, 0, 255}};
  const auto s = eval_material(textured(), std::vector{t}, {0.5F, 0.25F});
  EXPECT_NEAR(s.base_color.x, 1.0F, 1e-6F);
  EXPECT_NEAR(s.base_color.y, 0.0F, 1e-6F);
}

TEST(SurfaceMaterial, decodes_srgb_before_filtering_and_never_alpha) {
  Texture t = pair_texture({188, 0, 0, 128}, {188, 0, 0, 128});
  t.srgb = true;
  const auto s = eval_material(textured(), std::vector{t}, {0.4F, 0.5F});
  EXPECT_NEAR(s.base_color.x, 0.5029F, 1e-3F);
  EXPECT_NEAR(s.opacity, 128.0F / 255.0F, 1e-5F);
  t.texels[0][0] = 0;
  EXPECT_NEAR(red_at(t, 0.5F), 0.2514F, 1e-3F);
}

TEST(SurfaceMaterial, reads_the_channels_of_gltf) {
  Material m;
  m.metallic = 0.5F;
  m.roughness = 0.8F;
  m.clearcoat = 1;
  m.clearcoat_roughness = 1;
  m.transmission = 1;
  m.emission = {2, 2, 2};
  m.metallic_roughness_texture = m.clearcoat_texture = m.clearcoat_roughness_texture =
      m.transmission_texture = m.emission_texture = TextureId{0};
  const std::vector<Texture> textures = {pair_texture({51, 102, 153, 0}, {51, 102, 153, 0})};
  const SurfaceMaterial s = eval_material(m, textures, {0.3F, 0.3F});
  EXPECT_NEAR(s.roughness, 0.8F * 0.4F, 1e-6F);
  EXPECT_NEAR(s.metallic, 0.5F * 0.6F, 1e-6F);
  EXPECT_NEAR(s.clearcoat, 0.2F, 1e-6F);
  EXPECT_NEAR(s.clearcoat_roughness, 0.4F, 1e-6F);
  EXPECT_NEAR(s.transmission, 0.2F, 1e-6F);
  EXPECT_NEAR(s.emission.z, 1.2F, 1e-6F);
  EXPECT_NEAR(eval_emission(m, textures, {0.3F, 0.3F}).x, 0.4F, 1e-6F);
}

TEST(SurfaceMaterial, normal_maps_tilt_and_flat_ones_do_not) {
  Material m;
  m.normal_texture = TextureId{0};
  const auto normal = [&](std::array<std::uint8_t, 4> texel) {
    return eval_material(m, std::vector{pair_texture(texel, texel)}, {0.5F, 0.5F}).normal;
  };
  EXPECT_GT(normal({128, 128, 255, 255}).z, 0.9999F);
  const Vec3f tilted = normal({255, 128, 255, 255});
  EXPECT_NEAR(tilted.x, tilted.z, 5e-3F);
  EXPECT_NEAR(length(tilted), 1.0F, 1e-6F);
  m.normal_scale = 0.5F;
  EXPECT_NEAR(normal({255, 128, 255, 255}).x * 2.0F, normal({255, 128, 255, 255}).z, 5e-3F);
  EXPECT_EQ(normal({128, 128, 0, 255}), (Vec3f{0, 0, 1}));  // points inward: not a normal
}

TEST(SurfaceMaterial, opacity_is_cut_where_the_material_says) {
  Material m = textured();
  m.opacity = 0.8F;
  const std::vector<Texture> textures = {pair_texture({9, 9, 9, 102}, {9, 9, 9, 204})};
  EXPECT_NEAR(eval_opacity(m, textures, {0.25F, 0}), 0.32F, 1e-5F);
  m.alpha_cutoff = 0.5F;
  EXPECT_EQ(eval_opacity(m, textures, {0.25F, 0}), 0.0F);
  EXPECT_EQ(eval_opacity(m, textures, {0.75F, 0}), 1.0F);
  EXPECT_EQ(eval_material(m, textures, {0.75F, 0}).opacity, 1.0F);
}

TEST(SurfaceMaterial, factors_alone_without_textures) {
  Material m;
  m.glossy_mix = 0.1F;
  m.roughness = 0.2F;
  EXPECT_FALSE(has_textures(m));
  EXPECT_TRUE(has_textures(textured()));
  const SurfaceMaterial s = eval_material(m, {}, {0, 0});
  EXPECT_TRUE(s.is_mix);
  EXPECT_EQ(s.glossy_share, 0.1F);
  EXPECT_EQ(s.roughness, 0.2F);
  EXPECT_EQ(s.normal, (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace arris
