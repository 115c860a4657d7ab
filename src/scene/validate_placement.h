// validate_placement.h — the part of validate_scene() that looks at what moves
#pragma once

#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

// What is wrong with camera, transforms and lights, one line each; meshes are not looked at, nor how far they reach.
// Precondition: the scene was valid before these were changed.
std::vector<std::string> validate_placement(const Scene& scene);

}  // namespace arris
