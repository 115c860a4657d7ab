#include "view/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/scene_writer.h"
#include "io/toml_document.h"
#include "io/toml_writer.h"
#include "scene/material_presets.h"

namespace arris::view {
namespace {

namespace fs = std::filesystem;

// Names of files, which hold wherever the scene file is saved, if they can.
class FileNames {
 public:
  explicit FileNames(const ViewModel& model) : model_(model) {}

  // Of the model itself.
  std::string own() {
    if (!model_.file.empty()) return name_of(model_.file, model_.file.filename().string());
    if (!is_utf8(model_.name)) refuse(model_.name);
    is_relative_ = true;
    return model_.name;
  }

  // Of a name in the model's scene file.
  std::string operator()(const std::string& name) {
    return name_of(model_.file.parent_path() / fs::path(name), name);
  }

  [[nodiscard]] bool is_relative() const { return is_relative_; }

 private:
  // Folders may be links, and "..", which is taken away when the file is read, would then lead elsewhere.
  std::string name_of(const fs::path& path, const std::string& relative) {
    std::error_code error;
    const fs::path folder = fs::canonical(path.parent_path(), error);
    const std::string whole = (error ? fs::absolute(path) : folder / path.filename()).string();
    if (is_utf8(whole)) return whole;
    if (!is_utf8(relative)) refuse(relative);
    is_relative_ = true;
    return relative;
  }

  [[noreturn]] static void refuse(const std::string& name) {
    throw Error(Error::Kind::input, in_quotes(name),
                "this name is not UTF-8 text, and a scene file can hold no other; rename the file");
  }

  const ViewModel& model_;
  bool is_relative_ = false;
};

// The objects that an [[object]] has made, by their numbers in the model and in the [[object]]'s file.
struct Entry {
  struct Part {
    std::size_t index = 0;
    std::uint32_t number = 0;
  };
  std::vector<Part> parts;
};

std::map<std::uint32_t, Entry> find_entries(const ViewModel& model) {
  std::map<std::uint32_t, Entry> entries;
  for (std::size_t i = 0; i < model.scene.objects.size(); ++i) {
    const ObjectOrigin origin =
        model.is_scene_file ? model.scene.objects[i].origin : ObjectOrigin{0, std::uint32_t(i)};
    entries[origin.entry].parts.push_back({i, origin.part});
  }
  return entries;
}

// Brings one [[object]] to what the view has of its parts.
class EntryWriter {
 public:
  EntryWriter(const ViewModel& model, const ViewEdits& edits, const Entry& entry, TomlTable& table)
      : model_(model), edits_(edits), entry_(entry), table_(table) {}

  void write() {
    if (TomlValue* parts = find_toml(table_, "part")) own_parts_ = std::get<TomlArray>(parts->data);
    erase_toml(table_, {"part"});
    write_visible();
    write_rounding();
    write_auto_radius();
    if (std::ranges::any_of(entry_.parts, [&](auto part) { return is_moved(part); })) {
      write_places();
    }
    for (auto& [number, part] : new_parts_) {
      part.insert(part.begin(), TomlMember{"number", {}, {{}, std::int64_t(number) + 1}});
      own_parts_.push_back({{}, std::move(part)});
    }
    if (!own_parts_.empty()) set_toml(table_, "part", std::move(own_parts_));
  }

 private:
  [[nodiscard]] const ObjectEdit& edit_of(Entry::Part part) const {
    return edits_.objects[part.index];
  }
  [[nodiscard]] bool is_shape() const {
    return std::ranges::find(table_, "shape", &TomlMember::key) != table_.end();
  }
  [[nodiscard]] bool is_moved(Entry::Part part) const {
    return !(model_.scene.objects[part.index].world_from_object == edit_of(part).world_from_object);
  }

  void write_visible() {
    const auto is_hidden = [&](Entry::Part part) { return !edit_of(part).visible; };
    if (std::ranges::all_of(entry_.parts, is_hidden)) return set_toml(table_, "hidden", true);
    for (const Entry::Part part : entry_.parts) {
      if (is_hidden(part)) set_toml(new_parts_[part.number], "hidden", true);
    }
  }

  // What the file says of rounding counts no more where the view has taken it away.
  [[nodiscard]] std::optional<RoundingSettings> rounding_of(Entry::Part part) const {
    if (edit_of(part).rounding) return edit_of(part).rounding;
    const bool file_says = model_.scene.objects[part.index].rounding.has_value() ||
                           (!model_.is_scene_file && model_.has_own_rounding);
    return file_says ? std::optional(edits_.rounding) : std::nullopt;
  }

