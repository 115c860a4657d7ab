// model_scene.h — a model file as a benchmark scene
// What       as `arris render` shows it: framed, on a soft ground, under the studio, or as the file says
// Errors     those of load_scene(); std::invalid_argument for a radius that is none, and for a model that is too large
#pragma once

#include <filesystem>
#include <string>

#include "rounding/scenes.h"

namespace arris::bench {

// radius and edges: as --round and --round-edges of the program; they go over what the file says. Empty: the file's,
// else automatic and convex.
BenchScene make_model_scene(const std::filesystem::path& file, const std::string& radius,
                            const std::string& edges);

}  // namespace arris::bench
