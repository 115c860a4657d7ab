// material_presets.h — materials by name, for models that bring none
// Source     metals: reflectance at normal incidence from measured n and k (refractiveindex.info), as linear
//            Rec. 709; others: by eye, within what dielectrics of ior 1.5 allow
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/scene.h"

namespace arris {

struct MaterialPreset {
  std::string_view name;
  std::string_view description;
  Material material;  // with its name
};

// In the order in which a list shows them.
std::span<const MaterialPreset> material_presets();

std::optional<Material> find_material_preset(std::string_view name);
std::vector<std::string> material_preset_names();

// As readers leave it where a file has none.
bool is_unset(const Material& material);

}  // namespace arris
