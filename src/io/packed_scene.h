// packed_scene.h — meshes, plain materials, objects and notes of a scene as bytes
// What       what arris-step (apps/step) hands to the reader of STEP files. Of materials: name, base color, opacity;
//            nothing of textures, CSG, lights, cameras and settings
// Guarantee  unpack_scene(pack_scene(s)) has all of these as s has them
// Limits     between programs of one build: a mark at the beginning tells others apart
// Errors     kind failed, for bytes that pack_scene() has not made
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/scene.h"

namespace arris {

std::vector<std::uint8_t> pack_scene(const Scene& scene);
Scene unpack_scene(std::span<const std::uint8_t> bytes);

}  // namespace arris
