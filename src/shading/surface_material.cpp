#include "shading/surface_material.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace arris {
namespace {

using Texel = std::array<std::uint8_t, 4>;
using Rgba = std::array<float, 4>;
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

int wrap_index(int i, int size, Texture::Wrap wrap) {
  switch (wrap) {
    case Texture::Wrap::clamp:
      return i < 0 ? 0 : i >= size ? size - 1 : i;
    case Texture::Wrap::mirror: {
      const int period = 2 * size;
      const int m = ((i % period) + period) % period;
      return m < size ? m : period - 1 - m;
    }
    case Texture::Wrap::repeat:
      break;
  }
  return ((i % size) + size) % size;
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
  const int i = int(floor_x);
  return {wrap_index(i, size, wrap), wrap_index(i + 1, size, wrap), x - floor_x};
}

Rgba eval_texture(const Texture& texture, Vec2f uv) {
  const Neighbours u = neighbours_of(uv.x, texture.width_px, texture.wrap_u);
  const Neighbours v = neighbours_of(uv.y, texture.height_px, texture.wrap_v);
  const DecodeTable& color = texture.srgb ? kSrgbTable : kLinearTable;
  const Texel* row0 = texture.texels.data() + std::size_t(v.first) * std::size_t(texture.width_px);
  const Texel* row1 = texture.texels.data() + std::size_t(v.second) * std::size_t(texture.width_px);
  const float w11 = u.fraction * v.fraction;
  const float w10 = u.fraction - w11;
  const float w01 = v.fraction - w11;
  const float w00 = 1.0F - u.fraction - w01;
  Rgba result;
  for (std::size_t c = 0; c < 4; ++c) {
    const DecodeTable& decode = c < 3 ? color : kLinearTable;
    result[c] = w00 * decode[row0[u.first][c]] + w10 * decode[row0[u.second][c]] +
                w01 * decode[row1[u.first][c]] + w11 * decode[row1[u.second][c]];
  }
  return result;
}

Rgb rgb(const Rgba& v) {
  return {v[0], v[1], v[2]};
}

float cut_opacity(const Material& material, float opacity) {
  return material.alpha_cutoff ? (opacity >= *material.alpha_cutoff ? 1.0F : 0.0F) : opacity;
}

// Scales x and y, then restores unit length, as glTF says.
Vec3f decode_normal(const Rgba& v, float scale) {
  const Vec3f n{(2.0F * v[0] - 1.0F) * scale, (2.0F * v[1] - 1.0F) * scale, 2.0F * v[2] - 1.0F};
  const float squared = length_squared(n);
  return squared > 1e-12F && n.z > 0.0F ? n * (1.0F / std::sqrt(squared)) : Vec3f{0, 0, 1};
}

}  // namespace

SurfaceMaterial material_factors(const Material& material) {
  SurfaceMaterial s;
  s.base_color = material.base_color;
  s.metallic = material.metallic;
  s.roughness = material.roughness;
  s.ior = material.ior;
  s.specular = material.specular;
  s.specular_color = material.specular_color;
  s.transmission = material.transmission;
  s.clearcoat = material.clearcoat;
  s.clearcoat_roughness = material.clearcoat_roughness;
  s.is_mix = material.glossy_mix.has_value();
  s.glossy_share = material.glossy_mix.value_or(0.0F);
  s.opacity = cut_opacity(material, material.opacity);
  s.emission = material.emission;
  return s;
}

bool has_textures(const Material& material) {
  return material.base_color_texture || material.metallic_roughness_texture ||
         material.emission_texture || material.normal_texture || material.transmission_texture ||
         material.clearcoat_texture || material.clearcoat_roughness_texture;
}

SurfaceMaterial eval_material(const Material& material, std::span<const Texture> textures,
                              Vec2f uv) {
  SurfaceMaterial s = material_factors(material);
  const auto lookup = [&](TextureId id) { return eval_texture(textures[id.index], uv); };
  if (material.base_color_texture) {
    const Rgba v = lookup(*material.base_color_texture);
    s.base_color *= rgb(v);
    s.opacity = cut_opacity(material, material.opacity * v[3]);
  }
  if (material.metallic_roughness_texture) {
    const Rgba v = lookup(*material.metallic_roughness_texture);
    s.roughness *= v[1];
    s.metallic *= v[2];
  }
  if (material.emission_texture) {
    s.emission *= rgb(lookup(*material.emission_texture));
  }
  if (material.normal_texture) {
    s.normal = decode_normal(lookup(*material.normal_texture), material.normal_scale);
  }
  if (material.transmission_texture) {
    s.transmission *= lookup(*material.transmission_texture)[0];
  }
  if (material.clearcoat_texture) {
    s.clearcoat *= lookup(*material.clearcoat_texture)[0];
  }
  if (material.clearcoat_roughness_texture) {
    s.clearcoat_roughness *= lookup(*material.clearcoat_roughness_texture)[1];
  }
  return s;
}

Rgb eval_base_color(const Material& material, std::span<const Texture> textures, Vec2f uv) {
  if (!material.base_color_texture) return material.base_color;
  return material.base_color * rgb(eval_texture(textures[material.base_color_texture->index], uv));
}

bool can_be_tinted(const Material& material) {
  return material.base_color_texture && material.transmission == 0 &&
         !(max_component(material.emission) > 0);
}

float eval_opacity(const Material& material, std::span<const Texture> textures, Vec2f uv) {
  float opacity = material.opacity;
  if (material.base_color_texture) {
    opacity *= eval_texture(textures[material.base_color_texture->index], uv)[3];
  }
  return cut_opacity(material, opacity);
}

Rgb eval_emission(const Material& material, std::span<const Texture> textures, Vec2f uv) {
  return material.emission_texture
             ? material.emission * rgb(eval_texture(textures[material.emission_texture->index], uv))
             : material.emission;
}

}  // namespace arris
