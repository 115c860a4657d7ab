#include "scene/rounding_text.h"

#include <charconv>
#include <cmath>

namespace arris {
namespace {

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

RoundingSettings exact_rounding(Radius radius) {
  RoundingSettings settings;
  settings.method = RoundMethod::exact;
  settings.radius = radius;
  return settings;
}

}  // namespace

std::optional<RoundingSettings> make_rounding_settings(double radius) {
  if (!std::isfinite(radius) || radius < 0) return std::nullopt;
  return radius == 0 ? RoundingSettings{} : exact_rounding(radius);
}

std::optional<RoundingSettings> parse_rounding_text(std::string_view text) {
  if (text == "none") return RoundingSettings{};
  if (text == "auto") return exact_rounding(AutoRadius{});
  if (text.ends_with('%')) {
    const std::optional<double> percent = parse_percent(text);
    if (!percent || !(*percent > 0 && *percent < 100)) return std::nullopt;
    return exact_rounding(PercentOfInradius{*percent});
  }
  const std::optional<double> radius = parse_number(text);
  return radius ? make_rounding_settings(*radius) : std::nullopt;
}

std::optional<double> parse_percent(std::string_view text) {
  if (!text.ends_with('%')) return std::nullopt;
  return parse_number(text.substr(0, text.size() - 1));
}

}  // namespace arris
