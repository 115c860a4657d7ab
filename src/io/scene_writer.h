// scene_writer.h — parts of scene files (.toml) from parts of scenes, as docs/scene-format.md has them
// Guarantee  what is read back has the same numbers, but for the last digit of angles that were never in degrees
//            (tests/io/scene_writer_test.cpp)
// Limits     meshes, and textures of materials, are not written: scene files name files
#pragma once

#include <span>
#include <string>

#include "arris/scene.h"
#include "io/toml_document.h"

namespace arris {

// up, image, camera, environment, lights, rounding and ground; neither objects nor what moves. An environment's map has
// the name that the scene has for it.
TomlTable make_scene_table(const Scene& scene);

TomlTable make_rounding_table(const RoundingSettings& rounding);
TomlTable make_material_table(const Material& material);
TomlArray make_matrix_rows(const Affine3d& matrix);

// comments: one line each, at the top.
std::string write_scene_file(const TomlTable& scene, std::span<const std::string> comments);

}  // namespace arris
