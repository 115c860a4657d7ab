// interleaved.h — times several variants of a scene against each other
// What       renders every variant once per round, forwards in even and backwards in odd rounds, so that a slow
//            spell of the machine meets all of them; ratios pair renders of one round
// Cost       all variants are in memory at once
#pragma once

#include <algorithm>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arris/render.h"

namespace arris::bench {

struct Variant {
  std::string name;
  std::shared_ptr<const PreparedScene> prepared;
};

struct Timing {
  std::vector<double> seconds;      // one per round
  std::vector<double> cpu_seconds;  // of all threads: tells more than the clock on a busy machine
  RayCounts rays;
};

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 != 0 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Median over the rounds of a time over that of `base` in the same round.
inline double median_ratio(const std::vector<double>& seconds, const std::vector<double>& base) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < seconds.size(); ++i) ratios.push_back(seconds[i] / base[i]);
  return median(ratios);
}

struct InterleavedOptions {
  RenderOptions render;
  int rounds = 3;
  // Called with every picture of the first round; may be empty.
  std::function<void(const Variant&, const RenderResult&)> on_picture;
};

inline std::vector<Timing> render_interleaved(const std::vector<Variant>& variants,
                                              const InterleavedOptions& options) {
  const auto renderer = make_path_renderer();
  std::vector<Timing> timings(variants.size());
  for (int round = 0; round < options.rounds; ++round)
    for (std::size_t k = 0; k < variants.size(); ++k) {
      const std::size_t i = round % 2 == 0 ? k : variants.size() - 1 - k;
      const std::clock_t start = std::clock();
      const RenderResult result = renderer->render(*variants[i].prepared, options.render);
      timings[i].cpu_seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC);
      timings[i].seconds.push_back(result.seconds);
      timings[i].rays = result.rays;
      if (round == 0 && options.on_picture) options.on_picture(variants[i], result);
    }
  return timings;
}

}  // namespace arris::bench
