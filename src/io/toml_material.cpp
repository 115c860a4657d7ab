#include <fmt/format.h>

#include <array>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/decode_image.h"
#include "io/file_bytes.h"
#include "io/toml_scene_parts.h"

namespace arris {
namespace {

struct NumberKey {
  const char* key;
  float Material::*member;
  TomlRange range;
};
constexpr std::array<NumberKey, 9> kNumbers = {{
    {"metallic", &Material::metallic, kTomlUnit},
    {"roughness", &Material::roughness, kTomlUnit},
    {"ior", &Material::ior, {1, 100}},
    {"specular", &Material::specular, kTomlUnit},
    {"transmission", &Material::transmission, kTomlUnit},
    {"clearcoat", &Material::clearcoat, kTomlUnit},
    {"clearcoat_roughness", &Material::clearcoat_roughness, kTomlUnit},
    {"opacity", &Material::opacity, kTomlUnit},
    {"normal_scale", &Material::normal_scale, {-100, 100}},
}};

struct ColorKey {
  const char* key;
  Rgb Material::*member;
  TomlRange range;
};
constexpr std::array<ColorKey, 3> kColors = {{
    {"base_color", &Material::base_color, kTomlUnit},
    {"specular_color", &Material::specular_color, kTomlNotNegative},
    {"emission", &Material::emission, kTomlNotNegative},
}};

struct TextureKey {
  const char* key;
  std::optional<TextureId> Material::*member;
  bool srgb;
};
constexpr std::array<TextureKey, 7> kTextures = {{
    {"base_color_texture", &Material::base_color_texture, true},
    {"metallic_roughness_texture", &Material::metallic_roughness_texture, false},
    {"emission_texture", &Material::emission_texture, true},
    {"normal_texture", &Material::normal_texture, false},
    {"transmission_texture", &Material::transmission_texture, false},
    {"clearcoat_texture", &Material::clearcoat_texture, false},
    {"clearcoat_roughness_texture", &Material::clearcoat_roughness_texture, false},
}};

constexpr std::array<TomlWord<Texture::Wrap>, 3> kWraps = {{{"repeat", Texture::Wrap::repeat},
                                                            {"mirror", Texture::Wrap::mirror},
                                                            {"clamp", Texture::Wrap::clamp}}};

}  // namespace

void TomlMaterials::parse(const TomlMember& member) {
  const TomlTable* table = as_toml_table(member, context_.problems);
  if (table == nullptr) return;
  for (const TomlMember& material : *table) parse_one(material);
}

std::optional<MaterialId> TomlMaterials::find(const std::string& name) const {
  const auto found = ids_.find(name);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> TomlMaterials::names() const {
  std::vector<std::string> names;
  for (const auto& [name, id] : ids_) names.push_back(name);
  return names;
}

void TomlMaterials::parse_one(const TomlMember& member) {
  const TomlTable* table = as_toml_table(member, context_.problems);
  if (table == nullptr) return;
  TomlTableReader reader(*table, member.place, "material " + in_quotes(member.key),
                         context_.problems);
  Material material;
  material.name = member.key;
  for (const ColorKey& color : kColors) {
    if (const auto value = reader.vec3(color.key, color.range)) {
      material.*color.member = Rgb(*value);
    }
  }
  for (const NumberKey& number : kNumbers) {
    if (const auto value = reader.number(number.key, number.range)) {
      material.*number.member = float(*value);
    }
  }
  if (const auto strength = reader.number("emission_strength", kTomlNotNegative)) {
    material.emission *= float(*strength);
  }
  if (const auto cutoff = reader.number("alpha_cutoff", kTomlUnit)) {
    material.alpha_cutoff = float(*cutoff);
  }
  if (const auto mix = reader.number("glossy_mix", kTomlUnit)) material.glossy_mix = float(*mix);
  parse_textures(reader, material);
  reader.report_unknown();
  if (member.key == "default") {
    context_.scene.materials[0] = material;
    has_default_ = true;
  } else {
    ids_.emplace(member.key, MaterialId{std::uint32_t(context_.scene.materials.size())});
    context_.scene.materials.push_back(material);
  }
}

// A file name, or { file = "…", wrap = "clamp" }.
void TomlMaterials::parse_textures(TomlTableReader& reader, Material& material) {
  for (const TextureKey& texture : kTextures) {
    const TomlMember* member = reader.find(texture.key);
    if (member == nullptr) continue;
    const auto* table = std::get_if<TomlTable>(&member->value.data);
    if (table == nullptr) {
      if (const auto file = reader.string(texture.key)) {
        material.*texture.member = find_or_load(*file, texture.srgb, Texture::Wrap::repeat,
                                                Texture::Wrap::repeat, member->value.place);
      }
      continue;
    }
    TomlTableReader parts(*table, member->value.place, texture.key, context_.problems);
    const auto file = parts.string("file");
    if (!parts.has("file")) parts.report_missing("file");
    const auto wrap = parts.word<Texture::Wrap>("wrap", kWraps).value_or(Texture::Wrap::repeat);
    const auto wrap_u = parts.word<Texture::Wrap>("wrap_u", kWraps).value_or(wrap);
    const auto wrap_v = parts.word<Texture::Wrap>("wrap_v", kWraps).value_or(wrap);
    parts.report_unknown();
    if (file) {
      material.*texture.member =
          find_or_load(*file, texture.srgb, wrap_u, wrap_v, member->value.place);
    }
  }
}

std::optional<TextureId> TomlMaterials::find_or_load(const std::string& file, bool srgb,
                                                     Texture::Wrap wrap_u, Texture::Wrap wrap_v,
                                                     TomlPlace place) {
  const auto key = std::tuple(file, srgb, wrap_u, wrap_v);
  if (const auto found = textures_.find(key); found != textures_.end()) return found->second;
  try {
    const std::filesystem::path path = context_.resolve(file);
    Rgba8Image image = decode_image(read_file_bytes(path), path.string());
    Texture texture;
    texture.name = file;
    texture.width_px = image.width_px;
    texture.height_px = image.height_px;
    texture.texels = std::move(image.texels);
    texture.srgb = srgb;
    texture.wrap_u = wrap_u;
    texture.wrap_v = wrap_v;
    context_.scene.textures.push_back(std::move(texture));
  } catch (const Error& error) {
    context_.problems.add(place, error.what());
    return std::nullopt;
  }
  const TextureId id{std::uint32_t(context_.scene.textures.size() - 1)};
  textures_.emplace(key, id);
  return id;
}

}  // namespace arris
