// Three-valued values kept up to date against values from scratch.
#include "beam/cover_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "support/random_expression.h"

namespace arris::test {
namespace {

// Kleene's logic on -1, 0, 1: not is -a, or the maximum, and the minimum, exclusive or -ab.
Cover value_of(const CsgExpression& expression, const std::vector<Cover>& covers) {
  const auto number = [](Cover c) { return c == Cover::in ? 1 : c == Cover::out ? -1 : 0; };
  std::vector<int> stack;
  for (const CsgStep& step : expression.steps()) {
    using Kind = CsgStep::Kind;
    if (step.kind == Kind::leaf || step.kind == Kind::complement) {
      stack.push_back(number(covers[step.value]) * (step.kind == Kind::leaf ? 1 : -1));
      continue;
    }
    int most = -1, least = 1, odd = -1;
    for (std::uint32_t i = 0; i < step.value; ++i) {
      const int a = stack.back();
      stack.pop_back();
      most = std::max(most, a);
      least = std::min(least, a);
      odd = -odd * a;
    }
    stack.push_back(step.kind == Kind::unite       ? most
                    : step.kind == Kind::intersect ? least
                    : step.kind == Kind::odd       ? odd
                                                   : -odd);
  }
  return stack.back() > 0 ? Cover::in : stack.back() < 0 ? Cover::out : Cover::on;
}

TEST(cover_sweep, has_the_value_from_scratch_after_every_change) {
  CsgRandom random(1);
  std::array<int, 3> seen{};
  for (int i = 0; i < 400; ++i) {
    const CsgExpression expression = random_expression(random);
    if (expression.is_decided()) continue;
    const std::size_t count = expression.leaves().size();
    std::vector<Cover> covers(count, Cover::out);
    CoverSweep sweep(expression);
    ASSERT_EQ(sweep.value(), value_of(expression, covers)) << i;
    const bool few_open = i % 2 == 0;
    for (int k = 0; k < 60; ++k) {
      const auto slot = std::uint32_t(random() % count);
      covers[slot] = Cover(random() % (few_open && random() % 4 != 0 ? 2 : 3));
      sweep.set(slot, covers[slot]);
      ASSERT_EQ(sweep.value(), value_of(expression, covers)) << i << ", " << k;
      ++seen[std::size_t(sweep.value())];
    }
  }
  for (const int times : seen) EXPECT_GT(times, 2000);
}

TEST(cover_sweep, what_is_certain_holds_for_every_state_of_the_open_leaves) {
  CsgRandom random(2);
  int certain = 0;
  for (int i = 0; i < 1000; ++i) {
    const CsgExpression expression = random_expression(random);
    if (expression.is_decided()) continue;
    CoverSweep sweep(expression);
    std::vector<Cover> covers;
    for (std::uint32_t slot = 0; slot < expression.leaves().size(); ++slot) {
      covers.push_back(Cover(random() % 3));
      sweep.set(slot, covers[slot]);
    }
    if (sweep.value() == Cover::on) continue;
    ++certain;
    for (int k = 0; k < 20; ++k) {
      const std::uint64_t state = random();
      const bool value = expression.eval([&](std::uint32_t slot) {
        return covers[slot] == Cover::on ? (state >> (slot % 64) & 1U) != 0
                                         : covers[slot] == Cover::in;
      });
      ASSERT_EQ(value, sweep.value() == Cover::in) << i;
    }
  }
  EXPECT_GT(certain, 300);
}

}  // namespace
}  // namespace arris::test
