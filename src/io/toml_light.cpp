#include <fmt/format.h>

#include <array>
#include <cmath>

#include "arris/error.h"
#include "arris/io.h"
#include "io/toml_scene_parts.h"
#include "scene/placement.h"

namespace arris {
namespace {

enum class LightKind { point, spot, directional, area };
constexpr std::array<TomlWord<LightKind>, 4> kLightKinds = {
    {{"point", LightKind::point},
     {"spot", LightKind::spot},
     {"directional", LightKind::directional},
     {"area", LightKind::area}}};

enum class EnvironmentKind { constant, sky, hdr, studio };
constexpr std::array<TomlWord<EnvironmentKind>, 4> kEnvironmentKinds = {
    {{"constant", EnvironmentKind::constant},
     {"sky", EnvironmentKind::sky},
     {"hdr", EnvironmentKind::hdr},
     {"studio", EnvironmentKind::studio}}};

constexpr TomlRange kStrength{0, 1e12};

// A light as a file describes it; keys describe it anew.
struct LightForm {
  LightKind kind = LightKind::point;
  LightKey own;  // what a key that leaves it out has
  LightTrack::Aim aim = LightTrack::Aim::direction;

  [[nodiscard]] bool has_position() const { return kind != LightKind::directional; }
  [[nodiscard]] bool has_aim() const { return kind != LightKind::point; }
  [[nodiscard]] const char* strength_name() const {
    return kind == LightKind::directional ? "irradiance"
           : kind == LightKind::area      ? "radiance"
                                          : "intensity";
  }
};

// color times the number under `key`.
Rgb parse_emission(TomlTableReader& reader, const char* key) {
  const Vec3d color = reader.vec3("color", kTomlNotNegative).value_or(Vec3d(1.0));
  return Rgb(color * reader.number(key, kStrength).value_or(1));
}

Vec2d parse_size(TomlTableReader& reader, Vec2d own) {
  const TomlMember* member = reader.find("size");
  if (member == nullptr) return own;
  if (std::holds_alternative<TomlArray>(member->value.data)) {
    return reader.vec2("size", kTomlPositive).value_or(own);
  }
  const auto side = reader.number("size", kTomlPositive);
  return side ? Vec2d{*side, *side} : own;
}

// Of the light itself and of its keys; what is missing is that of `form.own`.
LightKey parse_look(TomlTableReader& reader, const LightForm& form, TomlProblems& problems) {
  const std::size_t before = problems.count();
  LightKey key = form.own;
  if (form.has_position()) {
    key.position = reader.vec3("position", kTomlCoordinate).value_or(key.position);
  }
  if (form.has_aim()) {
    key.aim = (form.aim == LightTrack::Aim::target ? reader.vec3("target", kTomlCoordinate)
                                                   : reader.direction("direction"))
                  .value_or(key.aim);
    if (form.aim == LightTrack::Aim::target && key.aim == key.position &&
        problems.count() == before) {
      reader.report("target", "is the light's own position");
    }
  }
  if (form.kind == LightKind::area) key.size = parse_size(reader, key.size);
  key.color = reader.vec3("color", kTomlNotNegative).value_or(key.color);
  key.strength = reader.number(form.strength_name(), kStrength).value_or(key.strength);
  return key;
}

// By "direction", or towards "target": one of them is required.
LightTrack::Aim parse_aim(TomlTableReader& reader, LightKind kind) {
  if (kind == LightKind::directional) {
    if (!reader.has("direction")) reader.report_missing("direction");
  } else if (reader.has("target") == reader.has("direction")) {
    reader.report("direction", "give either \"direction\" or \"target\"");
    if (reader.has("target")) reader.direction("direction");
  }
  return reader.has("target") && kind != LightKind::directional ? LightTrack::Aim::target
                                                                : LightTrack::Aim::direction;
}

LightForm parse_form(TomlTableReader& reader, LightKind kind, TomlProblems& problems) {
  LightForm form;
  form.kind = kind;
  form.own.aim = {0, 0, -1};
  if (form.has_position() && !reader.has("position")) reader.report_missing("position");
  if (form.has_aim()) form.aim = parse_aim(reader, kind);
  form.own = parse_look(reader, form, problems);
  return form;
}

SpotLight parse_spot_angles(TomlTableReader& reader) {
  SpotLight light;
  const double outer = reader.number("outer_angle", {0, 180, true}).value_or(45);
  const double inner = reader.number("inner_angle", {0, 180}).value_or(0);
  if (inner > outer) {
    reader.report("inner_angle", fmt::format("is {}; use at most outer_angle, {}", inner, outer));
  }
  light.outer_angle = radians(outer);
  light.inner_angle = radians(inner);
  return light;
}

// By its corner and edges, which no key moves.
AreaLight parse_cornered_area(TomlTableReader& reader) {
  AreaLight light;
  light.corner = reader.vec3("corner", kTomlCoordinate).value_or(light.corner);
  if (!reader.has("edge_u")) reader.report_missing("edge_u");
  if (!reader.has("edge_v")) reader.report_missing("edge_v");
  light.edge_u = reader.direction("edge_u").value_or(light.edge_u);
  light.edge_v = reader.direction("edge_v").value_or(light.edge_v);
  if (!(length_squared(cross(light.edge_u, light.edge_v)) > 0)) {
    reader.report("edge_v", "spans no area with edge_u");
  }
  light.radiance = parse_emission(reader, "radiance");
  light.visible_to_camera = reader.boolean("visible").value_or(true);
  if (reader.has("key")) {
    reader.report("key", "a light with \"corner\" can't have keys; use position, target and size");
  }
  return light;
}

// What keys don't change: kind, angles, visibility.
Light parse_fixed_part(TomlTableReader& reader, LightKind kind) {
  switch (kind) {
    case LightKind::point:
      return PointLight{};
    case LightKind::spot:
      return parse_spot_angles(reader);
    case LightKind::directional:
      return DirectionalLight{};
    case LightKind::area:
      break;
  }
  AreaLight light;
  light.visible_to_camera = reader.boolean("visible").value_or(true);
  return light;
}

void parse_described_light(TomlTableReader& reader, LightKind kind,
                           const TomlSceneContext& context) {
  Scene& scene = context.scene;
  const LightForm form = parse_form(reader, kind, context.problems);
  LightTrack track;
  track.light = scene.lights.size();
  track.aim = form.aim;
  track.up = scene.up;
  if (kind == LightKind::area) track.up = reader.direction("up").value_or(track.up);
  Light light = parse_fixed_part(reader, kind);
  move_light(light, track, form.own);
  scene.lights.push_back(light);
  parse_toml_keys(reader, context.problems, [&](TomlTableReader& key_reader, double frame) {
    track.keys.push_back(parse_look(key_reader, form, context.problems));
    track.keys.back().frame = frame;
  });
  if (!track.keys.empty()) scene.animation.lights.push_back(std::move(track));
}

// -------------------------------------------------------------------------------- environments

SkyEnvironment parse_sky(TomlTableReader& reader, Vec3d up) {
  SkyEnvironment sky;
  sky.up = up;
  sky.sun_direction = reader.direction("sun_direction").value_or(sky.sun_direction);
  sky.turbidity = reader.number("turbidity", {1.7, 20}).value_or(sky.turbidity);
  sky.strength = reader.number("strength", kStrength).value_or(1);
  sky.sun = reader.boolean("sun").value_or(true);
  return sky;
}

std::optional<HdrEnvironment> parse_hdr(TomlTableReader& reader, const TomlSceneContext& context) {
  HdrEnvironment hdr;
  hdr.up = context.scene.up;
  hdr.strength = reader.number("strength", kStrength).value_or(1);
  hdr.rotation = radians(reader.number("rotation", {-360, 360}).value_or(0));
  if (!reader.has("file")) reader.report_missing("file");
  const std::optional<std::string> file = reader.string("file");
  if (!file) return std::nullopt;
  try {
    const Image image = load_picture(context.resolve(*file)).color;
    hdr.name = *file;
    hdr.width_px = image.width_px;
    hdr.height_px = image.height_px;
    const int green = image.channels < 3 ? 0 : 1, blue = image.channels < 3 ? 0 : 2;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        hdr.radiance.emplace_back(image.at(x, y, 0), image.at(x, y, green), image.at(x, y, blue));
      }
    }
  } catch (const Error& error) {
    reader.report("file", error.what());
    return std::nullopt;
  }
  return hdr;
}

