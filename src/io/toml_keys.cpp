// toml_keys.cpp — the camera, and keys of all kinds
#include <fmt/format.h>

#include "io/toml_scene_parts.h"
#include "scene/limits.h"

namespace arris {
namespace {

// What `own` has, where the table says nothing else.
Camera parse_view(TomlTableReader& reader, const Camera& own, TomlProblems& problems) {
  const std::size_t before = problems.count();
  Camera camera;
  camera.position = reader.vec3("position", kTomlCoordinate).value_or(own.position);
  camera.target = reader.vec3("target", kTomlCoordinate).value_or(own.target);
  camera.up = reader.direction("up").value_or(own.up);
  camera.fov_deg = reader.number("fov", {kMinFovDeg, kMaxFovDeg}).value_or(own.fov_deg);
  const Vec3d view = camera.target - camera.position;
  if (problems.count() > before) return camera;
  if (!(length_squared(view) > 0)) {
    reader.report("position", "is the target; move one of them");
  } else if (!(length(cross(normalize(view), normalize(camera.up))) > 1e-9)) {
    reader.report("up", "is along the view; choose another");
  }
  return camera;
}

}  // namespace

const TomlArray& toml_elements_of(const TomlMember& member, TomlProblems& problems) {
  static const TomlArray kNone;
  if (const auto* array = std::get_if<TomlArray>(&member.value.data)) return *array;
  problems.add(member.place, fmt::format("{}: must be an array of tables, written [[{}]]",
                                         member.key, member.key));
  return kNone;
}

void parse_toml_keys(TomlTableReader& owner, TomlProblems& problems,
                     const std::function<void(TomlTableReader& key, double frame)>& visit) {
  const TomlMember* member = owner.find("key");
  if (member == nullptr) return;
  std::optional<double> last;
  std::size_t number = 0;
  for (const TomlValue& value : toml_elements_of(*member, problems)) {
    const std::string title = fmt::format("{} key {}", owner.title(), ++number);
    const auto* table = std::get_if<TomlTable>(&value.data);
    if (table == nullptr) {
      problems.add(value.place, title + ": must be a table with a frame");
      continue;
    }
    TomlTableReader reader(*table, value.place, title, problems);
    if (!reader.has("frame")) reader.report_missing("frame");
    const auto frame = reader.number("frame", {-kMaxFrame, kMaxFrame});
    if (frame && last && !(*frame - *last >= kLeastKeyDistance)) {
      reader.report("frame", fmt::format("is {}, after {}; use at least {} more for the next key",
                                         *frame, *last, kLeastKeyDistance));
    }
    if (frame) last = frame;
    visit(reader, frame.value_or(0));
    reader.report_unknown();
  }
}

std::optional<Camera> parse_toml_camera(const TomlMember& member, Vec3d up, Animation& animation,
                                        TomlProblems& problems) {
  const TomlTable* table = as_toml_table(member, problems);
  if (table == nullptr) return std::nullopt;
  TomlTableReader reader(*table, member.value.place, "[camera]", problems);
  if (!reader.has("position")) reader.report_missing("position");
  Camera camera;
  camera.up = up;
  // Anywhere but at the target, if it is missing.
  if (!reader.has("position")) camera.position = {1, 2, 3};
  camera = parse_view(reader, camera, problems);
  parse_toml_keys(reader, problems, [&](TomlTableReader& key_reader, double frame) {
    animation.camera.push_back({frame, parse_view(key_reader, camera, problems)});
  });
  reader.report_unknown();
  return camera;
}

}  // namespace arris
