#include "io/gltf_material.h"

#include <fmt/format.h>

#include <map>
#include <tuple>

#include "base/utf8_text.h"
#include "io/decode_image.h"
#include "io/uri_bytes.h"

namespace arris {
namespace {

struct SlotUse {
  GltfSlot slot;
  std::optional<TextureId> Material::*texture;
  bool srgb;
};
constexpr std::array<SlotUse, kGltfSlotCount> kSlots = {{
    {GltfSlot::base_color, &Material::base_color_texture, true},
    {GltfSlot::metallic_roughness, &Material::metallic_roughness_texture, false},
    {GltfSlot::emission, &Material::emission_texture, true},
    {GltfSlot::normal, &Material::normal_texture, false},
    {GltfSlot::transmission, &Material::transmission_texture, false},
    {GltfSlot::clearcoat, &Material::clearcoat_texture, false},
    {GltfSlot::clearcoat_roughness, &Material::clearcoat_roughness_texture, false},
}};

// The coordinates of the material's first texture, which all its textures share.
GltfUvChoice choose_uvs(const GltfMaterial& material, std::vector<std::string>& notes) {
  GltfUvChoice choice;
  bool differ = false;
  for (const std::optional<GltfTextureUse>& use : material.textures) {
    if (!use) continue;
    if (!choice.needed) choice = {use->uv_set, use->transform, true};
    differ = differ || use->uv_set != choice.set || use->transform != choice.transform;
  }
  if (differ) {
    notes.push_back(
        fmt::format("material {}: its textures differ in their coordinates; those of the "
                    "first are used for all",
                    in_quotes(material.factors.name)));
  }
  return choice;
}

class TextureCache {
 public:
  TextureCache(const GltfSource& source, const std::optional<std::filesystem::path>& base_folder)
      : source_(source), base_folder_(base_folder) {}

  struct Use {
    std::uint32_t image = 0;
    Texture::Wrap wrap_u{}, wrap_v{};
    bool srgb = false, opaque = false;
    [[nodiscard]] auto key() const { return std::tuple(image, wrap_u, wrap_v, srgb, opaque); }
  };

  TextureId find_or_make(const Use& use) {
    const auto [entry, is_new] =
        made_.try_emplace(use.key(), TextureId{std::uint32_t(textures_.size())});
    if (is_new) textures_.push_back(make(use));
    return entry->second;
  }

  std::vector<Texture> take() { return std::move(textures_); }

 private:
  Texture make(const Use& use) {
    const Rgba8Image& image = decoded(use.image);
    Texture texture;
    texture.name = source_.document.images[use.image].name;
    texture.width_px = image.width_px;
    texture.height_px = image.height_px;
    texture.texels = image.texels;
    texture.srgb = use.srgb;
    texture.wrap_u = use.wrap_u;
    texture.wrap_v = use.wrap_v;
    if (use.opaque) {
      for (auto& texel : texture.texels) texel[3] = 255;
    }
    return texture;
  }

  const Rgba8Image& decoded(std::uint32_t index) {
    const auto [entry, is_new] = images_.try_emplace(index);
    if (!is_new) return entry->second;
    const GltfImage& image = source_.document.images[index];
    const std::string place =
        fmt::format("{}: images[{}] ({})", source_.where, index, in_quotes(image.name));
    if (image.uri) {
      entry->second = decode_image(load_uri(*image.uri, base_folder_, place), place);
    } else {
      entry->second = decode_image(source_.buffers.views[*image.view], place);
    }
    return entry->second;
  }

  const GltfSource& source_;
  const std::optional<std::filesystem::path>& base_folder_;
  std::map<std::tuple<std::uint32_t, Texture::Wrap, Texture::Wrap, bool, bool>, TextureId> made_;
  std::map<std::uint32_t, Rgba8Image> images_;
  std::vector<Texture> textures_;
};

}  // namespace

GltfMaterials make_gltf_materials(const GltfSource& source,
                                  const std::optional<std::filesystem::path>& base_folder) {
  GltfMaterials result;
  TextureCache cache(source, base_folder);
  for (const GltfMaterial& from : source.document.materials) {
    Material material = from.factors;
    for (const SlotUse& slot : kSlots) {
      const std::optional<GltfTextureUse>& use = from.textures[std::size_t(slot.slot)];
      if (!use) continue;
      const GltfTexture& texture = source.document.textures[use->texture];
      const bool opaque = slot.slot != GltfSlot::base_color || from.opaque;
      material.*slot.texture =
          cache.find_or_make({texture.image, texture.wrap_u, texture.wrap_v, slot.srgb, opaque});
    }
    result.uv_choices.push_back(choose_uvs(from, result.notes));
    result.materials.push_back(std::move(material));
  }
  result.textures = cache.take();
  return result;
}

}  // namespace arris
