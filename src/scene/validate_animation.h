// validate_animation.h — the part of validate_scene() that looks at keys
#pragma once

#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

// Frames and their order, ids and numbers; what lies between keys is looked at frame by frame.
void check_animation(const Scene& scene, std::vector<std::string>& problems);

}  // namespace arris
