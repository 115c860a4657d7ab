// rounding_text.h — "auto", "none", "0.5" or "12%" as a rounding
// What       the short form that the program's --round, glTF's extras.arris_radius and scene files share
// Limits     nothing is returned for any other text, a negative number or a percentage outside (0, 100)
#pragma once

#include <optional>
#include <string_view>

#include "arris/scene.h"

namespace arris {

inline constexpr const char* kRoundingTextForms =
    "use a radius of 0 or more, a percentage of the inradius like \"12%\", \"auto\" or \"none\"";

// Method exact, or method none for "none" and 0.
std::optional<RoundingSettings> parse_rounding_text(std::string_view text);

// The same for a radius in world units.
std::optional<RoundingSettings> make_rounding_settings(double radius);

// 12 for "12%"; nothing for what is no percentage.
std::optional<double> parse_percent(std::string_view text);

}  // namespace arris
