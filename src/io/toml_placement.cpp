// toml_placement.cpp — where things are: translate, rotate, scale, or matrix
#include <optional>
#include <vector>

#include "io/toml_scene_parts.h"
#include "scene/limits.h"
#include "scene/placement.h"

namespace arris {
namespace {

constexpr double kMaxTurnDeg = 1e6;

// 4 rows of 4 numbers.
std::optional<Affine3d> parse_matrix(TomlTableReader& reader) {
  const TomlMember* member = reader.find("matrix");
  const auto* rows = std::get_if<TomlArray>(&member->value.data);
  if (rows == nullptr || rows->size() != 4) {
    reader.report("matrix", "must be 4 rows of 4 numbers");
    return std::nullopt;
  }
  std::vector<std::vector<double>> m;
  for (const TomlValue& row : *rows) {
    if (auto numbers = reader.numbers_of(row, "matrix", 4, kTomlCoordinate)) m.push_back(*numbers);
  }
  if (m.size() != 4) return std::nullopt;
  if (m[3] != std::vector<double>{0, 0, 0, 1}) {
    reader.report("matrix", "the last row must be [0, 0, 0, 1]");
    return std::nullopt;
  }
  const auto column = [&](std::size_t i) { return Vec3d(m[0][i], m[1][i], m[2][i]); };
  return Affine3d{{column(0), column(1), column(2)}, column(3)};
}

// A number or 3 numbers.
std::optional<Vec3d> parse_scale(TomlTableReader& reader) {
  const TomlMember* member = reader.find("scale");
  if (member == nullptr) return std::nullopt;
  if (std::holds_alternative<TomlArray>(member->value.data)) {
    return reader.vec3("scale", kTomlCoordinate);
  }
  const auto number = reader.number("scale", kTomlCoordinate);
  return number ? std::optional(Vec3d(*number)) : std::nullopt;
}

bool has_motion(TomlTableReader& reader) {
  const bool translate = reader.has("translate"), rotate = reader.has("rotate");
  return reader.has("scale") || translate || rotate;
}

}  // namespace

bool has_toml_transform(TomlTableReader& reader) {
  const bool motion = has_motion(reader);
  return reader.has("matrix") || motion;
}

// translate, rotate and scale; what is missing is that of `own`.
ObjectKey parse_toml_motion(TomlTableReader& reader, const ObjectKey& own) {
  ObjectKey key;
  key.translate = reader.vec3("translate", kTomlCoordinate).value_or(own.translate);
  key.rotate_deg = reader.vec3("rotate", {-kMaxTurnDeg, kMaxTurnDeg}).value_or(own.rotate_deg);
  key.scale = parse_scale(reader).value_or(own.scale);
  return key;
}

void report_if_flat(TomlTableReader& reader, const Mat3d& linear, const char* key) {
  if (!is_invertible(linear)) reader.report(key, "flattens the object; use a scale other than 0");
}

Affine3d parse_toml_transform(TomlTableReader& reader, ObjectKey& own) {
  const bool has_parts = has_motion(reader);
  own = parse_toml_motion(reader, own);
  Affine3d transform = make_placement(own.translate, own.rotate_deg, own.scale);
  if (reader.has("matrix")) {
    if (has_parts) reader.report("matrix", "give it alone, or translate, rotate and scale");
    transform = parse_matrix(reader).value_or(Affine3d{});
  }
  report_if_flat(reader, transform.linear, reader.has("matrix") ? "matrix" : "scale");
  return transform;
}

}  // namespace arris
