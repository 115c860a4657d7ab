// scene_writer.h — scene files (.toml) from scenes
// What       picture, camera, environment, lights, rounding and materials of a scene, and its objects by the files that
//            they came from, as docs/scene-format.md has it
// Guarantee  what is read back has the same numbers; all of the scene that the format can't say is listed as comments
// Limits     meshes, textures and maps of environments are not written: objects name files
#pragma once

#include <optional>
#include <span>
#include <string>

#include "arris/scene.h"

namespace arris {

// One [[object]].
struct WrittenObject {
  std::string file;                  // as it is to stand in the file
  std::string name;                  // empty: the file's
  std::optional<Material> material;  // in place of the file's own; without textures
  std::optional<RoundingSettings> rounding;
  Affine3d world_from_file;
};

// comments: one line each, at the top. The scene's own objects, meshes and materials are not looked at.
std::string write_toml_scene(const Scene& scene, std::span<const WrittenObject> objects,
                             std::span<const std::string> comments);

}  // namespace arris
