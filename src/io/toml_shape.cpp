#include "io/toml_shape.h"

#include <fmt/format.h>

#include <array>

#include "geometry/shapes.h"

namespace arris {
namespace {

enum class ShapeKind {
  box,
  sphere,
  icosphere,
  cylinder,
  cone,
  prism,
  pyramid,
  plane,
  tetrahedron,
  octahedron,
  dodecahedron,
  icosahedron,
};
constexpr std::array<TomlWord<ShapeKind>, 12> kShapes = {{
    {"box", ShapeKind::box},
    {"sphere", ShapeKind::sphere},
    {"icosphere", ShapeKind::icosphere},
    {"cylinder", ShapeKind::cylinder},
    {"cone", ShapeKind::cone},
    {"prism", ShapeKind::prism},
    {"pyramid", ShapeKind::pyramid},
    {"plane", ShapeKind::plane},
    {"tetrahedron", ShapeKind::tetrahedron},
    {"octahedron", ShapeKind::octahedron},
    {"dodecahedron", ShapeKind::dodecahedron},
    {"icosahedron", ShapeKind::icosahedron},
}};

// One number stands for all sides.
bool has_one_number(TomlTableReader& reader, const char* key) {
  const TomlMember* member = reader.find(key);
  return member != nullptr && !std::holds_alternative<TomlArray>(member->value.data);
}

TomlShape parse_box(TomlTableReader& reader) {
  Vec3d size(1.0);
  if (has_one_number(reader, "size")) {
    size = Vec3d(reader.number("size", kTomlPositive).value_or(1));
  } else {
    size = reader.vec3("size", kTomlPositive).value_or(size);
  }
  return {fmt::format("box {} {} {}", size.x, size.y, size.z), make_box_mesh(size)};
}

TomlShape parse_plane(TomlTableReader& reader) {
  Vec2d size{1, 1};
  if (has_one_number(reader, "size")) {
    const double side = reader.number("size", kTomlPositive).value_or(1);
    size = {side, side};
  } else {
    size = reader.vec2("size", kTomlPositive).value_or(size);
  }
  return {fmt::format("plane {} {}", size.x, size.y), make_plane_mesh(size)};
}

TomlShape parse_cone(ShapeKind kind, TomlTableReader& reader) {
  const bool is_flat = kind == ShapeKind::prism || kind == ShapeKind::pyramid;
  const bool is_pointed = kind == ShapeKind::cone || kind == ShapeKind::pyramid;
  ConeShape shape;
  shape.bottom_radius = reader.number("radius", kTomlPositive).value_or(0.5);
  shape.top_radius =
      is_pointed ? reader.number("top_radius", kTomlNotNegative).value_or(0) : shape.bottom_radius;
  shape.height = reader.number("height", kTomlPositive).value_or(1);
  shape.segments = is_flat ? reader.integer("sides", 3, kMaxShapeSegments).value_or(6)
                           : reader.integer("segments", 3, kMaxShapeSegments).value_or(64);
  return {fmt::format("{} {} {} {} {}", is_flat ? "prism" : "cone", shape.bottom_radius,
                      shape.top_radius, shape.height, shape.segments),
          is_flat ? make_prism_mesh(shape) : make_cone_mesh(shape)};
}

TomlShape parse_round(ShapeKind kind, TomlTableReader& reader) {
  const double radius = reader.number("radius", kTomlPositive).value_or(0.5);
  switch (kind) {
    case ShapeKind::sphere: {
      const int segments = reader.integer("segments", 3, kMaxShapeSegments).value_or(64);
      return {fmt::format("sphere {} {}", radius, segments), make_sphere_mesh(radius, segments)};
    }
    case ShapeKind::icosphere: {
      const int subdivisions =
          reader.integer("subdivisions", 0, kMaxIcosphereSubdivisions).value_or(1);
      return {fmt::format("icosphere {} {}", radius, subdivisions),
              make_icosphere_mesh(radius, subdivisions)};
    }
    case ShapeKind::tetrahedron:
      return {fmt::format("tetrahedron {}", radius), make_tetrahedron_mesh(radius)};
    case ShapeKind::octahedron:
      return {fmt::format("octahedron {}", radius), make_octahedron_mesh(radius)};
    case ShapeKind::dodecahedron:
      return {fmt::format("dodecahedron {}", radius), make_dodecahedron_mesh(radius)};
    default:
      break;
  }
  return {fmt::format("icosahedron {}", radius), make_icosahedron_mesh(radius)};
}

TomlShape parse_shape_of(ShapeKind kind, TomlTableReader& reader) {
  switch (kind) {
    case ShapeKind::box:
      return parse_box(reader);
    case ShapeKind::plane:
      return parse_plane(reader);
    case ShapeKind::cylinder:
    case ShapeKind::cone:
    case ShapeKind::prism:
    case ShapeKind::pyramid:
      return parse_cone(kind, reader);
    default:
      return parse_round(kind, reader);
  }
}

}  // namespace

std::optional<TomlShape> parse_toml_shape(TomlTableReader& reader) {
  const auto kind = reader.word<ShapeKind>("shape", kShapes);
  if (!kind) return std::nullopt;
  TomlShape shape = parse_shape_of(*kind, reader);
  for (const TomlWord<ShapeKind>& entry : kShapes) {
    if (entry.value == *kind) shape.mesh.name = entry.word;
  }
  return shape;
}

}  // namespace arris
