#include "io/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/gltf_document_parts.h"
#include "scene/rounding_text.h"

namespace arris {
namespace {

constexpr std::array<std::string_view, 8> kGltfExtensions = {
    "KHR_materials_ior",       "KHR_materials_specular",          "KHR_materials_transmission",
    "KHR_materials_clearcoat", "KHR_materials_emissive_strength", "KHR_lights_punctual",
    "KHR_texture_transform",   "KHR_mesh_quantization",
};

std::string remedy_for(std::string_view extension) {
  if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression") {
    return "export it again without mesh compression, or unpack it with "
           "`gltf-transform copy IN OUT`";
  }
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp") {
    return "export it again with PNG or JPEG textures";
  }
  return "export it again without";
}

void check_version(const JsonValue& root) {
  const JsonValue asset = root.get("asset");
  const JsonValue version = asset.get("version");
  if (const std::string text = version.as_string(); !text.starts_with("2.")) {
    version.fail(fmt::format("glTF version {} can't be read; export as glTF 2.0", in_quotes(text)));
  }
  if (const std::string least = asset.string("minVersion", "2.0"); least != "2.0") {
    asset.fail(fmt::format("the file needs glTF {}; 2.0 can be read", in_quotes(least)));
  }
}

void check_extensions(const JsonValue& root, std::vector<std::string>& notes) {
  std::vector<std::string> required;
  root.for_each("extensionsRequired", [&](const JsonValue& extension) {
    required.push_back(extension.as_string());
    if (std::ranges::find(kGltfExtensions, required.back()) == kGltfExtensions.end()) {
      extension.fail(fmt::format("the file needs the extension {}, which can't be read; {}",
                                 in_quotes(required.back()), remedy_for(required.back())));
    }
  });
  std::string ignored;
  root.for_each("extensionsUsed", [&](const JsonValue& extension) {
    const std::string name = extension.as_string();
    if (std::ranges::find(kGltfExtensions, name) != kGltfExtensions.end()) return;
    ignored += (ignored.empty() ? "" : ", ") + in_quotes(name);
  });
  if (!ignored.empty()) notes.push_back("extensions left out: " + ignored);
}

GltfComponent parse_component(const JsonValue& owner) {
  switch (const JsonValue type = owner.get("componentType"); type.as_count()) {
    case 5120:
      return GltfComponent::i8;
    case 5121:
      return GltfComponent::u8;
    case 5122:
      return GltfComponent::i16;
    case 5123:
      return GltfComponent::u16;
    case 5125:
      return GltfComponent::u32;
    case 5126:
      return GltfComponent::f32;
    default:
      type.fail("no component type; use 5120 to 5123, 5125 or 5126");
  }
}

int parse_component_count(const JsonValue& accessor) {
  constexpr std::array<std::pair<std::string_view, int>, 7> kTypes = {{
      {"SCALAR", 1},
      {"VEC2", 2},
      {"VEC3", 3},
      {"VEC4", 4},
      {"MAT2", 0},
      {"MAT3", 0},
      {"MAT4", 0},
  }};
  const JsonValue type = accessor.get("type");
  const std::string name = type.as_string();
  const auto found = std::ranges::find(kTypes, name, &std::pair<std::string_view, int>::first);
  if (found == kTypes.end()) type.fail(fmt::format("{} is no accessor type", in_quotes(name)));
  return found->second;
}

GltfSparse parse_sparse(const JsonValue& value, std::size_t view_count) {
  GltfSparse sparse;
  sparse.count = value.get("count").as_count();
  const JsonValue indices = value.get("indices");
  sparse.index_view = indices.get("bufferView").as_index(view_count, "bufferViews");
  sparse.index_offset = indices.count("byteOffset", 0);
  sparse.index_component = parse_component(indices);
  const JsonValue values = value.get("values");
  sparse.value_view = values.get("bufferView").as_index(view_count, "bufferViews");
  sparse.value_offset = values.count("byteOffset", 0);
  return sparse;
}

GltfAccessor parse_accessor(const JsonValue& value, std::size_t view_count) {
  GltfAccessor accessor;
  accessor.view = value.index("bufferView", view_count, "bufferViews");
  accessor.offset = value.count("byteOffset", 0);
  accessor.count = value.get("count").as_count();
  accessor.component = parse_component(value);
  accessor.components = parse_component_count(value);
  accessor.normalized = value.flag("normalized");
  if (const auto sparse = value.find("sparse")) accessor.sparse = parse_sparse(*sparse, view_count);
  return accessor;
}

GltfBufferView parse_view(const JsonValue& value, std::size_t buffer_count) {
  GltfBufferView view;
  view.buffer = value.get("buffer").as_index(buffer_count, "buffers");
  view.offset = value.count("byteOffset", 0);
  view.length = value.get("byteLength").as_count();
  if (const auto stride = value.find("byteStride")) {
    const std::uint64_t bytes = stride->as_count();
    if (bytes < 4 || bytes > 252) stride->fail(fmt::format("{} is outside 4 to 252", bytes));
    view.stride = std::uint32_t(bytes);
  }
  return view;
}

void parse_buffers(const JsonValue& root, GltfDocument& document) {
  root.for_each("buffers", [&](const JsonValue& value) {
    GltfBuffer buffer{std::nullopt, value.get("byteLength").as_count()};
    if (const auto uri = value.find("uri")) buffer.uri = uri->as_string();
    document.buffers.push_back(std::move(buffer));
  });
  root.for_each("bufferViews", [&](const JsonValue& value) {
    document.views.push_back(parse_view(value, document.buffers.size()));
  });
  root.for_each("accessors", [&](const JsonValue& value) {
    document.accessors.push_back(parse_accessor(value, document.views.size()));
  });
}

