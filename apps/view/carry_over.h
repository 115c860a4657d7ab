// carry_over.h — what has been changed of a model whose file is read again
// What       changes of the scene stay; those of objects follow the objects by their names
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "view/view_stage.h"

namespace arris::view {

// For each object of `now` the one of `before` that has its name; of several of one name the n-th is the n-th.
// Empty: it is new.
using ObjectMatch = std::vector<std::optional<std::size_t>>;
ObjectMatch match_objects(const ViewModel& before, const ViewModel& now);

// The edits of a model whose file has been read again: what was changed by hand stays, all else is as the file is now.
// Of a framed view the camera is fit_camera()'s to find.
ViewEdits carry_over(const ViewEdits& first_before, const ViewEdits& edits, ViewEdits first_now,
                     const ObjectMatch& match);

// Names of the objects of `before` that were changed by hand and match none.
std::vector<std::string> lost_objects(const ViewModel& before, const ViewEdits& edits,
                                      const ObjectMatch& match);

}  // namespace arris::view
