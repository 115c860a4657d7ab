// obj_files_in_memory.h — one library for every name, pictures of one texel
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_readers.h"

namespace arris::test {

// Names that start with "no" are of files that are not there.
inline ObjFiles obj_files_in_memory(std::vector<std::uint8_t> library) {
  ObjFiles files;
  files.find_library = [library = std::move(library)](
                           const std::string& name) -> std::optional<std::vector<std::uint8_t>> {
    if (name.starts_with("no")) return std::nullopt;
    return library;
  };
  files.find_texture = [](const std::string& name) -> std::optional<Texture> {
    if (name.starts_with("no")) return std::nullopt;
    Texture texture;
    texture.width_px = texture.height_px = 1;
    texture.texels.push_back({1, 2, 3, 4});
    return texture;
  };
  return files;
}

}  // namespace arris::test
