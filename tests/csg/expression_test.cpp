// Parities, and what pruning makes of them.
#include "csg/csg_expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "support/random_expression.h"

namespace arris::test {
namespace {

using Kind = CsgStep::Kind;

// By leaf of the tree.
using State = std::map<std::uint32_t, bool>;

bool value_in(const CsgExpression& expression, State& state) {
  return expression.eval([&](std::uint32_t slot) { return state[expression.leaves()[slot]]; });
}
State random_state(CsgRandom& random, const CsgExpression& expression) {
  State state;
  for (const std::uint32_t leaf : expression.leaves()) state[leaf] = random() % 2 == 0;
  return state;
}

// The one operation of a difference or union of two leaves, of which the second is a volume.
CsgExpression two_leaves(CsgOperation operation, const std::vector<std::uint32_t>& parts) {
  const CsgTree tree = flat_tree(operation, {{}, {}});
  return CsgExpression(tree, {true, true}).with_parities({{1, parts}});
}

TEST(csg_expression, parities_hold_where_an_odd_number_of_their_parts_does) {
  CsgRandom random(1);
  std::array<int, 2> seen{};
  for (int i = 0; i < 500; ++i) {
    const CsgExpression plain = random_boolean_expression(random, 10);
    const Volumes volumes = random_volumes(random, plain);
    const CsgExpression replaced = plain.with_parities(volumes);
    ASSERT_EQ(replaced.is_decided(), plain.is_decided());
    ASSERT_TRUE(std::ranges::is_sorted(replaced.leaves()));
    for (int k = 0; k < 20; ++k) {
      State parts = random_state(random, replaced), leaves;
      for (const std::uint32_t leaf : plain.leaves()) {
        const auto volume = volumes.find(leaf);
        if (volume == volumes.end()) {
          leaves[leaf] = parts[leaf];
          continue;
        }
        const auto inside =
            std::ranges::count_if(volume->second, [&](std::uint32_t part) { return parts[part]; });
        leaves[leaf] = inside % 2 == 1;
      }
      ASSERT_EQ(value_in(replaced, parts), value_in(plain, leaves)) << i << ", " << k;
      ++seen[value_in(plain, leaves) ? 1 : 0];
    }
  }
  EXPECT_GT(seen[0], 2000);
  EXPECT_GT(seen[1], 2000);
}

TEST(csg_expression, volumes_that_are_taken_away_become_even) {
  const CsgExpression cut = two_leaves(CsgOperation::subtract, {7, 5, 9});
  EXPECT_EQ(cut.leaves(), (std::vector<std::uint32_t>{0, 5, 7, 9}));
  ASSERT_EQ(cut.steps().size(), 6U);
  EXPECT_EQ(cut.steps()[4].kind, Kind::even);
  EXPECT_EQ(cut.steps()[4].value, 3U);
  EXPECT_EQ(two_leaves(CsgOperation::unite, {7, 5, 9}).steps()[4].kind, Kind::odd);
  EXPECT_EQ(cut.depth(), 2U);
}

TEST(csg_expression, pruning_keeps_the_value_of_parities) {
  CsgRandom random(2);
  int shorter = 0, decided = 0;
  for (int i = 0; i < 1500; ++i) {
    const CsgExpression whole = random_expression(random);
    std::vector<Cover> covers;
    for (std::size_t k = 0; k < whole.leaves().size(); ++k) {
      covers.push_back(random() % 3 == 0 ? Cover::on : Cover(random() % 2));
    }
    const CsgExpression pruned = whole.prune(covers);
    decided += pruned.is_decided() ? 1 : 0;
    shorter += pruned.steps().size() < whole.steps().size() ? 1 : 0;
    for (const std::uint32_t leaf : pruned.leaves()) {
      const auto at = std::ranges::find(whole.leaves(), leaf);
      ASSERT_NE(at, whole.leaves().end());
      ASSERT_EQ(covers[std::size_t(at - whole.leaves().begin())], Cover::on) << i;
    }
    for (int k = 0; k < 8; ++k) {
      State state = random_state(random, whole);
      for (std::size_t slot = 0; slot < covers.size(); ++slot) {
        if (covers[slot] != Cover::on) state[whole.leaves()[slot]] = covers[slot] == Cover::in;
      }
      ASSERT_EQ(value_in(pruned, state), value_in(whole, state)) << i;
    }
  }
  EXPECT_GT(shorter, 1000);
  EXPECT_GT(decided, 300);
  EXPECT_LT(decided, 1300);
}

TEST(csg_expression, a_parity_of_which_one_part_is_left_is_that_part_or_its_complement) {
  const CsgExpression odd = two_leaves(CsgOperation::intersect, {5, 7});
  const auto left_of = [](const CsgExpression& expression, Cover first) {
    const CsgExpression pruned = expression.prune(std::vector<Cover>{Cover::in, first, Cover::on});
    EXPECT_EQ(pruned.leaves(), std::vector<std::uint32_t>{7});
    return pruned.steps()[0].kind;
  };
  EXPECT_EQ(left_of(odd, Cover::out), Kind::leaf);
  EXPECT_EQ(left_of(odd, Cover::in), Kind::complement);
  const CsgExpression even = two_leaves(CsgOperation::subtract, {5, 7});
  EXPECT_EQ(left_of(even, Cover::out), Kind::complement);
  EXPECT_EQ(left_of(even, Cover::in), Kind::leaf);
}

TEST(csg_expression, bounds_hold_the_points_of_parities) {
  CsgRandom random(3);
  int inside = 0, bounded = 0;
  for (int i = 0; i < 1500; ++i) {
    const CsgExpression expression = random_expression(random);
    std::vector<Box3d> boxes;
    for (std::size_t k = 0; k < expression.leaves().size(); ++k) {
      const Vec3d middle = random_vector(random, 1);
      boxes.push_back({middle - Vec3d(uniform(random, 0.1, 1.5)), middle + Vec3d(1)});
    }
    const Box3d bounds = expression.bounds(boxes);
    bounded += !bounds.is_empty() && is_finite(bounds.low) && is_finite(bounds.high) ? 1 : 0;
    const auto holds = [](const Box3d& box, Vec3d p) {
      return !intersection(box, {p, p}).is_empty();
    };
    for (int k = 0; k < 10; ++k) {
      const Vec3d p = random_vector(random, 1.2);
      // A leaf may be anything in its box.
      const bool in = expression.eval([&](std::uint32_t slot) {
        return holds(boxes[slot], p) && (slot + std::uint32_t(k)) % 4 != 0;
      });
      ASSERT_TRUE(!in || holds(bounds, p)) << i;
      inside += in ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(bounded, 300);
}

}  // namespace
}  // namespace arris::test
