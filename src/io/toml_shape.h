// toml_shape.h — the `shape` of an object as a mesh
#pragma once

#include "arris/scene.h"
#include "io/toml_document.h"

namespace arris {

struct TomlShape {
  std::string key;  // equal for equal shapes
  Mesh mesh;
};

// Reads `shape` and its parameters; nothing if they are wrong, which is reported.
std::optional<TomlShape> parse_toml_shape(TomlTableReader& reader);

}  // namespace arris
