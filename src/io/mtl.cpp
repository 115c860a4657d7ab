// Source     Alias Wavefront, "MTL material format" (1995); physically based keys: the extension by
//            Exocortex; Ns to roughness: B. Walter et al., "Microfacet Models for Refraction through Rough
//            Surfaces" (2007), §5.2, α² = 2 / (Ns + 2)
#include "io/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/utf8_text.h"
#include "io/mesh_scene.h"
#include "io/text_scanner.h"

namespace arris {
namespace {

// What the lines of one material say.
struct MtlEntry {
  std::string name;
  std::optional<Rgb> diffuse, specular, emission;
  std::optional<float> shininess, dissolve, transparency;
  std::optional<float> roughness, metallic;
  float ior = 0, clearcoat = 0, clearcoat_roughness = 0;
  int illumination = 2;
  std::optional<TextureId> diffuse_texture, emission_texture, normal_texture;
};

// Illumination models that refract what shines through: glass.
bool is_glass(int illumination) {
  return illumination == 4 || illumination == 6 || illumination == 7;
}

// Ks is no physical quantity: half, which exporters write by default, and more is a dielectric's full
// reflection, 0 is matte.
void set_specular(Material& material, const MtlEntry& entry) {
  if (entry.illumination < 2 && !entry.roughness) material.specular = 0;
  if (!entry.specular) return;
  const float most = max_component(*entry.specular);
  if (most <= 0) {
    material.specular = 0;
    return;
  }
  material.specular = std::min(material.specular, std::min(1.0F, 2 * most));
  material.specular_color = *entry.specular / most;
}

Material make_material(const MtlEntry& entry) {
  Material material;
  material.name = entry.name;
  if (entry.diffuse_texture) material.base_color = Rgb(1, 1, 1);
  if (entry.diffuse) material.base_color = *entry.diffuse;
  set_specular(material, entry);
  if (entry.shininess) material.roughness = std::pow(2 / (*entry.shininess + 2), 0.25F);
  if (entry.roughness) material.roughness = *entry.roughness;
  material.metallic = entry.metallic.value_or(0.0F);
  if (entry.ior > 1) material.ior = entry.ior;
  material.clearcoat = entry.clearcoat;
  material.clearcoat_roughness = entry.clearcoat_roughness;
  const Rgb own_emission(entry.emission_texture ? 1.0F : 0.0F);
  material.emission = entry.emission.value_or(own_emission);
  const float opacity = entry.dissolve.value_or(1 - entry.transparency.value_or(0.0F));
  if (is_glass(entry.illumination)) {
    material.transmission = 1 - opacity;
  } else {
    material.opacity = opacity;
  }
  material.base_color_texture = entry.diffuse_texture;
  material.emission_texture = entry.emission_texture;
  material.normal_texture = entry.normal_texture;
  return material;
}

// Options of a texture line with the number of words after them; those that shift or scale a picture are
// not among them, for Arris' textures can't.
struct MapOption {
  std::string_view name;
  int words;
};
constexpr MapOption kMapOptions[] = {{"-blendu", 1}, {"-blendv", 1}, {"-cc", 1},     {"-clamp", 1},
                                     {"-boost", 1},  {"-bm", 1},     {"-texres", 1}, {"-mm", 2},
                                     {"-type", 1},   {"-imfchan", 1}};
constexpr std::string_view kMovingOptions[] = {"-o", "-s", "-t"};

// Keys that have no counterpart in Arris' material, or that only repeat others.
constexpr std::string_view kUnreadKeys[] = {"Ka",   "Tf",    "sharpness", "Ps",   "aniso", "anisor",
                                            "bump", "decal", "disp",      "refl", "Km",    "Kt"};

template <class Range>
bool contains(const Range& range, std::string_view word) {
  return std::find(std::begin(range), std::end(range), word) != std::end(range);
}

}  // namespace

class MtlReader::Library {
 public:
  Library(std::span<const std::uint8_t> bytes, const std::string& library, const std::string& file,
          MtlReader& reader)
      : text_(bytes, file), file_(file), reader_(reader) {
    const std::size_t slash = library.find_last_of("/\\");
    if (slash != std::string::npos) folder_ = library.substr(0, slash + 1);
  }

  void read() {
    while (text_.next_line()) {
      const std::string_view key = text_.word();
      if (key.empty() || key[0] == '#') continue;
      if (key == "newmtl") {
        finish_entry();
        start_entry();
      } else if (!entry_) {
        throw text_.error("found " + in_quotes(key) + " before the first \"newmtl\"");
      } else {
        read_key(key);
      }
    }
    finish_entry();
  }

 private:
  void start_entry() {
    const std::string_view name = text_.rest_of_line();
    if (name.empty()) throw text_.error("the material has no name");
    if (const std::string problem = problem_with_name(name); !problem.empty()) {
      throw text_.error(problem);
    }
    if (reader_.names_.size() == kMaxMaterials) {
      throw text_.error("more than " + std::to_string(kMaxMaterials) +
                        " materials; leave some out");
    }
    entry_ = MtlEntry{};
    entry_->name = name;
  }

  void finish_entry() {
    if (!entry_) return;
    const MaterialId id{std::uint32_t(reader_.scene_.materials.size())};
    if (reader_.names_.emplace(entry_->name, id).second) {
      reader_.scene_.materials.push_back(make_material(*entry_));
    } else {
      note_once("newmtl",
                "material " + in_quotes(entry_->name) + " appears twice; the first is used");
    }
    entry_.reset();
  }

