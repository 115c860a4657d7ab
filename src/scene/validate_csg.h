// validate_csg.h — everything that is wrong with a CSG tree, before anything is built from it
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

// Adds a line for each kind of problem: the first place of it, and how many more there are.
void check_csg_tree(const Scene& scene, std::size_t index, std::vector<std::string>& problems);

}  // namespace arris
