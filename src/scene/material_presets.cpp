#include "scene/material_presets.h"

namespace arris {
namespace {

struct Look {
  Rgb color;
  float roughness = 0.4F;
  float metallic = 0;
};

MaterialPreset make(std::string_view name, std::string_view description, const Look& look) {
  Material material;
  material.name = name;
  material.base_color = look.color;
  material.roughness = look.roughness;
  material.metallic = look.metallic;
  return {name, description, material};
}

MaterialPreset with_clearcoat(MaterialPreset preset, float roughness) {
  preset.material.clearcoat = 1;
  preset.material.clearcoat_roughness = roughness;
  return preset;
}

MaterialPreset transparent(MaterialPreset preset, float ior) {
  preset.material.transmission = 1;
  preset.material.ior = ior;
  return preset;
}

std::vector<MaterialPreset> make_presets() {
  return {
      make("clay", "matt light grey, for judging form", {{0.62F, 0.60F, 0.57F}, 0.9F}),
      make("plastic-white", "satin white", {{0.80F, 0.80F, 0.78F}, 0.35F}),
      make("plastic-grey", "satin grey", {{0.30F, 0.31F, 0.33F}, 0.35F}),
      make("plastic-black", "satin black", {{0.020F, 0.020F, 0.022F}, 0.3F}),
      make("plastic-red", "satin red", {{0.56F, 0.035F, 0.028F}, 0.3F}),
      make("plastic-orange", "satin orange", {{0.75F, 0.19F, 0.02F}, 0.3F}),
      make("plastic-yellow", "satin yellow", {{0.80F, 0.52F, 0.04F}, 0.3F}),
      make("plastic-green", "satin green", {{0.06F, 0.31F, 0.09F}, 0.3F}),
      make("plastic-blue", "satin blue", {{0.03F, 0.13F, 0.45F}, 0.3F}),
      with_clearcoat(
          make("lacquer-red", "deep red under a clear coat", {{0.36F, 0.01F, 0.012F}, 0.5F}),
          0.03F),
      with_clearcoat(make("porcelain", "white under a clear glaze", {{0.82F, 0.81F, 0.77F}, 0.6F}),
                     0.03F),
      make("rubber", "matt black", {{0.028F, 0.028F, 0.030F}, 0.8F}),
      make("steel", "brushed steel", {{0.56F, 0.55F, 0.53F}, 0.32F, 1}),
      make("chrome", "polished chromium", {{0.55F, 0.556F, 0.554F}, 0.06F, 1}),
      make("aluminium", "satin aluminium", {{0.91F, 0.92F, 0.92F}, 0.35F, 1}),
      make("brass", "satin brass", {{0.89F, 0.70F, 0.34F}, 0.25F, 1}),
      make("copper", "satin copper", {{0.93F, 0.62F, 0.52F}, 0.25F, 1}),
      make("gold", "polished gold", {{1.00F, 0.77F, 0.31F}, 0.15F, 1}),
      make("iron", "rough cast iron", {{0.33F, 0.32F, 0.31F}, 0.6F, 1}),
      transparent(make("glass", "clear glass, ior 1.5", {{1, 1, 1}, 0}), 1.5F),
      transparent(make("frosted-glass", "rough glass, ior 1.5", {{0.97F, 0.99F, 0.98F}, 0.3F}),
                  1.5F),
  };
}

const std::vector<MaterialPreset>& presets() {
  static const std::vector<MaterialPreset> kPresets = make_presets();
  return kPresets;
}

}  // namespace

std::span<const MaterialPreset> material_presets() {
  return presets();
}

std::optional<Material> find_material_preset(std::string_view name) {
  for (const MaterialPreset& preset : presets()) {
    if (preset.name == name) return preset.material;
  }
  return std::nullopt;
}

std::vector<std::string> material_preset_names() {
  std::vector<std::string> names;
  for (const MaterialPreset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

bool is_unset(const Material& material) {
  const Material plain;
  return material.base_color == plain.base_color && material.metallic == plain.metallic &&
         material.roughness == plain.roughness && material.transmission == plain.transmission &&
         material.clearcoat == plain.clearcoat && material.emission == plain.emission &&
         material.opacity == plain.opacity && !material.base_color_texture &&
         !material.metallic_roughness_texture && !material.glossy_mix;
}

}  // namespace arris
