#include "arris/rounding_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arris/console.h"

namespace arris::program {
namespace {

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

// A note of several objects is said once, with their number; in detail for each object.
void report_notes(Console& console, const std::vector<RoundingSummary>& summaries) {
  struct Sum {
    RoundingNote note;
    std::size_t objects = 0;
    std::string object;  // the first
  };
  std::vector<Sum> sums;  // in the order of appearance
  for (const RoundingSummary& summary : summaries) {
    for (const RoundingNote& note : summary.notes) {
      auto sum = std::ranges::find(sums, note.many, [](const Sum& s) { return s.note.many; });
      if (sum == sums.end()) {
        Sum start;
        start.note = {0, note.one, note.many};
        start.object = summary.object;
        sums.push_back(std::move(start));
        sum = sums.end() - 1;
      }
      sum->note.count += note.count;
      ++sum->objects;
    }
  }
  bool any_merged = false;
  for (const Sum& sum : sums) {
    any_merged = any_merged || sum.objects > 1;
    console.report(sum.objects == 1 ? fmt::format("{}: {}", sum.object, sum.note.text())
                                    : fmt::format("{} objects: {}", sum.objects, sum.note.text()));
  }
  if (!any_merged) return;
  for (const RoundingSummary& summary : summaries) {
    for (const RoundingNote& note : summary.notes) {
      console.detail(fmt::format("{}: {}", summary.object, note.text()));
    }
  }
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
  report_notes(console, stats.rounding);
}

}  // namespace arris::program
