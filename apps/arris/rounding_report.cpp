#include "arris/rounding_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "arris/console.h"

namespace arris::program {
namespace {

constexpr std::size_t kMostLines = 4;

bool has_automatic_radius(const Scene& scene) {
  const auto is_automatic = [](const RoundingSettings& settings) {
    return settings.method != RoundMethod::none &&
           std::holds_alternative<AutoRadius>(settings.radius);
  };
  return (scene.rounding && is_automatic(*scene.rounding)) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
           return object.rounding && is_automatic(*object.rounding);
         });
}

std::string radii(const std::vector<const RoundingSummary*>& rounded) {
  const auto [least, most] = std::minmax_element(
      rounded.begin(), rounded.end(),
      [](const RoundingSummary* a, const RoundingSummary* b) { return a->radius < b->radius; });
  const double low = (*least)->radius, high = (*most)->radius;
  return low == high ? fmt::format("radius {:.4g}", low)
                     : fmt::format("radii {:.4g} to {:.4g}", low, high);
}

}  // namespace

void report_rounding(Console& console, const Scene& scene, const PrepareStats& stats) {
  std::vector<const RoundingSummary*> rounded;
  for (const RoundingSummary& summary : stats.rounding) {
    if (summary.radius > 0) rounded.push_back(&summary);
  }
  if (!rounded.empty()) {
    console.report(fmt::format(
        "rounded {} edges and {} corners, {}{}", stats.rounded_edges, stats.rounded_corners,
        radii(rounded), has_automatic_radius(scene) ? " (automatic; --round R sets it)" : ""));
  }
  std::size_t notes = 0;
  for (const RoundingSummary& summary : stats.rounding) {
    for (const std::string& note : summary.notes) {
      const std::string line = fmt::format("{}: {}", summary.object, note);
      ++notes;
      if (notes <= kMostLines) {
        console.report(line);
      } else {
        console.detail(line);
      }
    }
  }
  if (notes > kMostLines) {
    console.report(
        fmt::format("… and {} more notes on rounding; --verbose shows all", notes - kMostLines));
  }
}

}  // namespace arris::program
