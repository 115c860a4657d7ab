#include <fmt/format.h>

#include <algorithm>

#include "arris/error.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "io/mesh_scene.h"
#include "io/toml_scene_parts.h"
#include "io/toml_shape.h"
#include "scene/limits.h"
#include "scene/material_presets.h"
#include "scene/placement.h"

namespace arris {
namespace {

// Of all shapes of a scene file together: a short file must not fill the memory.
constexpr std::size_t kMaxShapeTriangles = std::size_t(1) << 24;

template <class Tag>
void shift(Id<Tag>& id, std::size_t by) {
  id.index += std::uint32_t(by);
}

void shift_textures(Material& material, std::size_t by) {
  for (std::optional<TextureId>* texture :
       {&material.base_color_texture, &material.metallic_roughness_texture,
        &material.emission_texture, &material.normal_texture, &material.transmission_texture,
        &material.clearcoat_texture, &material.clearcoat_roughness_texture}) {
    if (*texture) shift(**texture, by);
  }
}

template <class T>
void move_onto(SharedVector<T>& from, SharedVector<T>& to) {
  std::vector<T>& out = to.edit();
  out.insert(out.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

void TomlObjects::parse(const TomlValue& value, std::size_t number) {
  const auto* table = std::get_if<TomlTable>(&value.data);
  if (table == nullptr) {
    context_.problems.add(value.place,
                          fmt::format("object {}: must be a table, written [[object]]", number));
    return;
  }
  const auto name = std::ranges::find(*table, "name", &TomlMember::key);
  const auto* text = name == table->end() ? nullptr : std::get_if<std::string>(&name->value.data);
  TomlTableReader reader(
      *table, value.place,
      text != nullptr ? "object " + in_quotes(*text) : fmt::format("object {}", number),
      context_.problems);
  Placement placement = parse_placement(reader);
  placement.entry = std::uint32_t(number - 1);
  if (reader.has("file") == reader.has("shape")) {
    reader.report("file", "give either \"file\" or \"shape\"");
  } else if (reader.has("file")) {
    add_file(reader, placement);
  } else {
    add_shape(reader, placement);
  }
  if (reader.has("file") || reader.has("shape")) reader.report_unknown();
  if (!placement.track.keys.empty() && !placement.track.parts.empty()) {
    context_.scene.animation.objects.push_back(std::move(placement.track));
  }
}

// The placement goes last; its keys move all that is placed by it.
void TomlObjects::place(Object object, Placement& placement) {
  std::vector<Object>& objects = context_.scene.objects;
  placement.track.parts.push_back(
      {ObjectId{std::uint32_t(objects.size())}, object.world_from_object});
  object.world_from_object = placement.world_from_object * object.world_from_object;
  object.origin.entry = placement.entry;
  objects.push_back(std::move(object));
}

// Keys are parsed after the object's own translate, rotate and scale.
std::vector<ObjectKey> TomlObjects::parse_keys(TomlTableReader& reader, const ObjectKey& own) {
  std::vector<ObjectKey> keys;
  if (reader.has("key") && reader.has("matrix")) {
    reader.report("key",
                  "an object with \"matrix\" can't have keys; use translate, rotate and scale");
  }
  parse_toml_keys(reader, context_.problems, [&](TomlTableReader& key_reader, double frame) {
    ObjectKey key = parse_toml_motion(key_reader, own);
    key.frame = frame;
    report_if_flat(key_reader, make_placement({}, {}, key.scale).linear, "scale");
    keys.push_back(key);
  });
  return keys;
}

std::optional<MaterialId> TomlObjects::parse_material(TomlTableReader& reader) const {
  const std::optional<std::string> name = reader.string("material");
  if (!name) return std::nullopt;
  const std::optional<MaterialId> material = materials_.find(*name);
  if (!material) {
    reader.report("material", fmt::format("there is no [material.…] named {}{}", in_quotes(*name),
                                          did_you_mean(*name, materials_.names())));
  }
  return material;
}

std::optional<RoundingSettings> TomlObjects::parse_round(TomlTableReader& reader) const {
  const TomlMember* round = reader.find("round");
  if (round == nullptr) return std::nullopt;
  RoundingSettings defaults = context_.scene.rounding.value_or(RoundingSettings{});
  if (defaults.method == RoundMethod::none) defaults.method = RoundMethod::exact;
  return parse_toml_rounding(*round, defaults, context_.problems);
}

TomlObjects::Placement TomlObjects::parse_placement(TomlTableReader& reader) {
  Placement placement;
  placement.name = reader.string("name").value_or("");
  placement.material = parse_material(reader);
  ObjectKey own;
  placement.world_from_object = parse_toml_transform(reader, own);
  placement.track.keys = parse_keys(reader, own);
  placement.rounding = parse_round(reader);
  placement.auto_radius = reader.number("auto_radius", kTomlPositive);
  placement.hidden = reader.boolean("hidden").value_or(false);
  return placement;
}

bool TomlObjects::has_room(std::size_t objects, TomlTableReader& reader, const char* key) const {
  if (context_.scene.objects.size() + objects <= kMaxObjects) return true;
  reader.report(key, fmt::format("the scene has more than {} objects", kMaxObjects));
  return false;
}

void TomlObjects::add_shape(TomlTableReader& reader, Placement& placement) {
  std::optional<TomlShape> shape = parse_toml_shape(reader);
  if (!shape || !has_room(1, reader, "shape")) return;
  const auto [entry, is_new] =
      shapes_.try_emplace(shape->key, MeshId{std::uint32_t(context_.scene.meshes.size())});
  Object object;
  object.name = placement.name.empty() ? shape->mesh.name : placement.name;
  if (is_new) {
    shape_triangles_ += shape->mesh.triangles.size();
    if (shape_triangles_ > kMaxShapeTriangles) {
      reader.report("shape",
                    fmt::format("the scene's shapes have more than {} triangles; use fewer "
                                "segments or equal shapes",
                                kMaxShapeTriangles));
      shape->mesh = {};
    }
    context_.scene.meshes.push_back(std::move(shape->mesh));
  }
  object.mesh = entry->second;
  object.material = placement.material.value_or(MaterialId{0});
  object.rounding = placement.rounding;
  object.auto_radius = placement.auto_radius;
  if (!placement.hidden) place(std::move(object), placement);
}

void TomlObjects::add_file(TomlTableReader& reader, Placement& placement) {
  const std::optional<std::string> file = reader.string("file");
  if (!file) return;
  const Model* model = find_or_load(*file, reader);
  if (model == nullptr || !has_room(model->objects.size(), reader, "file")) return;
  const std::string prefix = placement.name.empty() ? model->stem : placement.name;
  const std::vector<PartEdit> edits = parse_parts(reader, *model);
  for (std::size_t i = 0; i < model->objects.size(); ++i) {
    const PartEdit edit = edits.empty() ? PartEdit{} : edits[i];
    if (placement.hidden || edit.hidden) continue;
    Object object = model->objects[i];
    object.origin.part = std::uint32_t(i);
    if (model->objects.size() > 1) {
      object.name = prefix + "/" + object.name;
    } else if (!placement.name.empty()) {
      object.name = placement.name;
    }
    if (const auto material = edit.material ? edit.material : placement.material) {
      give_material(object, *material);
    }
    if (placement.rounding) object.rounding = placement.rounding;
    if (edit.rounding) object.rounding = edit.rounding;
    object.auto_radius = edit.auto_radius ? edit.auto_radius : placement.auto_radius;
    if (edit.file_from_part) object.world_from_object = *edit.file_from_part;
    place(std::move(object), placement);
  }
}

void TomlObjects::give_material(Object& object, MaterialId material) {
  object.material = material;
  if (object.csg) {
    object.csg = with_material(*object.csg, material);
  } else {
    object.mesh = without_materials(object.mesh);
  }
}

const TomlObjects::Model* TomlObjects::find_or_load(const std::string& file,
                                                    TomlTableReader& reader) {
  const std::filesystem::path path = context_.resolve(file).lexically_normal();
  const auto [entry, is_new] = models_.try_emplace(path.string());
  std::optional<Model>& model = entry->second;
  if (is_new) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c; });
    if (extension == ".toml") {
      reader.report("file", "scene files can't hold other scene files; name a model file");
      return nullptr;
    }
    try {
      model = append(context_.load_model(path), path);
    } catch (const Error& error) {
      reader.report("file", error.what());
    }
  }
  return model ? &*model : nullptr;
}

// The model's parts become the scene's. Its lights, camera and environment stay behind.
TomlObjects::Model TomlObjects::append(Scene model, const std::filesystem::path& path) {
  Scene& scene = context_.scene;
  const std::size_t meshes = scene.meshes.size(), materials = scene.materials.size();
  for (Material& material : model.materials) {
    shift_textures(material, scene.textures.size());
    if (materials_.has_default() && is_unset(material)) material = scene.materials[0];
  }
  for (Mesh& mesh : model.meshes) {
    for (MaterialId& material : mesh.triangle_materials) shift(material, materials);
  }
  for (CsgTree& tree : model.csg_trees) {
    for (CsgLeaf& leaf : tree.leaves) shift(leaf.material, materials);
  }
  for (Object& object : model.objects) {
    if (object.csg) {
      shift(*object.csg, scene.csg_trees.size());
    } else {
      shift(object.mesh, meshes);
    }
    shift(object.material, materials);
    if (!object.rounding) object.rounding = model.rounding;
  }
  for (const std::string& note : model.notes) {
    scene.notes.push_back(path.filename().string() + ": " + note);
  }
  if (!model.lights.empty() || model.camera) {
    scene.notes.push_back(path.filename().string() + ": its lights and cameras are left out");
  }
  move_onto(model.meshes, scene.meshes);
  move_onto(model.csg_trees, scene.csg_trees);
  move_onto(model.materials, scene.materials);
  move_onto(model.textures, scene.textures);
  return {std::move(model.objects), name_from_file(path.string())};
}

// An object's own material goes before those of its primitives.
CsgId TomlObjects::with_material(CsgId id, MaterialId material) {
  Scene& scene = context_.scene;
  const auto [entry, is_new] = plain_trees_.try_emplace(
      std::pair(id.index, material.index), CsgId{std::uint32_t(scene.csg_trees.size())});
  if (is_new) {
    CsgTree copy = scene.csg_trees[id.index];
    for (CsgLeaf& leaf : copy.leaves) leaf.material = material;
    scene.csg_trees.push_back(std::move(copy));
  }
  return entry->second;
}

// An object's own material goes before those of its triangles: it needs a mesh without them.
MeshId TomlObjects::without_materials(MeshId id) {
  Scene& scene = context_.scene;
  if (scene.meshes[id.index].triangle_materials.empty()) return id;
  const auto [entry, is_new] =
      plain_.try_emplace(id.index, MeshId{std::uint32_t(scene.meshes.size())});
  if (is_new) {
    Mesh copy = scene.meshes[id.index];
    copy.triangle_materials.clear();
    scene.meshes.push_back(std::move(copy));
  }
  return entry->second;
}

}  // namespace arris
