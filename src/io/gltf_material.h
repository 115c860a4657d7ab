// gltf_material.h — glTF materials and textures as the scene's
// What       decodes each image once and makes one Texture for each way in which it is used:
//            wrapping, sRGB or linear, with or without its alpha
// Errors     kind input, naming the image
#pragma once

#include <filesystem>
#include <optional>

#include "io/gltf_buffers.h"
#include "io/gltf_mesh.h"

namespace arris {

struct GltfMaterials {
  std::vector<Material> materials;  // by glTF index
  std::vector<Texture> textures;
  std::vector<GltfUvChoice> uv_choices;  // by glTF index
  std::vector<std::string> notes;
};

GltfMaterials make_gltf_materials(const GltfSource& source,
                                  const std::optional<std::filesystem::path>& base_folder);

}  // namespace arris
