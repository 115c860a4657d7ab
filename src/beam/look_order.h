// look_order.h — which surface comes first among the leaves of a window of depths
// What       Goes along the ray from the window's near end, from one place where leaves are entered or left to the
//            next, until the value of a part's tree changes. What is entered or left at one depth counts at once.
// Guarantee  an answer holds along every ray through the rectangle for which the oracle's assumptions hold
//            (tests/beam/region_look_test.cpp)
// Cost       for each place met, the leaves that are left, and the trees for those that are met there
#pragma once

#include <optional>

#include "beam/look_window.h"

namespace arris {

// A node that is a surface, or nothing. No node: a sign is open, which the oracle remembers, or no sign helps.
// `only`: see LookOptions. Precondition: the window is found under the oracle's assumptions.
std::optional<LookNode> find_first(const BeamView& view, const LookWindow& window,
                                   const std::optional<LitPlane>& only, SignOracle& oracle);

}  // namespace arris
