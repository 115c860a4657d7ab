// interleaved.h — times several variants of a scene against each other
// What       renders every variant once per round, forwards in even and backwards in odd rounds, so that a slow
//            spell of the machine meets all of them; ratios pair renders of one round
// Cost       all variants are in memory at once
#pragma once

#include <algorithm>
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
  std::vector<double> seconds;  // one per round
  RayCounts rays;
};

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 != 0 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Median over the rounds of the time over that of `base` in the same round.
inline double median_ratio(const Timing& timing, const Timing& base) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < timing.seconds.size(); ++i)
    ratios.push_back(timing.seconds[i] / base.seconds[i]);
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
      const RenderResult result = renderer->render(*variants[i].prepared, options.render);
      timings[i].seconds.push_back(result.seconds);
      timings[i].rays = result.rays;
      if (round == 0 && options.on_picture) options.on_picture(variants[i], result);
    }
  return timings;
}

}  // namespace arris::bench
