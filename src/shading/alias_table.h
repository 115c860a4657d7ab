// alias_table.h — draws an index in proportion to its weight, in constant time
// Source     M. Vose, "A linear algorithm for generating random numbers with a given distribution",
//            IEEE Transactions on Software Engineering 17(9), 1991
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace arris {

struct AliasTable {
  struct Bin {
    float threshold;  // below: the bin's own index, else the alias
    std::uint32_t alias;
  };
  std::vector<Bin> bins;
  std::vector<float> probability;
};

// weights: not negative, finite. If all are zero, all are equally probable.
AliasTable make_alias_table(std::span<const float> weights);

// u in [0, 1). Precondition: the table is not empty.
inline std::uint32_t sample_alias_table(const AliasTable& table, float u) {
  const auto count = std::uint32_t(table.bins.size());
  if (count == 1) {
    return 0;
  }
  const float scaled = u * float(count);
  const auto drawn = std::uint32_t(scaled);
  const std::uint32_t bin = drawn < count ? drawn : count - 1;
  return scaled - float(bin) < table.bins[bin].threshold ? bin : table.bins[bin].alias;
}

}  // namespace arris
