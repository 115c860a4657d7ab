// scene_bytes.h — scenes that come through a pipe: no name says their format, so their content does
// Limits     OBJ, TOML and OpenSCAD's .csg are told apart by their first line that is neither empty nor a comment.
//            Files that the scene names are looked for in the current folder.
// Errors     kind input
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "arris/io.h"
#include "arris/scene.h"

namespace arris {

// ".stl", …: one of scene_extensions(). name: for errors.
std::string find_scene_extension(std::span<const std::uint8_t> bytes, const std::string& name);

Scene read_scene(std::span<const std::uint8_t> bytes, const std::string& extension,
                 const std::string& name, const LoadOptions& options = {});

}  // namespace arris