  // In full, because what it leaves out would come from the view's [round].
  void write_rounding() {
    erase_toml(table_, {"round"});
    erase_of_own_parts({"round"});
    const std::optional<RoundingSettings> first = rounding_of(entry_.parts.front());
    const bool is_common = std::ranges::all_of(
        entry_.parts, [&](Entry::Part part) { return rounding_of(part) == first; });
    if (is_common) {
      if (first) set_toml(table_, "round", make_rounding_table(*first));
      return;
    }
    for (const Entry::Part part : entry_.parts) {
      if (const auto rounding = rounding_of(part)) {
        set_toml(new_parts_[part.number], "round", make_rounding_table(*rounding));
      }
    }
  }

  // What "auto" comes to in the view, and does whatever camera and size the file is rendered with.
  [[nodiscard]] std::optional<double> auto_radius_of(Entry::Part part) const {
    const RoundingSettings& settings = edit_of(part).rounding.value_or(edits_.rounding);
    const bool is_auto = std::holds_alternative<AutoRadius>(settings.radius);
    return is_auto ? edit_of(part).auto_radius : std::nullopt;
  }

  void write_auto_radius() {
    erase_toml(table_, {"auto_radius"});
    erase_of_own_parts({"auto_radius"});
    const std::optional<double> first = auto_radius_of(entry_.parts.front());
    const bool is_common = std::ranges::all_of(
        entry_.parts, [&](Entry::Part part) { return auto_radius_of(part) == first; });
    if (is_common) {
      if (first) set_toml(table_, "auto_radius", *first);
      return;
    }
    for (const Entry::Part part : entry_.parts) {
      if (const auto radius = auto_radius_of(part)) {
        set_toml(new_parts_[part.number], "auto_radius", *radius);
      }
    }
  }

  // All parts by their places in the world, which are then exact.
  void write_places() {
    erase_toml(table_, {"translate", "rotate", "scale", "matrix", "key"});
    erase_of_own_parts({"translate", "rotate", "scale", "matrix"});
    if (is_shape() || is_sole_part_at_origin()) {
      set_toml(table_, "matrix", rows_of(entry_.parts.front()));
      return;
    }
    for (const Entry::Part part : entry_.parts) {
      set_toml(new_parts_[part.number], "matrix", rows_of(part));
    }
  }

  [[nodiscard]] TomlArray rows_of(Entry::Part part) const {
    return make_matrix_rows(edit_of(part).world_from_object);
  }
  // Of a scene file it is not known where the part lies in its own file.
  [[nodiscard]] bool is_sole_part_at_origin() const {
    return !model_.is_scene_file && entry_.parts.size() == 1 &&
           model_.scene.objects[0].world_from_object == Affine3d{};
  }

  void erase_of_own_parts(std::initializer_list<std::string_view> keys) {
    for (TomlValue& part : own_parts_) erase_toml(std::get<TomlTable>(part.data), keys);
  }

