// file_kind.h — what a file is, by its name
#pragma once

#include <filesystem>
#include <string>

namespace arris {

// With its dot and in lower case: ".stl" for "part.STL".
std::string extension_of(const std::filesystem::path& path);

// Scene files say themselves how they are to be shown; other models are bare.
inline bool is_scene_file(const std::filesystem::path& path) {
  return extension_of(path) == ".toml";
}

}  // namespace arris
