#include "render/texture_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "shading/texture_lookup.h"

namespace arris {
namespace {

Texture make_noise(int width, int height, bool srgb) {
  Texture texture;
  texture.width_px = width;
  texture.height_px = height;
  texture.srgb = srgb;
  std::mt19937 random(7);
  for (int i = 0; i < width * height; ++i) {
    const auto byte = [&] { return std::uint8_t(random() & 255U); };
    texture.texels.push_back({byte(), byte(), byte(), byte()});
  }
  return texture;
}

Rgba mean_of(const Texture& texture) {
  Rgba sum{};
  for (const Texel& texel : texture.texels) {
    const Rgba value = decode_texel(texture, texel);
    for (std::size_t c = 0; c < 4; ++c) sum[c] += value[c] / float(texture.texels.size());
  }
  return sum;
}

TEST(TextureLevels, halves_keep_the_mean_whatever_their_size) {
  for (const bool srgb : {false, true}) {
    for (const auto& [width, height] : {std::pair{64, 32}, {37, 51}, {1, 9}, {3, 1}}) {
      const Texture texture = make_noise(width, height, srgb);
      const Texture half = halve_texture(texture, 0);
      EXPECT_EQ(half.width_px, std::max(1, width / 2));
      EXPECT_EQ(half.height_px, std::max(1, height / 2));
      const Rgba before = mean_of(texture), after = mean_of(half);
      for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(before[c], after[c], 2e-3F) << width;
    }
  }
}

TEST(TextureLevels, texels_are_the_means_of_those_below) {
  const Texture texture = make_noise(8, 6, false);
  const Texture half = halve_texture(texture, 0);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      float sum = 0;
      for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i)
          sum += float(texture.texels[std::size_t(8 * (2 * y + j) + 2 * x + i)][0]);
      }
      EXPECT_NEAR(float(half.texels[std::size_t(4 * y + x)][0]), sum / 4, 0.51F);
    }
  }
}

TEST(TextureLevels, are_found_by_the_texels_of_a_step) {
  const std::vector<Texture> textures{make_noise(64, 16, true), make_noise(8, 8, true)};
  const TextureLevels levels(textures, {true, false}, 0);
  const auto width_at = [&](float texels) {
    return levels.find(textures, TextureId{0}, texels).width_px;
  };
  EXPECT_EQ(width_at(0), 64);
  EXPECT_EQ(width_at(1.9F), 64);
  EXPECT_EQ(width_at(2), 32);
  EXPECT_EQ(width_at(7), 16);
  EXPECT_EQ(width_at(1e30F), 1);
  EXPECT_EQ(levels.find(textures, TextureId{1}, 4).width_px, 8);
}

TEST(TextureLevels, every_byte_comes_back) {
  Texture texture;
  for (const bool srgb : {false, true}) {
    texture.srgb = srgb;
    for (unsigned i = 0; i < 256; ++i) {
      const auto byte = std::uint8_t(i);
      const Texel texel{byte, byte, byte, byte};
      EXPECT_EQ(encode_texel(texture, decode_texel(texture, texel)), texel);
    }
  }
}

}  // namespace
}  // namespace arris
