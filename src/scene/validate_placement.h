// validate_placement.h — the part of validate_scene() that looks at what moves
#pragma once

#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

// How texts number lights, and objects without a name: as programs or as scene files do.
enum class NumberedFrom { zero, one };

// What is wrong with camera, transforms and lights, one line each; meshes are not looked at, nor how far they reach.
// Precondition: the scene was valid before these were changed.
std::vector<std::string> validate_placement(const Scene& scene,
                                            NumberedFrom numbered = NumberedFrom::zero);

}  // namespace arris
