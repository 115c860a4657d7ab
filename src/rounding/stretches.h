// stretches.h — along which parts of a way something is so
#pragma once

#include <utility>
#include <vector>

namespace arris {

// By fractions of the way: looked at in the middle of each of some even steps, and halved between two that differ. Ends
// are as what is next to them.
template <class IsIt>
std::vector<std::pair<double, double>> find_stretches(int steps, const IsIt& is_it) {
  constexpr int kHalvings = 30;
  std::vector<std::pair<double, double>> stretches;
  bool was = is_it(0.5 / steps);
  double from = 0;
  for (int i = 1; i < steps; ++i) {
    double low = (i - 0.5) / steps, high = (i + 0.5) / steps;
    const bool now = is_it(high);
    for (int k = 0; now != was && k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (is_it(middle) == was ? low : high) = middle;
    }
    if (was && !now) stretches.emplace_back(from, low);
    if (!was && now) from = high;
    was = now;
  }
  if (was) stretches.emplace_back(from, 1.0);
  return stretches;
}

}  // namespace arris
