#include "edgepoint/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace arris {
namespace {

constexpr int kTile = 32;  // pixels

float fraction(float v) {
  return v - std::floor(v);
}

// Evenly spread over any neighbourhood; the golden ratio spreads a pixel's values over the frames.
float dither(int x, int y, std::uint32_t frame) {
  const float pattern =
      fraction(52.9829189F * fraction(0.06711056F * float(x) + 0.00583715F * float(y)));
  return fraction(pattern + 0.61803399F * float(frame % 1024));
}

}  // namespace

std::vector<std::uint32_t> plan_samples(std::span<const std::uint8_t> wanted,
                                        const SamplePlanSettings& settings) {
  std::vector<std::uint32_t> plan;
  const std::uint64_t total = std::accumulate(wanted.begin(), wanted.end(), std::uint64_t{0});
  if (total == 0 || settings.count == 0) return plan;
  const float chance = float(double(settings.count) / double(total));
  plan.reserve(settings.count + settings.count / 8);
  for (int y0 = 0; y0 < settings.height_px; y0 += kTile) {
    for (int x0 = 0; x0 < settings.width_px; x0 += kTile) {
      for (int y = y0; y < std::min(y0 + kTile, settings.height_px); ++y) {
        const std::size_t row = std::size_t(y) * std::size_t(settings.width_px);
        for (int x = x0; x < std::min(x0 + kTile, settings.width_px); ++x) {
          if (dither(x, y, settings.frame) < chance * float(wanted[row + std::size_t(x)])) {
            plan.push_back(std::uint32_t(row) + std::uint32_t(x));
          }
        }
      }
    }
  }
  return plan;
}

}  // namespace arris
