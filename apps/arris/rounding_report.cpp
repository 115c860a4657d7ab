#include "arris/rounding_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arris/console.h"

namespace arris::program {
namespace {

bool is_automatic(const Scene& scene, const RoundingSummary& summary) {
  const Object& object = scene.objects[summary.object_index];
  const std::optional<RoundingSettings>& settings =
      object.rounding ? object.rounding : scene.rounding;
  return settings && std::holds_alternative<AutoRadius>(settings->radius);
}

std::string origin_of_radii(const Scene& scene,
                            const std::vector<const RoundingSummary*>& rounded) {
  const auto automatic = std::size_t(std::ranges::count_if(
      rounded, [&](const RoundingSummary* summary) { return is_automatic(scene, *summary); }));
  if (automatic == 0) return "";
  if (automatic == rounded.size()) return " (automatic; --round R sets it)";
  return fmt::format(" (automatic for {} of {} objects; --round R sets it for all)", automatic,
                     rounded.size());
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
    console.report(fmt::format("rounded {} edges and {} corners, {}{}", stats.rounded_edges,
                               stats.rounded_corners, radii(rounded),
                               origin_of_radii(scene, rounded)));
  }
  report_notes(console, stats.rounding);
}

}  // namespace arris::program
