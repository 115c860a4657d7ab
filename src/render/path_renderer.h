// path_renderer.h — the path tracer as a Renderer, with what only tests and benchmarks choose
#pragma once

#include "arris/render.h"
#include "render/path_integrator.h"

namespace arris {

// The scene's max_depth decides; the rest of the settings are the caller's.
std::unique_ptr<Renderer> make_path_renderer(Strategies strategies);

}  // namespace arris
