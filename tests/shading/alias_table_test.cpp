#include "shading/alias_table.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace arris {
namespace {

// The table's own answer, counted over evenly spaced numbers, is the probability it states.
RC_GTEST_PROP(AliasTable, draws_in_proportion_to_the_weights, ()) {
  const auto raw =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1000)));
  const std::vector<float> weights(raw.begin(), raw.end());
  const AliasTable table = make_alias_table(weights);
  double sum = 0;
  for (const float w : weights) {
    sum += double(w);
  }
  constexpr int kNumbers = 20000;
  std::vector<int> counts(weights.size());
  for (int i = 0; i < kNumbers; ++i) {
    ++counts[sample_alias_table(table, (float(i) + 0.5F) / kNumbers)];
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = sum > 0 ? double(weights[i]) / sum : 1.0 / double(weights.size());
    RC_ASSERT(std::fabs(double(table.probability[i]) - expected) < 1e-6);
    RC_ASSERT(std::fabs(counts[i] / double(kNumbers) - expected) <
              2.0 * double(weights.size() + 1) / kNumbers);
    RC_ASSERT(sum == 0 || weights[i] > 0 || counts[i] == 0);
  }
}

TEST(AliasTable, the_largest_number_below_one_is_in_range) {
  const AliasTable table = make_alias_table(std::vector<float>{1, 2, 3, 4, 5, 6, 7});
  EXPECT_LT(sample_alias_table(table, 0x1.fffffep-1F), 7U);
  EXPECT_EQ(sample_alias_table(make_alias_table(std::vector<float>{0.5F}), 0.99F), 0U);
}

}  // namespace
}  // namespace arris
