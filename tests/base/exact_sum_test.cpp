#include "base/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace arris {
namespace {

TEST(ExactSum, does_not_depend_on_order_or_grouping) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-80, 40);
  std::vector<float> samples(1000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = std::exp2(exponent(random)) * (i % 3 == 0 ? -1.0F : 1.0F);
  }
  ExactSum forward;
  for (const float sample : samples) forward.add(sample);
  for (int i = 0; i < 10; ++i) {
    std::shuffle(samples.begin(), samples.end(), random);
    ExactSum first, second;
    for (std::size_t k = 0; k < samples.size(); ++k) (k < 377 ? first : second).add(samples[k]);
    second.add(first);
    EXPECT_TRUE(second == forward);
  }
}

TEST(ExactSum, keeps_small_samples_beside_large_ones) {
  ExactSum sum;
  sum.add(1e9F);
  for (int i = 0; i < 1000; ++i) sum.add(0x1p-30F);
  sum.add(-1e9F);
  EXPECT_EQ(sum.value(), 1000 * 0x1p-30);
}

TEST(ExactSum, counts_a_sample_for_at_most_its_limit) {
  ExactSum sum;
  sum.add(3e38F);
  EXPECT_EQ(sum.value(), ExactSum::kLargest);
}

}  // namespace
}  // namespace arris