  const ViewModel& model_;
  const ViewEdits& edits_;
  const Entry& entry_;
  TomlTable& table_;
  TomlArray own_parts_;  // of the scene file: materials and what is hidden stay
  std::map<std::uint32_t, TomlTable> new_parts_;
};

TomlArray& objects_of(TomlTable& file) {
  return std::get<TomlArray>(find_toml(file, "object")->data);
}

// It may have been written anew between its loading and the reading of its text.
TomlTable parse_model_text(const ViewModel& model) {
  TomlTable file = parse_toml(model.text, model.name);
  const TomlValue* objects = find_toml(file, "object");
  const auto* array = objects == nullptr ? nullptr : std::get_if<TomlArray>(&objects->data);
  const std::uint32_t last = model.scene.objects.back().origin.entry;
  if (array == nullptr || array->size() <= last) {
    throw Error(Error::Kind::input, model.name,
                "has changed while it was opened, so that it can't be saved; open it again");
  }
  return file;
}

void write_objects(const ViewModel& model, const ViewEdits& edits, TomlTable& file) {
  TomlArray& objects = objects_of(file);
  for (const auto& [number, entry] : find_entries(model)) {
    auto& table = std::get<TomlTable>(objects.at(number).data);
    EntryWriter(model, edits, entry, table).write();
  }
}

// One material for all, or what staging has given to parts without one.
void write_material(const ViewModel& model, const ViewEdits& edits, TomlTable& file) {
  constexpr const char* kStagedMaterial = "plastic-grey";  // render/staging.h
  if (edits.material) {
    TomlTable materials;
    set_toml(materials, *edits.material,
             make_material_table(*find_material_preset(*edits.material)));
    set_toml(file, "material", std::move(materials));
    for (TomlValue& object : objects_of(file)) {
      auto& table = std::get<TomlTable>(object.data);
      set_toml(table, "material", *edits.material);
      TomlValue* parts = find_toml(table, "part");
      if (parts == nullptr) continue;
      for (TomlValue& part : std::get<TomlArray>(parts->data)) {
        erase_toml(std::get<TomlTable>(part.data), {"material"});
      }
    }
  } else if (!model.is_scene_file && std::ranges::any_of(model.scene.materials, is_unset)) {
    TomlTable materials;
    set_toml(materials, "default", make_material_table(*find_material_preset(kStagedMaterial)));
    set_toml(file, "material", std::move(materials));
  }
}

void rename(TomlTable& table, std::string_view key, FileNames& names) {
  TomlValue* value = find_toml(table, key);
  if (value == nullptr) return;
  if (auto* name = std::get_if<std::string>(&value->data)) *name = names(*name);
  if (auto* inner = std::get_if<TomlTable>(&value->data)) rename(*inner, "file", names);
}

// Models and textures.
void rename_files(TomlTable& file, FileNames& names) {
  for (TomlValue& object : objects_of(file)) {
    rename(std::get<TomlTable>(object.data), "file", names);
  }
  TomlValue* materials = find_toml(file, "material");
  if (materials == nullptr) return;
  for (TomlMember& material : std::get<TomlTable>(materials->data)) {
    auto& table = std::get<TomlTable>(material.value.data);
    for (const TomlMember& member : TomlTable(table)) {
      if (member.key.ends_with("_texture")) rename(table, member.key, names);
    }
  }
}

bool has_keys(const TomlValue& object) {
  return std::ranges::find(std::get<TomlTable>(object.data), "key", &TomlMember::key) !=
         std::get<TomlTable>(object.data).end();
}

TomlTable make_model_table(FileNames& names) {
  TomlTable object, file;
  set_toml(object, "file", names.own());
  set_toml(file, "object", TomlArray{{{}, std::move(object)}});
  return file;
}

// What scene files can't say is said by the command.
std::vector<std::string> make_comments(const ViewModel& model, const ViewEdits& edits,
                                       const FileNames& names, const std::string& file_name) {
  std::vector<std::string> comments{"A view of " + model.name + ", saved by arris view."};
  if (edits.shader == EdgePointShader::glossy) {
    comments.push_back("Its shading is glossy: arris view " + file_name + " --shader glossy");
    comments.push_back("arris render " + file_name +
                       " --integrator edge-point --shader glossy -o picture.png");
  } else {
    comments.push_back("arris render " + file_name + " -o picture.png");
  }
  if (const int depth = model.scene.image.max_depth;
      path_depth(model.scene.image, edits.shader) < depth) {
    comments.push_back(fmt::format(
        "Its shading is direct light only: max_depth is 1. It was {}, for light between surfaces.",
        depth));
  }
  if (names.is_relative()) {
    comments.push_back(model.is_scene_file
                           ? "Save it beside " + model.name + ", whose files it names."
                           : "Save it beside " + model.name + ", which it shows.");
  }
  return comments;
}

void check_model(const ViewModel& model, const ViewEdits& edits) {
  if (model.file.empty() && (model.is_scene_file || !fs::path(model.name).has_extension())) {
    throw Error(Error::Kind::input, model.name,
                "came through a pipe, so that a scene file can't name it; open it as a file");
  }
  if (std::ranges::none_of(edits.objects, &ObjectEdit::visible)) {
    throw Error(Error::Kind::input, "",
                "all objects are hidden, and a scene file needs one to show; show one");
  }
}

}  // namespace

std::string make_scene_file(const ViewModel& model, const ViewEdits& edits,
                            const std::string& file_name) {
  check_model(model, edits);
  FileNames names(model);
  TomlTable file;
  if (model.is_scene_file) {
    file = parse_model_text(model);
    if (edits.material) erase_toml(file, {"material"});
    rename_files(file, names);
  } else {
    file = make_model_table(names);
  }
  write_objects(model, edits, file);
  write_material(model, edits, file);
  Scene staged = stage_view(model, edits).scene;
  if (staged.environment) {
    if (auto* map = std::get_if<HdrEnvironment>(&*staged.environment)) map->name = names(map->name);
  }
  staged.image.max_depth = path_depth(staged.image, edits.shader);
  TomlTable out = make_scene_table(staged);
  for (const char* key : {"animation", "material", "object"}) {
    TomlValue* own = find_toml(file, key);
    const bool moves = std::ranges::any_of(objects_of(file), has_keys);
    if (own != nullptr && (moves || key != std::string_view("animation"))) {
      set_toml(out, key, own->data);
    }
  }
  return write_scene_file(out, make_comments(model, edits, names, file_name));
}

}  // namespace arris::view
