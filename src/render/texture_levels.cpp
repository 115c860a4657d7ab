#include "render/texture_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/parallel_for.h"
#include "shading/texture_lookup.h"

namespace arris {
namespace {

// The texels of the finer level that one of the coarser covers along an axis: two, or three where sizes are odd.
struct Cover {
  int first = 0, count = 1;
  std::array<float, 3> weights{1, 0, 0};
};

Cover cover_of(int i, int coarse, int fine) {
  const double from = double(i) * fine / coarse, to = double(i + 1) * fine / coarse;
  Cover cover;
  cover.first = int(from);
  cover.count = std::clamp(int(std::ceil(to - 1e-9)) - cover.first, 1, 3);
  for (int k = 0; k < cover.count; ++k) {
    const double begin = std::max(from, double(cover.first + k));
    const double end = std::min(to, double(cover.first + k + 1));
    cover.weights[std::size_t(k)] = float((end - begin) / (to - from));
  }
  return cover;
}

}  // namespace

Texture halve_texture(const Texture& texture, int threads) {
  Texture half;
  half.name = texture.name;
  half.srgb = texture.srgb;
  half.wrap_u = texture.wrap_u;
  half.wrap_v = texture.wrap_v;
  half.width_px = std::max(1, texture.width_px / 2);
  half.height_px = std::max(1, texture.height_px / 2);
  half.texels.resize(std::size_t(half.width_px) * std::size_t(half.height_px));
  std::vector<Cover> columns;
  for (int x = 0; x < half.width_px; ++x) {
    columns.push_back(cover_of(x, half.width_px, texture.width_px));
  }
  parallel_for(std::size_t(half.height_px), {.grain = 16, .threads = threads}, [&](std::size_t y) {
    const Cover rows = cover_of(int(y), half.height_px, texture.height_px);
    for (int x = 0; x < half.width_px; ++x) {
      const Cover& across = columns[std::size_t(x)];
      Rgba sum{};
      for (int j = 0; j < rows.count; ++j) {
        const auto row = std::size_t(rows.first + j) * std::size_t(texture.width_px);
        for (int i = 0; i < across.count; ++i) {
          const float w = rows.weights[std::size_t(j)] * across.weights[std::size_t(i)];
          const Rgba texel =
              decode_texel(texture, texture.texels[row + std::size_t(across.first + i)]);
          for (std::size_t c = 0; c < 4; ++c) sum[c] += w * texel[c];
        }
      }
      half.texels[y * std::size_t(half.width_px) + std::size_t(x)] = encode_texel(texture, sum);
    }
  });
  return half;
}

TextureLevels::TextureLevels(std::span<const Texture> textures, const std::vector<bool>& wanted,
                             int threads)
    : coarser_(textures.size()) {
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (!wanted[i]) continue;
    const Texture* finer = &textures[i];
    std::vector<Texture>& levels = coarser_[i];
    levels.reserve(32);
    while (finer->width_px > 1 || finer->height_px > 1) {
      levels.push_back(halve_texture(*finer, threads));
      finer = &levels.back();
    }
  }
}

const Texture& TextureLevels::find(std::span<const Texture> textures, TextureId id,
                                   float texels) const {
  const Texture& finest = textures[id.index];
  if (!(texels >= 2) || id.index >= coarser_.size()) return finest;
  const std::vector<Texture>& levels = coarser_[id.index];
  const auto level = std::size_t(std::min(std::floor(std::log2(texels)), 31.0F));
  if (levels.empty()) return finest;
  return levels[std::min(level, levels.size()) - 1];
}

}  // namespace arris