  void read_key(std::string_view key) {
    MtlEntry& e = *entry_;
    if (key == "Kd") {
      e.diffuse = color("Kd", 1.0F);
    } else if (key == "Ks") {
      e.specular = color("Ks", std::nullopt);
    } else if (key == "Ke") {
      e.emission = color("Ke", std::nullopt);
    } else if (key == "Ns") {
      e.shininess = number("Ns", std::nullopt);
    } else if (key == "Ni") {
      e.ior = number("Ni", std::nullopt);
    } else if (key == "d") {
      e.dissolve = dissolve();
    } else if (key == "Tr") {
      e.transparency = number("Tr", 1.0F);
    } else if (key == "Pr") {
      e.roughness = number("Pr", 1.0F);
    } else if (key == "Pm") {
      e.metallic = number("Pm", 1.0F);
    } else if (key == "Pc") {
      e.clearcoat = number("Pc", 1.0F);
    } else if (key == "Pcr") {
      e.clearcoat_roughness = number("Pcr", 1.0F);
    } else if (key == "illum") {
      e.illumination = int(number("illum", 10.0F));
    } else if (key == "map_Kd") {
      e.diffuse_texture = texture(key, ColorSpace::srgb);
    } else if (key == "map_Ke") {
      e.emission_texture = texture(key, ColorSpace::srgb);
    } else if (key == "norm") {
      e.normal_texture = texture(key, ColorSpace::linear);
    } else if (key.starts_with("map_") || contains(kUnreadKeys, key)) {
      if (key != "Ka" && key != "Tf") note_once(key, in_quotes(key) + " is not read");
    } else {
      throw text_.error("the key " + in_quotes(key) +
                        " is not known; correct it or delete the line");
    }
  }

  float number(std::string_view key, std::optional<float> most) {
    return within(text_.number(key), key, most);
  }

  float within(float value, std::string_view key, std::optional<float> most) const {
    if (value >= 0 && value <= most.value_or(value)) return value;
    const std::string limit = most ? " to " + std::to_string(int(*most)) : " or more";
    throw text_.error(std::string(key) + " is " + in_quotes(fmt::format("{:g}", value)) +
                      "; use a number from 0" + limit);
  }

  // One number stands for three equal ones.
  Rgb color(std::string_view key, std::optional<float> most) {
    const std::string_view word = text_.word();
    if (word == "spectral" || word == "xyz") {
      throw text_.error(std::string(key) + " " + std::string(word) +
                        " is not read; write three numbers: red, green and blue");
    }
    const float red = within(text_.to_number(word, key), key, most);
    if (text_.rest_of_line().empty()) return Rgb(red);
    const float green = number(key, most);
    const float blue = number(key, most);
    return {red, green, blue};
  }

  // "d -halo factor" fades with the angle of view, which is not followed.
  float dissolve() {
    const std::string_view word = text_.word();
    if (word == "-halo") return number("d", 1.0F);
    return within(text_.to_number(word, "d"), "d", 1.0F);
  }

  enum class ColorSpace { srgb, linear };

  TextureId texture(std::string_view key, ColorSpace space) {
    bool clamped = false;
    std::string_view name = text_.rest_of_line();
    while (name.starts_with('-')) {
      const std::string_view option = text_.word();
      if (contains(kMovingOptions, option)) {
        throw text_.error(std::string(key) + " " + std::string(option) +
                          " moves the picture, which is not read; change the texture coordinates");
      }
      const auto* const known = std::find_if(std::begin(kMapOptions), std::end(kMapOptions),
                                             [&](const MapOption& o) { return o.name == option; });
      if (known == std::end(kMapOptions)) break;
      for (int i = 0; i < known->words; ++i) {
        const std::string_view value = text_.word();
        if (option == "-clamp") clamped = value == "on";
      }
      name = text_.rest_of_line();
    }
    if (name.empty()) throw text_.error(std::string(key) + " names no file");
    return find_texture(std::string(name), space,
                        clamped ? Texture::Wrap::clamp : Texture::Wrap::repeat);
  }

  TextureId find_texture(const std::string& name, ColorSpace space, Texture::Wrap wrap) {
    const std::string key = name + (space == ColorSpace::srgb ? "|srgb|" : "|linear|") +
                            (wrap == Texture::Wrap::clamp ? "clamp" : "repeat");
    const auto known = reader_.textures_.find(key);
    if (known != reader_.textures_.end()) return known->second;
    // Programs on Windows write folders with a backslash.
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    std::optional<Texture> texture = reader_.files_.find_texture(folder_ + plain);
    if (!texture) {
      throw text_.error("the picture " + in_quotes(name) +
                        " is not there; put it beside the library or delete the line");
    }
    texture->srgb = space == ColorSpace::srgb;
    texture->wrap_u = texture->wrap_v = wrap;
    const TextureId id{std::uint32_t(reader_.scene_.textures.size())};
    reader_.scene_.textures.push_back(std::move(*texture));
    reader_.textures_.emplace(key, id);
    return id;
  }

  // Once for each key; more different ones than this are no library's.
  void note_once(std::string_view key, const std::string& what) {
    constexpr std::size_t kMaxNotes = 20;
    if (noted_.size() == kMaxNotes || !noted_.insert(std::string(key)).second) return;
    reader_.scene_.notes.push_back(file_ + ": " + what);
  }

  TextScanner text_;
  std::string file_;
  std::string folder_;  // of the library, relative to the model; empty or ends in a slash
  MtlReader& reader_;
  std::optional<MtlEntry> entry_;
  std::set<std::string> noted_;
};

void MtlReader::read(std::span<const std::uint8_t> bytes, const std::string& library,
                     const std::string& file) {
  Library(bytes, library, file, *this).read();
}

}  // namespace arris
