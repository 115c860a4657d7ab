// texture_lookup.h — what a texture says at a place
// What       bilinear lookup, with glTF's wrap modes; sRGB is decoded texel by texel before filtering
// Cost       about 10 ns
#pragma once

#include <array>
#include <cstdint>

#include "arris/math.h"
#include "arris/scene.h"

namespace arris {

using Texel = std::array<std::uint8_t, 4>;
using Rgba = std::array<float, 4>;  // linear

Rgba eval_texture(const Texture& texture, Vec2f uv);
Rgb eval_texture_rgb(const Texture& texture, Vec2f uv);

Rgba decode_texel(const Texture& texture, Texel texel);
// The nearest one; values outside of 0 to 1 are clamped.
Texel encode_texel(const Texture& texture, const Rgba& value);

}  // namespace arris