std::optional<Environment> parse_environment_of(EnvironmentKind kind, TomlTableReader& reader,
                                                const TomlSceneContext& context) {
  switch (kind) {
    case EnvironmentKind::constant:
      return ConstantEnvironment{parse_emission(reader, "strength")};
    case EnvironmentKind::sky:
      return parse_sky(reader, context.scene.up);
    case EnvironmentKind::hdr:
      return parse_hdr(reader, context);
    case EnvironmentKind::studio:
      break;
  }
  StudioEnvironment studio;
  studio.up = context.scene.up;
  studio.strength = reader.number("strength", kStrength).value_or(1);
  studio.rotation = radians(reader.number("rotation", {-360, 360}).value_or(0));
  return studio;
}

}  // namespace

void parse_toml_light(const TomlValue& value, std::size_t number, const TomlSceneContext& context) {
  const auto* table = std::get_if<TomlTable>(&value.data);
  const std::string title = fmt::format("light {}", number);
  if (table == nullptr) {
    context.problems.add(value.place, title + ": must be a table, written [[light]]");
    return;
  }
  TomlTableReader reader(*table, value.place, title, context.problems);
  if (!reader.has("type")) reader.report_missing("type");
  const auto kind = reader.word<LightKind>("type", kLightKinds);
  if (!kind) return;
  if (*kind == LightKind::area && reader.has("corner")) {
    context.scene.lights.push_back(parse_cornered_area(reader));
  } else {
    parse_described_light(reader, *kind, context);
  }
  reader.report_unknown();
}

std::optional<Environment> parse_toml_environment(const TomlMember& member,
                                                  const TomlSceneContext& context) {
  const TomlTable* table = as_toml_table(member, context.problems);
  if (table == nullptr) return std::nullopt;
  TomlTableReader reader(*table, member.value.place, "[environment]", context.problems);
  if (!reader.has("type")) reader.report_missing("type");
  const auto kind = reader.word<EnvironmentKind>("type", kEnvironmentKinds);
  if (!kind) return std::nullopt;
  auto environment = parse_environment_of(*kind, reader, context);
  reader.report_unknown();
  return environment;
}

}  // namespace arris
