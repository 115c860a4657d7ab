// export_scene.h — a benchmark scene as files that another renderer's script can read (cycles.py)
// Out        NAME.json: objects (name, material, first vertex, first triangle, counts, radius), materials, camera,
//            lights, image; NAME.bin: all positions (3 float), then all triangles (3 uint32, counted from the object's
//            first vertex), little-endian
#pragma once

#include <filesystem>

#include "rounding/scenes.h"

namespace arris::bench {

void export_scene(const BenchScene& bench, const std::filesystem::path& folder);

}  // namespace arris::bench