Texture::Wrap parse_wrap(const JsonValue& sampler, const char* key) {
  switch (sampler.count(key, 10497)) {
    case 10497:
      return Texture::Wrap::repeat;
    case 33648:
      return Texture::Wrap::mirror;
    case 33071:
      return Texture::Wrap::clamp;
    default:
      sampler.get(key).fail("no wrap mode; use 10497, 33648 or 33071");
  }
}

void parse_textures(const JsonValue& root, GltfDocument& document) {
  root.for_each("images", [&](const JsonValue& value) {
    GltfImage image;
    image.name = value.string("name", fmt::format("image {}", document.images.size()));
    if (const auto uri = value.find("uri")) image.uri = uri->as_string();
    image.view = value.index("bufferView", document.views.size(), "bufferViews");
    if (!image.uri && !image.view) value.fail("an image needs \"uri\" or \"bufferView\"");
    document.images.push_back(std::move(image));
  });
  const std::size_t sampler_count = count_of(root, "samplers");
  root.for_each("textures", [&](const JsonValue& value) {
    GltfTexture texture;
    if (!value.find("source")) value.fail("the texture has no PNG or JPEG image (\"source\")");
    texture.image = value.get("source").as_index(document.images.size(), "images");
    if (const auto sampler = value.index("sampler", sampler_count, "samplers")) {
      const JsonValue found = root.get("samplers").at(*sampler);
      texture.wrap_u = parse_wrap(found, "wrapS");
      texture.wrap_v = parse_wrap(found, "wrapT");
    }
    document.textures.push_back(texture);
  });
  root.for_each("materials", [&](const JsonValue& value) {
    document.materials.push_back(
        parse_gltf_material(value, document.textures.size(), document.notes));
  });
}

// Modes 1, 2 and 3 are kinds of lines.
GltfMode parse_mode(const JsonValue& primitive) {
  switch (primitive.count("mode", 4)) {
    case 0:
      return GltfMode::points;
    case 1:
    case 2:
    case 3:
      return GltfMode::lines;
    case 4:
      return GltfMode::triangles;
    case 5:
      return GltfMode::triangle_strip;
    case 6:
      return GltfMode::triangle_fan;
    default:
      primitive.get("mode").fail("no primitive mode; use 0 to 6");
  }
}

GltfPrimitive parse_primitive(const JsonValue& value, const GltfDocument& document) {
  const std::size_t accessor_count = document.accessors.size();
  GltfPrimitive primitive;
  primitive.mode = parse_mode(value);
  const JsonValue attributes = value.get("attributes");
  primitive.position = attributes.get("POSITION").as_index(accessor_count, "accessors");
  primitive.normal = attributes.index("NORMAL", accessor_count, "accessors");
  while (const auto uv =
             attributes.index(fmt::format("TEXCOORD_{}", primitive.uv_sets.size()).c_str(),
                              accessor_count, "accessors")) {
    primitive.uv_sets.push_back(*uv);
  }
  primitive.radius = attributes.index("_ARRIS_RADIUS", accessor_count, "accessors");
  primitive.indices = value.index("indices", accessor_count, "accessors");
  primitive.material = value.index("material", document.materials.size(), "materials");
  return primitive;
}

void parse_meshes(const JsonValue& root, GltfDocument& document) {
  bool morphs = false, colors = false;
  root.for_each("meshes", [&](const JsonValue& value) {
    GltfMesh mesh;
    mesh.name = value.string("name", fmt::format("mesh {}", document.meshes.size()));
    mesh.rounding = parse_rounding_extra(value);
    if (count_of(value, "primitives") == 0) value.fail("the mesh has no \"primitives\"");
    value.for_each("primitives", [&](const JsonValue& primitive) {
      mesh.primitives.push_back(parse_primitive(primitive, document));
      morphs = morphs || primitive.find("targets");
      colors = colors || primitive.get("attributes").find("COLOR_0");
    });
    document.meshes.push_back(std::move(mesh));
  });
  if (morphs)
    document.notes.emplace_back("morph targets left out: meshes are in their basic shape");
  if (colors) document.notes.emplace_back("vertex colours left out");
}

}  // namespace

std::size_t count_of(const JsonValue& root, const char* array) {
  const std::optional<JsonValue> found = root.find(array);
  return found ? found->size() : 0;
}

std::optional<RoundingSettings> parse_rounding_extra(const JsonValue& owner) {
  const std::optional<JsonValue> extras = owner.find("extras");
  if (!extras || !extras->is_object()) return std::nullopt;
  const std::optional<JsonValue> radius = extras->find("arris_radius");
  if (!radius) return std::nullopt;
  const std::optional<RoundingSettings> settings =
      radius->is_string() ? parse_rounding_text(radius->as_string())
                          : make_rounding_settings(radius->as_number());
  if (!settings) radius->fail(fmt::format("not a rounding radius; {}", kRoundingTextForms));
  return settings;
}

GltfDocument parse_gltf_document(std::string_view json_text, const std::string& where) {
  const JsonFile file = parse_json_file(json_text, where);
  const JsonValue root(file);
  GltfDocument document;
  check_version(root);
  check_extensions(root, document.notes);
  parse_buffers(root, document);
  parse_textures(root, document);
  parse_meshes(root, document);
  parse_gltf_scene(root, document);
  return document;
}

}  // namespace arris
