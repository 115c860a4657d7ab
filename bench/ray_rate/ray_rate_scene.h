// ray_rate_scene.h — the scenes that ray_rate measures
#pragma once

#include <string>

#include "arris/scene.h"

namespace arris::bench {

// About 276,000 triangles: 726 toy bricks with knobs, stacked in columns, under a rectangle light and a
// constant sky. Same numbers on every machine.
Scene make_blocks_scene();

// A scene file. If a .json of the same name lies beside it, camera, light, sky and the glossy mix come
// from there.
Scene load_measured_scene(const std::string& path);

}  // namespace arris::bench
