// rounding_report.h — what rounding did, in words
#pragma once

#include "arris/render.h"
#include "arris/scene.h"

namespace arris::program {

class Console;

// One line for a few objects each, a summary for many; then what could not be rounded.
void report_rounding(Console& console, const Scene& scene, const PrepareStats& stats);

}  // namespace arris::program
