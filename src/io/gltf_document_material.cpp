#include <fmt/format.h>

#include <algorithm>

#include "base/utf8_text.h"
#include "io/gltf_document_parts.h"

namespace arris {
namespace {

// Exporters write 1.0000001; anything farther outside 0 to 1 is an error.
constexpr double kFactorSlack = 1e-3;

float unit_factor(const JsonValue& owner, const char* key, double fallback) {
  return float(std::clamp(owner.number(key, fallback, -kFactorSlack, 1 + kFactorSlack), 0.0, 1.0));
}

Rgb color_factor(const JsonValue& owner, const char* key, Vec3d fallback) {
  const Vec3d color = owner.vec3(key, fallback);
  if (!(color.x >= 0 && color.y >= 0 && color.z >= 0)) {
    owner.get(key).fail("colours must not be negative");
  }
  return Rgb(color);
}

GltfUvTransform parse_uv_transform(const JsonValue& value) {
  const auto pair = [&](const char* key, Vec2d fallback) {
    const std::optional<JsonValue> found = value.find(key);
    if (!found) return fallback;
    if (found->size() != 2) found->fail("must have 2 numbers");
    return Vec2d{found->at(0).as_number(), found->at(1).as_number()};
  };
  GltfUvTransform transform;
  transform.offset = pair("offset", transform.offset);
  transform.scale = pair("scale", transform.scale);
  transform.rotation = value.number("rotation", 0);
  return transform;
}

std::optional<GltfTextureUse> parse_use(const JsonValue& owner, const char* key,
                                        std::size_t texture_count) {
  const std::optional<JsonValue> value = owner.find(key);
  if (!value) return std::nullopt;
  GltfTextureUse use;
  use.texture = value->get("index").as_index(texture_count, "textures");
  std::uint64_t uv_set = value->count("texCoord", 0);
  if (const auto transform = value->extension("KHR_texture_transform")) {
    use.transform = parse_uv_transform(*transform);
    uv_set = transform->count("texCoord", uv_set);
  }
  if (uv_set > 255) value->fail(fmt::format("no mesh has {} texture coordinate sets", uv_set));
  use.uv_set = std::uint32_t(uv_set);
  return use;
}

struct MaterialParser {
  const JsonValue& value;
  std::size_t texture_count;
  GltfMaterial& material;

  void texture(GltfSlot slot, const JsonValue& owner, const char* key) const {
    material.textures[std::size_t(slot)] = parse_use(owner, key, texture_count);
  }

  void metallic_roughness() const {
    Material& factors = material.factors;
    factors.base_color = {1, 1, 1};
    factors.metallic = 1;
    factors.roughness = 1;
    const std::optional<JsonValue> pbr = value.find("pbrMetallicRoughness");
    if (!pbr) return;
    factors.metallic = unit_factor(*pbr, "metallicFactor", 1);
    factors.roughness = unit_factor(*pbr, "roughnessFactor", 1);
    if (const auto color = pbr->find("baseColorFactor")) {
      if (color->size() != 4) color->fail("must have 4 numbers");
      const auto channel = [&](std::size_t i) {
        const double number = color->at(i).as_number();
        if (!(number >= -kFactorSlack && number <= 1 + kFactorSlack)) {
          color->fail(fmt::format("{} is outside 0 to 1", number));
        }
        return float(std::clamp(number, 0.0, 1.0));
      };
      factors.base_color = {channel(0), channel(1), channel(2)};
      factors.opacity = channel(3);
    }
    texture(GltfSlot::base_color, *pbr, "baseColorTexture");
    texture(GltfSlot::metallic_roughness, *pbr, "metallicRoughnessTexture");
  }

  void alpha() const {
    const std::string mode = value.string("alphaMode", "OPAQUE");
    material.opaque = mode == "OPAQUE";
    if (material.opaque) {
      material.factors.opacity = 1;
    } else if (mode == "MASK") {
      material.factors.alpha_cutoff = float(value.number("alphaCutoff", 0.5, 0, 1e6));
    } else if (mode != "BLEND") {
      value.get("alphaMode").fail(fmt::format("{}; use OPAQUE, MASK or BLEND", in_quotes(mode)));
    }
  }

  void emission_and_normal() const {
    double strength = 1;
    if (const auto extension = value.extension("KHR_materials_emissive_strength")) {
      strength = extension->number("emissiveStrength", 1, 0, 1e9);
    }
    material.factors.emission = color_factor(value, "emissiveFactor", Vec3d(0.0)) * float(strength);
    texture(GltfSlot::emission, value, "emissiveTexture");
    texture(GltfSlot::normal, value, "normalTexture");
    if (const auto normal = value.find("normalTexture")) {
      material.factors.normal_scale = float(normal->number("scale", 1, -1e3, 1e3));
    }
  }

  // In KHR_materials_ior 0 stands for total reflection.
  void ior_and_specular() const {
    if (const auto extension = value.extension("KHR_materials_ior")) {
      constexpr double kTotalReflection = 1000;
      const double ior = extension->number("ior", 1.5, 0, kTotalReflection);
      if (ior > 0 && ior < 1) extension->fail(fmt::format("ior {} is below 1", ior));
      material.factors.ior = float(ior == 0 ? kTotalReflection : ior);
    }
    if (const auto extension = value.extension("KHR_materials_specular")) {
      material.factors.specular = unit_factor(*extension, "specularFactor", 1);
      material.factors.specular_color = color_factor(*extension, "specularColorFactor", Vec3d(1.0));
    }
  }

  void transmission_and_clearcoat() const {
    if (const auto extension = value.extension("KHR_materials_transmission")) {
      material.factors.transmission = unit_factor(*extension, "transmissionFactor", 0);
      texture(GltfSlot::transmission, *extension, "transmissionTexture");
    }
    if (const auto extension = value.extension("KHR_materials_clearcoat")) {
      material.factors.clearcoat = unit_factor(*extension, "clearcoatFactor", 0);
      material.factors.clearcoat_roughness = unit_factor(*extension, "clearcoatRoughnessFactor", 0);
      texture(GltfSlot::clearcoat, *extension, "clearcoatTexture");
      texture(GltfSlot::clearcoat_roughness, *extension, "clearcoatRoughnessTexture");
    }
  }
};

// Textures that Material has no place for.
void note_left_out(const JsonValue& value, const std::string& name,
                   std::vector<std::string>& notes) {
  const auto specular = value.extension("KHR_materials_specular");
  if (specular && (specular->find("specularTexture") || specular->find("specularColorTexture"))) {
    notes.push_back(
        fmt::format("material {}: its specular textures are left out", in_quotes(name)));
  }
  const auto clearcoat = value.extension("KHR_materials_clearcoat");
  if (clearcoat && clearcoat->find("clearcoatNormalTexture")) {
    notes.push_back(
        fmt::format("material {}: its clearcoat normal texture is left out", in_quotes(name)));
  }
}

}  // namespace

GltfMaterial parse_gltf_material(const JsonValue& value, std::size_t texture_count,
                                 std::vector<std::string>& notes) {
  GltfMaterial material;
  material.factors.name = value.string("name", "");
  const MaterialParser parser{value, texture_count, material};
  parser.metallic_roughness();
  parser.alpha();
  parser.emission_and_normal();
  parser.ior_and_specular();
  parser.transmission_and_clearcoat();
  note_left_out(value, material.factors.name, notes);
  return material;
}

}  // namespace arris
