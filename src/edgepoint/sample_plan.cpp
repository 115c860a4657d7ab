#include "edgepoint/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace arris {
namespace {

constexpr int kTile = 32;  // pixels
constexpr int kPattern = 128;

std::uint64_t square(std::size_t w) {
  return w * w;
}

float fraction(float v) {
  return v - std::floor(v);
}

// Evenly spread over any neighbourhood, in parts of 2^16.
std::array<std::uint16_t, std::size_t(kPattern* kPattern)> make_pattern() {
  std::array<std::uint16_t, std::size_t(kPattern * kPattern)> pattern{};
  for (int y = 0; y < kPattern; ++y) {
    for (int x = 0; x < kPattern; ++x) {
      const float noise =
          fraction(52.9829189F * fraction(0.06711056F * float(x) + 0.00583715F * float(y)));
      pattern[std::size_t(y * kPattern + x)] = std::uint16_t(noise * 65536);
    }
  }
  return pattern;
}

constexpr int kUrgentFrom = 64, kMostWanted = 255;

}  // namespace

std::size_t count_urgent(std::span<const std::uint8_t> wanted) {
  std::uint64_t sum = 0;
  for (const std::uint8_t w : wanted) sum += std::uint64_t(std::max(0, int(w) - kUrgentFrom));
  return std::size_t(sum / (kMostWanted - kUrgentFrom));
}

std::vector<std::uint32_t> plan_samples(std::span<const std::uint8_t> wanted,
                                        const SamplePlanSettings& settings) {
  std::vector<std::uint32_t> plan;
  const std::uint64_t total =
      std::accumulate(wanted.begin(), wanted.end(), std::uint64_t{0},
                      [](std::uint64_t sum, std::uint8_t w) { return sum + square(w); });
  if (total == 0 || settings.count == 0) return plan;
  static const auto kNoise = make_pattern();
  const double chance = 65536.0 * double(settings.count) / double(total);
  std::array<std::uint32_t, 256> limit{};
  for (std::size_t w = 0; w < limit.size(); ++w) {
    limit[w] = std::uint32_t(std::min(65536.0, chance * double(square(w))));
  }
  // The golden ratio spreads a pixel's values over the frames.
  const auto shift = std::uint16_t(settings.frame * 40503U);
  plan.reserve(settings.count + settings.count / 8);
  for (int y0 = 0; y0 < settings.height_px; y0 += kTile) {
    for (int x0 = 0; x0 < settings.width_px; x0 += kTile) {
      for (int y = y0; y < std::min(y0 + kTile, settings.height_px); ++y) {
        const std::size_t row = std::size_t(y) * std::size_t(settings.width_px);
        for (int x = x0; x < std::min(x0 + kTile, settings.width_px); ++x) {
          const auto noise =
              std::uint16_t(kNoise[std::size_t(y % kPattern * kPattern + x % kPattern)] + shift);
          if (noise < limit[wanted[row + std::size_t(x)]]) {
            plan.push_back(std::uint32_t(row) + std::uint32_t(x));
          }
        }
      }
    }
  }
  return plan;
}

}  // namespace arris
