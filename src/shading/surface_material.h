// surface_material.h — a material at one point of a surface
// What       eval_material() multiplies a material's factors with its textures at uv (texture_lookup.h), with glTF's
//            channels
// Out        linear values; the normal in tangent space: x along dP/du, y along -dP/dv (up in
//            the picture), z along the interpolated normal; unit, (0, 0, 1) without a normal texture
// Cost       without textures a copy; about 10 ns for each texture
// Limits     no mipmaps: the path tracer's own samples filter
#pragma once

#include <span>

#include "arris/math.h"
#include "arris/scene.h"

namespace arris {

struct SurfaceMaterial {
  Rgb base_color{0.8F, 0.8F, 0.8F};
  float metallic = 0;
  float roughness = 0.5F;
  float ior = 1.5F;
  float specular = 1;
  Rgb specular_color{1, 1, 1};
  float transmission = 0;
  float clearcoat = 0;
  float clearcoat_roughness = 0;
  // The share of GGX in the plain mix; meaningful if is_mix (see Material::glossy_mix).
  float glossy_share = 0;
  bool is_mix = false;
  float opacity = 1;  // 0 or 1 if the material has an alpha_cutoff
  Rgb emission{0, 0, 0};
  Vec3f normal{0, 0, 1};
};

// The factors alone. What the path tracer may store for each material without textures.
SurfaceMaterial material_factors(const Material& material);

bool has_textures(const Material& material);

// textures: the scene's.
SurfaceMaterial eval_material(const Material& material, std::span<const Texture> textures,
                              Vec2f uv);

// Base colour alone.
Rgb eval_base_color(const Material& material, std::span<const Texture> textures, Vec2f uv);
// With this texture instead of its own.
Rgb eval_base_color(const Material& material, const Texture& texture, Vec2f uv);

// Light that a surface reflects can be told apart from its base colour's texture: it has one, and at no place emits or
// transmits.
bool can_be_tinted(const Material& material);
// And at this place is opaque. shown: the material there.
inline bool is_tinted(const Material& material, const SurfaceMaterial& shown) {
  constexpr float kOpaque = 0.999F;  // interpolated opacities are 1 to their rounding
  return can_be_tinted(material) && shown.opacity > kOpaque;
}

// Opacity alone, for shadow rays and for hits that may be passed.
float eval_opacity(const Material& material, std::span<const Texture> textures, Vec2f uv);

// Emitted radiance alone, for points sampled on emissive triangles.
Rgb eval_emission(const Material& material, std::span<const Texture> textures, Vec2f uv);

}  // namespace arris
