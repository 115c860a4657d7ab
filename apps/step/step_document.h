// step_document.h — a STEP file's assembly as a scene
// What       each solid of each part becomes a mesh (step_mesh.h), each place of a part an object. Names are those of
//            the instance, else of the part, and empty where the file has none.
// Units      millimetres, whatever the file has
// Errors     Error{input} without a place, for whoever knows the file's name
// Limits     what is in other files is not read; kMaxObjects objects
#pragma once

#include <filesystem>

#include "arris/scene.h"

namespace arris::step {

Scene read_step_document(const std::filesystem::path& file);

}  // namespace arris::step
