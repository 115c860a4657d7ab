// scene_fingerprint.h — a number that tells scenes apart
// What       scene_fingerprint() depends on everything that a render of one sample shows: geometry,
//            materials, textures, lights, camera, rounding, picture size, depth and filter; not on names,
//            sample count or exposure
// Limits     64 bits against mistakes, not against attackers; equal on all machines of one byte order
#pragma once

#include <cstdint>

#include "arris/scene.h"

namespace arris {

std::uint64_t scene_fingerprint(const Scene& scene);

}  // namespace arris
