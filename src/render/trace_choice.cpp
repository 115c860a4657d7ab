#include "render/trace_choice.h"

#include <algorithm>
#include <utility>

namespace arris {
namespace {

constexpr double kRayMs = 0.25e-3;
// Weight of what is new in the mean, and how far above the limit traced frames may go.
constexpr double kNew = 0.25, kSlack = 1.5;
// Fewer items say little: they wait for more.
constexpr std::uint64_t kLeastItems = 64;

}  // namespace

void TraceChoice::add(const ShadingCost& more, int threads) {
  pending_.items += more.items;
  pending_.rays += more.rays;
  pending_.thread_seconds += more.thread_seconds;
  if (pending_.items < kLeastItems) return;
  const ShadingCost cost = std::exchange(pending_, {});
  const double ms = measure_ == CostMeasure::rays
                        ? double(cost.rays) * kRayMs
                        : cost.thread_seconds * 1e3 / double(std::max(1, threads));
  const double item_ms = ms / double(cost.items);
  item_ms_ = item_ms_ > 0 ? item_ms_ + kNew * (item_ms - item_ms_) : item_ms;
}

bool TraceChoice::decide(double pixels, double frame_ms) {
  if (!(below_ms_ > 0) || !(item_ms_ > 0)) return false;
  double limit = below_ms_;
  if (measure_ == CostMeasure::seconds) limit = std::max(limit, frame_ms);
  traces_ = estimate_ms(pixels) < (traces_ ? kSlack * limit : limit);
  return traces_;
}

}  // namespace arris
