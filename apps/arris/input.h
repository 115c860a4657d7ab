// input.h — the model or scene that a command works on
#pragma once

#include <string>

#include "arris/io.h"
#include "arris/scene.h"

namespace arris::program {

struct Input {
  std::string name;  // for messages
  Scene scene;
  bool is_scene_file = false;  // says itself how it is to be shown; else a bare model
};

// "-": stdin, in a format told by its content.
Input load_input(const std::string& name, const LoadOptions& options);

}  // namespace arris::program
