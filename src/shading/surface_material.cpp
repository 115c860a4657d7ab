#include "shading/surface_material.h"

#include <cmath>

#include "shading/texture_lookup.h"

namespace arris {
namespace {

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
  return eval_base_color(material, textures[material.base_color_texture->index], uv);
}

Rgb eval_base_color(const Material& material, const Texture& texture, Vec2f uv) {
  return material.base_color * eval_texture_rgb(texture, uv);
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
