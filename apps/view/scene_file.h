// scene_file.h — the view as a scene file, to be rendered by `arris render`
// Guarantee  what the format can't say of the view is said in comments on top of the file
#pragma once

#include <string>

#include "view/view_stage.h"

namespace arris::view {

std::string make_scene_file(const ViewModel& model, const ViewEdits& edits);

}  // namespace arris::view
