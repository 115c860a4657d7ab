#include "shading/alias_table.h"

#include <algorithm>
#include <cstddef>

namespace arris {

AliasTable make_alias_table(std::span<const float> weights) {
  const std::size_t count = weights.size();
  double sum = 0;
  for (const float w : weights) {
    sum += double(w);
  }
  std::vector<double> scaled(count);  // mean 1
  AliasTable table;
  table.bins.resize(count);
  table.probability.resize(count);
  std::vector<std::uint32_t> small;
  std::vector<std::uint32_t> large;
  for (std::size_t i = 0; i < count; ++i) {
    const double probability = sum > 0 ? double(weights[i]) / sum : 1.0 / double(count);
    table.probability[i] = float(probability);
    scaled[i] = probability * double(count);
    (scaled[i] < 1.0 ? small : large).push_back(std::uint32_t(i));
  }
  // Fill each poor bin up from a rich one.
  while (!small.empty() && !large.empty()) {
    const std::uint32_t poor = small.back();
    const std::uint32_t rich = large.back();
    small.pop_back();
    table.bins[poor] = {float(scaled[poor]), rich};
    scaled[rich] -= 1.0 - scaled[poor];
    if (scaled[rich] < 1.0) {
      large.pop_back();
      small.push_back(rich);
    }
  }
  // What is left is full but for rounding; what has no weight stays impossible.
  const auto heaviest =
      std::uint32_t(std::ranges::max_element(table.probability) - table.probability.begin());
  for (const std::vector<std::uint32_t>& rest : {large, small}) {
    for (const std::uint32_t i : rest) {
      table.bins[i] = {table.probability[i] > 0.0F ? 1.0F : 0.0F, heaviest};
    }
  }
  return table;
}

}  // namespace arris
