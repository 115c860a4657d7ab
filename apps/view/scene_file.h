// scene_file.h — the view as a scene file, to be rendered by `arris render`
// What       a scene file's own objects and materials, or the model as one [[object]], and what the view has changed
// Guarantee  the file is read as the scene that is shown (tests/view/scene_file_test.cpp)
// Limits     animations of camera and lights are left out, for the view is of one moment; so are comments, and the
//            keys of objects that were moved. Options of `arris view` on how OpenSCAD files are read are not in it.
// Errors     kind input: models that came through a pipe; names of files that are not UTF-8; nothing to see
#pragma once

#include <string>

#include "view/view_stage.h"

namespace arris::view {

// file_name: that it will have, for the commands in its first lines.
std::string make_scene_file(const ViewModel& model, const ViewEdits& edits,
                            const std::string& file_name = "scene.toml");

}  // namespace arris::view
