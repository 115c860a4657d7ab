// stop_signal.h — Ctrl-C as a request
// What       the first SIGINT or SIGTERM sets the flag; the second ends the program as usual
#pragma once

#include <atomic>

namespace arris::program {

// Call once, before the work begins.
const std::atomic<bool>& catch_stop_signals();

}  // namespace arris::program
