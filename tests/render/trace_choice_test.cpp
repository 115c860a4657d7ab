#include "render/trace_choice.h"

#include <gtest/gtest.h>

namespace arris::test {
namespace {

// 1,000 pixels of so many rays, 0.25 µs each.
ShadingCost cost_of_rays(std::uint64_t rays) {
  return {1000, 1000 * rays, 0};
}

TEST(TraceChoice, is_kept_until_frames_are_clearly_dearer) {
  TraceChoice choice(10, CostMeasure::rays);
  EXPECT_FALSE(choice.decide(1000, 0));  // nothing is known
  choice.add(cost_of_rays(48), 1);       // 12 ms
  EXPECT_FALSE(choice.decide(1000, 0));
  for (int i = 0; i < 40; ++i) choice.add(cost_of_rays(36), 1);  // 9 ms
  EXPECT_TRUE(choice.decide(1000, 0));
  for (int i = 0; i < 40; ++i) choice.add(cost_of_rays(48), 1);
  EXPECT_TRUE(choice.decide(1000, 0));
  for (int i = 0; i < 40; ++i) choice.add(cost_of_rays(64), 1);  // 16 ms
  EXPECT_FALSE(choice.decide(1000, 0));
  choice.add(cost_of_rays(48), 1);
  EXPECT_FALSE(choice.decide(1000, 0));
}

TEST(TraceChoice, by_seconds_looks_at_what_edges_and_points_take) {
  TraceChoice choice(10, CostMeasure::seconds);
  choice.add({1000, 0, 0.04}, 2);  // 20 ms
  EXPECT_FALSE(choice.decide(1000, 15));
  EXPECT_TRUE(choice.decide(1000, 25));
}

TEST(TraceChoice, is_never_made_without_a_limit) {
  TraceChoice choice(0, CostMeasure::seconds);
  choice.add({1000, 0, 1e-6}, 1);
  EXPECT_FALSE(choice.decide(1000, 100));
}

}  // namespace
}  // namespace arris::test
