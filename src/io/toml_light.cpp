#include <fmt/format.h>

#include <array>
#include <cmath>

#include "arris/error.h"
#include "arris/io.h"
#include "io/toml_scene_parts.h"

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

// color times the number under `key`.
Rgb parse_emission(TomlTableReader& reader, const char* key) {
  const Vec3d color = reader.vec3("color", kTomlNotNegative).value_or(Vec3d(1.0));
  return Rgb(color * reader.number(key, kStrength).value_or(1));
}

Vec3d parse_required_position(TomlTableReader& reader) {
  if (!reader.has("position")) reader.report_missing("position");
  return reader.vec3("position", kTomlCoordinate).value_or(Vec3d(0.0));
}

// "direction", or from the position to "target".
Vec3d parse_direction(TomlTableReader& reader, Vec3d position) {
  const auto target = reader.vec3("target", kTomlCoordinate);
  const auto direction = reader.direction("direction");
  if (reader.has("target") == reader.has("direction")) {
    reader.report("direction", "give either \"direction\" or \"target\"");
  } else if (target && *target == position) {
    reader.report("target", "is the light's own position");
  } else if (target) {
    return *target - position;
  }
  return direction.value_or(Vec3d(0, 0, -1));
}

SpotLight parse_spot(TomlTableReader& reader) {
  SpotLight light;
  light.position = parse_required_position(reader);
  light.direction = parse_direction(reader, light.position);
  light.intensity = parse_emission(reader, "intensity");
  const double outer = reader.number("outer_angle", {0, 180, true}).value_or(45);
  const double inner = reader.number("inner_angle", {0, 180}).value_or(0);
  if (inner > outer) {
    reader.report("inner_angle", fmt::format("is {}; use at most outer_angle, {}", inner, outer));
  }
  light.outer_angle = radians(outer);
  light.inner_angle = radians(inner);
  return light;
}

// Centred at `position` and facing `target`; `up` says which way its height goes.
void place_area(TomlTableReader& reader, Vec3d up, AreaLight& light) {
  const Vec3d position = parse_required_position(reader);
  const Vec3d facing = normalize(parse_direction(reader, position));
  Vec2d size{1, 1};
  if (const TomlMember* member = reader.find("size")) {
    if (std::holds_alternative<TomlArray>(member->value.data)) {
      size = reader.vec2("size", kTomlPositive).value_or(size);
    } else {
      const double side = reader.number("size", kTomlPositive).value_or(1);
      size = {side, side};
    }
  }
  up = reader.direction("up").value_or(up);
  Vec3d across = cross(up, facing);
  if (length(across) < 1e-6 * length(up)) {  // up is along the view: any axis that is not will do
    across = cross(std::abs(facing.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), facing);
  }
  const Vec3d u = normalize(across);
  const Vec3d v = cross(facing, u);
  light.edge_u = u * size.x;
  light.edge_v = v * size.y;
  light.corner = position - light.edge_u * 0.5 - light.edge_v * 0.5;
}

AreaLight parse_area(TomlTableReader& reader, Vec3d up) {
  AreaLight light;
  if (reader.has("corner")) {
    light.corner = reader.vec3("corner", kTomlCoordinate).value_or(light.corner);
    if (!reader.has("edge_u")) reader.report_missing("edge_u");
    if (!reader.has("edge_v")) reader.report_missing("edge_v");
    light.edge_u = reader.direction("edge_u").value_or(light.edge_u);
    light.edge_v = reader.direction("edge_v").value_or(light.edge_v);
    if (!(length_squared(cross(light.edge_u, light.edge_v)) > 0)) {
      reader.report("edge_v", "spans no area with edge_u");
    }
  } else {
    place_area(reader, up, light);
  }
  light.radiance = parse_emission(reader, "radiance");
  light.visible_to_camera = reader.boolean("visible").value_or(true);
  return light;
}

Light parse_light_of(LightKind kind, TomlTableReader& reader, Vec3d up) {
  switch (kind) {
    case LightKind::point: {
      const Vec3d position = parse_required_position(reader);
      return PointLight{position, parse_emission(reader, "intensity")};
    }
    case LightKind::spot:
      return parse_spot(reader);
    case LightKind::directional: {
      if (!reader.has("direction")) reader.report_missing("direction");
      const Vec3d direction = reader.direction("direction").value_or(Vec3d(0, 0, -1));
      return DirectionalLight{direction, parse_emission(reader, "irradiance")};
    }
    case LightKind::area:
      break;
  }
  return parse_area(reader, up);
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
  return StudioEnvironment{reader.number("strength", kStrength).value_or(1), context.scene.up};
}

}  // namespace

std::optional<Light> parse_toml_light(const TomlValue& value, std::size_t number,
                                      const TomlSceneContext& context) {
  const auto* table = std::get_if<TomlTable>(&value.data);
  const std::string title = fmt::format("light {}", number);
  if (table == nullptr) {
    context.problems.add(value.place, title + ": must be a table, written [[light]]");
    return std::nullopt;
  }
  TomlTableReader reader(*table, value.place, title, context.problems);
  if (!reader.has("type")) reader.report_missing("type");
  const auto kind = reader.word<LightKind>("type", kLightKinds);
  if (!kind) return std::nullopt;
  const Light light = parse_light_of(*kind, reader, context.scene.up);
  reader.report_unknown();
  return light;
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
