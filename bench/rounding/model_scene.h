// model_scene.h — a model file as a benchmark scene
// What       as `arris render` shows it: framed, on a soft ground, under the studio, or as the file says
// Errors     those of load_scene(); std::invalid_argument for a radius that is none, and for a model that is too large
#pragma once

#include <filesystem>
#include <string>

#include "rounding/scenes.h"

namespace arris::bench {

// radius: as --round of the program; it goes over what the file says. Empty: the file's, else automatic.
BenchScene make_model_scene(const std::filesystem::path& file, const std::string& radius);

}  // namespace arris::bench
