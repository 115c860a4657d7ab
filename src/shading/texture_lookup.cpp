#include "shading/texture_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace arris {
namespace {

using DecodeTable = std::array<float, 256>;

DecodeTable make_decode_table(bool srgb) {
  DecodeTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double v = double(i) / 255.0;
    const double decoded = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    table[i] = float(srgb ? decoded : v);
  }
  return table;
}
const DecodeTable kLinearTable = make_decode_table(false);
const DecodeTable kSrgbTable = make_decode_table(true);

// i: within -1 and 2 size; divisions would take longer than all else that a lookup does.
int wrap_index(int i, int size, Texture::Wrap wrap) {
  switch (wrap) {
    case Texture::Wrap::clamp:
      return i < 0 ? 0 : i >= size ? size - 1 : i;
    case Texture::Wrap::mirror: {
      const int period = 2 * size;
      const int m = i < 0 ? i + period : i >= period ? i - period : i;
      return m < size ? m : period - 1 - m;
    }
    case Texture::Wrap::repeat:
      break;
  }
  if (i < 0) return i + size;
  if (i >= size) i -= size;
  return i >= size ? i - size : i;
}

// The two texels beside a coordinate, and the weight of the second.
struct Neighbours {
  int first, second;
  float fraction;
};
Neighbours neighbours_of(float coordinate, int size, Texture::Wrap wrap) {
  // Both wraps repeat after 2: keeps large coordinates within int and float precision.
  const float reduced = wrap == Texture::Wrap::clamp
                            ? std::fmin(std::fmax(coordinate, -1.0F), 2.0F)
                            : coordinate - 2.0F * std::floor(coordinate * 0.5F);
  const float x = (std::isfinite(reduced) ? reduced : 0.0F) * float(size) - 0.5F;
  const float floor_x = std::floor(x);
  const int i = std::min(int(floor_x), 2 * size - 1);  // the coordinate may have been rounded to 2
  return {wrap_index(i, size, wrap), wrap_index(i + 1, size, wrap), x - floor_x};
}

// The first channels.
template <std::size_t kChannels>
std::array<float, kChannels> eval_channels(const Texture& texture, Vec2f uv) {
  const Neighbours u = neighbours_of(uv.x, texture.width_px, texture.wrap_u);
  const Neighbours v = neighbours_of(uv.y, texture.height_px, texture.wrap_v);
  const DecodeTable& color = texture.srgb ? kSrgbTable : kLinearTable;
  const Texel* row0 = texture.texels.data() + std::size_t(v.first) * std::size_t(texture.width_px);
  const Texel* row1 = texture.texels.data() + std::size_t(v.second) * std::size_t(texture.width_px);
  const float w11 = u.fraction * v.fraction;
  const float w10 = u.fraction - w11;
  const float w01 = v.fraction - w11;
  const float w00 = 1.0F - u.fraction - w01;
  std::array<float, kChannels> result;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const DecodeTable& decode = c < 3 ? color : kLinearTable;
    result[c] = w00 * decode[row0[u.first][c]] + w10 * decode[row0[u.second][c]] +
                w01 * decode[row1[u.first][c]] + w11 * decode[row1[u.second][c]];
  }
  return result;
}

// Of evenly spaced linear values: finer than the finest step of sRGB, which is 1 / (12.92 · 255).
constexpr std::size_t kEncodeSteps = 16384;
std::array<std::uint8_t, kEncodeSteps + 1> make_encode_table() {
  std::array<std::uint8_t, kEncodeSteps + 1> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double v = double(i) / double(kEncodeSteps);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    table[i] = std::uint8_t(std::lround(255 * encoded));
  }
  return table;
}
const std::array<std::uint8_t, kEncodeSteps + 1> kEncodeTable = make_encode_table();

}  // namespace

Rgba eval_texture(const Texture& texture, Vec2f uv) {
  return eval_channels<4>(texture, uv);
}

Rgb eval_texture_rgb(const Texture& texture, Vec2f uv) {
  const std::array<float, 3> v = eval_channels<3>(texture, uv);
  return {v[0], v[1], v[2]};
}

Rgba decode_texel(const Texture& texture, Texel texel) {
  const DecodeTable& color = texture.srgb ? kSrgbTable : kLinearTable;
  return {color[texel[0]], color[texel[1]], color[texel[2]], kLinearTable[texel[3]]};
}

Texel encode_texel(const Texture& texture, const Rgba& value) {
  Texel texel;
  for (std::size_t c = 0; c < 4; ++c) {
    const float v = std::clamp(value[c], 0.0F, 1.0F);
    texel[c] = c < 3 && texture.srgb ? kEncodeTable[std::size_t(v * float(kEncodeSteps) + 0.5F)]
                                     : std::uint8_t(std::lround(255 * v));
  }
  return texel;
}

}  // namespace arris
