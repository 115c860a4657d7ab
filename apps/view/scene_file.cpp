#include "view/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "io/file_bytes.h"
#include "io/scene_writer.h"
#include "scene/material_presets.h"

namespace arris::view {
namespace {

constexpr std::uint64_t kMostSceneFileBytes = std::uint64_t(16) << 20;
constexpr std::string_view kStagedMaterial = "plastic-grey";  // render/staging.h

// One value for all objects, if they agree.
template <class Get>
auto common_of(const ViewModel& model, const ViewEdits& edits, const Get& get)
    -> std::optional<decltype(get(model.scene.objects[0], edits.objects[0]))> {
  std::optional<decltype(get(model.scene.objects[0], edits.objects[0]))> common;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    auto value = get(model.scene.objects[i], edits.objects[i]);
    if (common && !(*common == value)) return std::nullopt;
    common = std::move(value);
  }
  return common;
}

bool is_moved(const Object& object, const ObjectEdit& edit) {
  return !(object.world_from_object == edit.world_from_object);
}

// How all objects of the file were moved together.
std::optional<Affine3d> common_move(const ViewModel& model, const ViewEdits& edits) {
  const auto moved = common_of(model, edits, is_moved);
  if (moved && !*moved) return Affine3d{};
  if (edits.objects.size() != 1) return std::nullopt;
  return edits.objects[0].world_from_object * inverse(model.scene.objects[0].world_from_object);
}

std::optional<RoundingSettings> explicit_rounding(const ViewEdits& edits, const Object& object,
                                                  const ObjectEdit& edit) {
  if (edit.rounding) return edit.rounding;
  // The file has one of its own, which does not count any more.
  if (object.rounding) return edits.rounding;
  return std::nullopt;
}

std::string names_of(const ViewModel& model, const ViewEdits& edits,
                     bool (*is_meant)(const Object&, const ObjectEdit&)) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    if (is_meant(model.scene.objects[i], edits.objects[i])) {
      names.push_back(model.scene.objects[i].name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void add_comment_of(std::vector<std::string>& comments, const char* what, const ViewModel& model,
                    const ViewEdits& edits, bool (*is_meant)(const Object&, const ObjectEdit&)) {
  const std::string names = names_of(model, edits, is_meant);
  if (!names.empty()) comments.push_back(fmt::format("not in this file: {}: {}", what, names));
}

std::vector<std::string> first_comments(const ViewModel& model, const ViewEdits& edits) {
  std::vector<std::string> comments{"A view of " + model.name + ", saved by arris view.",
                                    "arris render scene.toml -o picture.png"};
  // Its soft rim is a texture, which this file can't hold.
  if (edits.ground) comments.back() += " --ground on";
  return comments;
}

void add_hidden(std::vector<std::string>& comments, const ViewModel& model,
                const ViewEdits& edits) {
  add_comment_of(comments, "these parts were hidden", model, edits,
                 [](const Object&, const ObjectEdit& edit) { return !edit.visible; });
}

std::string write_model(const ViewModel& model, const ViewEdits& edits, const Scene& staged) {
  std::vector<std::string> comments = first_comments(model, edits);
  WrittenObject object;
  object.file = model.name;
  if (model.file.empty()) {
    comments.push_back("Save it beside " + model.name + ", which it shows.");
  } else {
    object.file = std::filesystem::absolute(model.file).lexically_normal().string();
  }
  if (const auto move = common_move(model, edits)) {
    object.world_from_file = *move;
  } else {
    add_comment_of(comments, "these parts were moved", model, edits, is_moved);
  }
  const auto rounding = common_of(model, edits, [&](const Object& o, const ObjectEdit& edit) {
    return explicit_rounding(edits, o, edit);
  });
  if (rounding) {
    object.rounding = *rounding;
  } else {
    add_comment_of(comments, "these parts have a radius of their own", model, edits,
                   [](const Object&, const ObjectEdit& edit) { return edit.rounding.has_value(); });
  }
  add_hidden(comments, model, edits);
  // Staging has given the file's own materials to what has some.
  const auto is_staged = [](const Material& m) { return m.name == kStagedMaterial; };
  const std::size_t own = model.scene.materials.size();
  const auto first = staged.materials.begin(), last = first + std::ptrdiff_t(own);
  if (edits.material) {
    object.material = find_material_preset(*edits.material);
  } else if (std::all_of(first, last, is_staged)) {
    object.material = find_material_preset(kStagedMaterial);
  } else if (std::any_of(first, last, is_staged)) {
    comments.push_back("not in this file: parts without a material of their own were " +
                       std::string(kStagedMaterial));
  }
  return write_toml_scene(staged, {&object, 1}, comments);
}

// Whether a line of a scene file begins a part that the view has its own of. Headers only.
bool is_replaced(std::string_view name) {
  constexpr std::array<std::string_view, 8> kParts{
      "image", "camera", "camera.key", "environment", "light", "light.key", "round", "animation"};
  return std::ranges::find(kParts, name) != kParts.end();
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r[]");
  if (first == std::string_view::npos) return "";
  const std::size_t last = text.find_last_not_of(" \t\r[]");
  return std::string(text.substr(first, last - first + 1));
}

// The file's own lines without those parts, whether they are tables or keys at the top.
std::string kept_lines(std::string_view file) {
  std::string out;
  std::istringstream lines{std::string(file)};
  bool in_table = false, dropped = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t");
    const bool is_header = first != std::string::npos && line[first] == '[';
    if (is_header) {
      in_table = true;
      dropped = is_replaced(trimmed(std::string_view(line).substr(0, line.find('#'))));
    } else if (!in_table) {
      dropped = is_replaced(trimmed(std::string_view(line).substr(0, line.find('=')))) ||
                trimmed(std::string_view(line).substr(0, line.find('='))) == "up";
    }
    if (!dropped) out += line + "\n";
  }
  return out;
}

// Objects and materials stay as the scene file has them, all else is the view's.
std::string write_changed_scene(const ViewModel& model, const ViewEdits& edits,
                                const Scene& staged) {
  std::vector<std::string> comments = first_comments(model, edits);
  comments.push_back("Save it beside " + model.name + ", whose files it names.");
  add_comment_of(comments, "these objects were moved", model, edits, is_moved);
  add_hidden(comments, model, edits);
  add_comment_of(comments, "these objects got a radius of their own", model, edits,
                 [](const Object&, const ObjectEdit& edit) { return edit.has_edited_radius; });
  if (edits.material) comments.push_back("not in this file: all was " + *edits.material);
  const std::vector<std::uint8_t> bytes = read_file_bytes(model.file, kMostSceneFileBytes);
  const std::string own = kept_lines({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  // Keys at the top of the file come before all tables.
  const std::size_t first_table = own.find("\n[");
  const bool has_top = !own.starts_with("[") && first_table != std::string::npos;
  const std::string top = has_top ? own.substr(0, first_table + 1) : "";
  std::string text = write_toml_scene(staged, {}, comments);
  const std::size_t tables = text.find("\n[");
  text.insert(tables + 1, top);
  return text + "\n" + own.substr(top.size());
}

}  // namespace

std::string make_scene_file(const ViewModel& model, const ViewEdits& edits) {
  const Scene staged = stage_view(model, edits).scene;
  if (!model.is_scene_file) return write_model(model, edits, staged);
  if (!model.file.empty()) return write_changed_scene(model, edits, staged);
  throw Error(Error::Kind::input, model.name,
              "came through a pipe, so that its objects' files are not known; open it as a file");
}

}  // namespace arris::view
