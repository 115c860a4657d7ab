// toml_scene.h — Arris' own scene files
// What       docs/scene-format.md is the schema
// Guarantee  every problem of the file is listed, in its order, not only the first
// Errors     kind input: "scene.toml:12:5: …", one line for each problem
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "arris/scene.h"

namespace arris {

// Loads a model file for an object: load_scene(), or a test's own.
using LoadModel = std::function<Scene(const std::filesystem::path&)>;

// `name` is the file's name for errors; paths in it are relative to `base_directory`.
Scene read_toml_scene(std::string_view text, const std::string& name,
                      const std::filesystem::path& base_directory, const LoadModel& load_model);

}  // namespace arris
