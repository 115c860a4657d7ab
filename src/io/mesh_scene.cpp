#include "io/mesh_scene.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/utf8_text.h"

namespace arris {
namespace {

// A tab may part the names of several groups.
bool has_control_character(std::string_view name) {
  return std::any_of(name.begin(), name.end(),
                     [](char c) { return (std::uint8_t(c) < 0x20 && c != '\t') || c == 0x7F; });
}

}  // namespace

Scene make_mesh_scene(const std::string& file) {
  Scene scene;
  scene.name = name_from_file(file);
  scene.materials.emplace_back().name = "default";
  return scene;
}

std::string name_from_file(const std::string& file) {
  std::string name = std::filesystem::path(file).stem().string();
  return name.empty() || !problem_with_name(name).empty() ? "model" : name;
}

std::string problem_with_name(std::string_view name) {
  if (name.size() > kMaxNameBytes) {
    return "the name " + in_quotes(name) + " has " + std::to_string(name.size()) +
           " bytes; use at most " + std::to_string(kMaxNameBytes);
  }
  if (!is_utf8(name)) {
    return "the name " + in_quotes(name) +
           " is not UTF-8 text; save the file as UTF-8 or rename it";
  }
  if (has_control_character(name)) {
    return "the name " + in_quotes(name) + " holds a control character; rename it";
  }
  return "";
}

void add_object(Scene& scene, Mesh mesh) {
  Object& object = scene.objects.emplace_back();
  object.name = mesh.name;
  object.mesh.index = std::uint32_t(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
}

}  // namespace arris
