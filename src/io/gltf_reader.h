// gltf_reader.h — glTF 2.0 and GLB files
// What       the default scene's meshes, materials, textures, cameras and punctual lights; each node
//            with a mesh becomes an object, meshes used by several nodes are shared.
//            Coordinates stay as in the file (+Y up, metres); Scene::up is {0, 1, 0}.
//            The camera is the first perspective one. Candela become W/sr and lux W/m² by 683 lm/W,
//            the factor of Blender's exporter; emission is taken as radiance unchanged.
//            extras.arris_radius (number, "12%", "auto", "none") on node, mesh, scene or asset: rounding.
// Limits     left out with a line in Scene::notes: points, lines, vertex colours, morph targets,
//            animations, orthographic cameras, optional extensions that are not read.
//            Refused: required extensions that are not read (Draco, meshopt, …), skinned meshes.
// Errors     kind input, with the JSON path
// Cost       linear in the file; memory is bounded by a multiple of its bytes
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "arris/scene.h"

namespace arris {

// `name` is the file's name for errors; buffers and images are looked up in `base_folder`;
// without one they must be in the file itself.
Scene read_gltf(std::span<const std::uint8_t> bytes, const std::string& name,
                const std::optional<std::filesystem::path>& base_folder);

}  // namespace arris
