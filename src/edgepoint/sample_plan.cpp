#include "edgepoint/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel_for.h"

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

// The sum of value(w), which is a square at most.
template <class Value>
std::uint64_t sum_of(std::span<const std::uint8_t> wanted, const ParallelOptions& parallel,
                     const Value& value) {
  constexpr std::size_t kPart = std::size_t{1} << 16U;
  std::vector<std::uint64_t> parts((wanted.size() + kPart - 1) / kPart);
  parallel_for(parts.size(), parallel, [&](std::size_t i) {
    const std::span part = wanted.subspan(i * kPart, std::min(kPart, wanted.size() - i * kPart));
    // Of 32 bits, so that a vector holds more of them: 65,536 squares fit.
    parts[i] = std::accumulate(
        part.begin(), part.end(), std::uint32_t{0},
        [&](std::uint32_t sum, std::uint8_t w) { return sum + std::uint32_t(value(w)); });
  });
  return std::accumulate(parts.begin(), parts.end(), std::uint64_t{0});
}

constexpr int kUrgentFrom = 64, kMostWanted = 255;

}  // namespace

std::size_t count_urgent(std::span<const std::uint8_t> wanted, int threads) {
  const std::uint64_t sum = sum_of(wanted, {.grain = 1, .threads = threads},
                                   [](std::uint8_t w) { return std::max(0, w - kUrgentFrom); });
  return std::size_t(sum / (kMostWanted - kUrgentFrom));
}

std::vector<std::uint32_t> plan_samples(std::span<const std::uint8_t> wanted,
                                        const SamplePlanSettings& settings) {
  std::vector<std::uint32_t> plan;
  const auto tile_rows = std::size_t((settings.height_px + kTile - 1) / kTile);
  const ParallelOptions parallel{.grain = 1, .threads = settings.threads};
  const std::uint64_t total = sum_of(wanted, parallel, [](std::uint8_t w) { return w * w; });
  if (total == 0 || settings.count == 0) return plan;
  static const auto kNoise = make_pattern();
  const double chance = 65536.0 * double(settings.count) / double(total);
  std::array<std::uint32_t, 256> limit{};
  for (std::size_t w = 0; w < limit.size(); ++w) {
    limit[w] = std::uint32_t(std::min(65536.0, chance * double(square(w))));
  }
  // The golden ratio spreads a pixel's values over the frames.
  const auto shift = std::uint16_t(settings.frame * 40503U);
  std::vector<std::vector<std::uint32_t>> parts(tile_rows);
  parallel_for(tile_rows, parallel, [&](std::size_t part) {
    const int y0 = int(part) * kTile;
    for (int x0 = 0; x0 < settings.width_px; x0 += kTile) {
      // Which pixels are taken can't be guessed, so there is no branch.
      std::array<std::uint32_t, std::size_t(kTile * kTile)> taken;
      std::size_t count = 0;
      for (int y = y0; y < std::min(y0 + kTile, settings.height_px); ++y) {
        const std::size_t row = std::size_t(y) * std::size_t(settings.width_px);
        const std::uint16_t* const pattern = kNoise.data() + y % kPattern * kPattern;
        for (int x = x0; x < std::min(x0 + kTile, settings.width_px); ++x) {
          const auto noise = std::uint16_t(pattern[x % kPattern] + shift);
          taken[count] = std::uint32_t(row) + std::uint32_t(x);
          count += noise < limit[wanted[row + std::size_t(x)]] ? 1 : 0;
        }
      }
      parts[part].insert(parts[part].end(), taken.begin(), taken.begin() + std::ptrdiff_t(count));
    }
  });
  plan.reserve(settings.count + settings.count / 8);
  for (const std::vector<std::uint32_t>& part : parts) {
    plan.insert(plan.end(), part.begin(), part.end());
  }
  return plan;
}

}  // namespace arris
