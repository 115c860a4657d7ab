// Pieces along an event: the nearest at each place.
#include "edgepoint/nearest_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace arris {
namespace {

constexpr double kNobody = -std::numeric_limits<double>::infinity();

double nearest_at(const std::vector<EventPiece>& pieces, double s) {
  double best = kNobody;
  for (const EventPiece& p : pieces) {
    if (p.s0 <= s && s <= p.s1) best = std::max(best, p.nearness(s));
  }
  return best;
}

TEST(NearestPieces, keeps_the_nearest_everywhere) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 300; ++round) {
    std::vector<EventPiece> all;
    NearestPieces nearest;
    const int count = 1 + int(random() % 20);
    for (int i = 0; i < count; ++i) {
      // Some begin where others end, some are equal.
      const double s0 = !all.empty() && i % 3 == 0 ? all.back().s1 : unit(random);
      const double s1 = i % 5 == 1 ? 1 : unit(random);
      if (s0 == s1) continue;
      all.push_back(
          {std::min(s0, s1), std::max(s0, s1), unit(random), unit(random), std::uint32_t(i), 0});
      if (i % 7 == 2) all.back().k1 = all.back().k0 = 0.5;
      nearest.insert(all.back());
    }
    for (std::size_t i = 1; i < nearest.pieces().size(); ++i) {
      ASSERT_LE(nearest.pieces()[i - 1].s1, nearest.pieces()[i].s0);
    }
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 200; ++k) {
      const double s = unit(random), expected = nearest_at(all, s);
      const double found = nearest_at(nearest.pieces(), s);
      least = std::min(least, expected);
      if (expected == kNobody) {
        ASSERT_EQ(found, kNobody);
      } else {
        ASSERT_NEAR(found, expected, 1e-9);
      }
    }
    ASSERT_LE(nearest.least_nearness(), least + 1e-9);
  }
}

TEST(NearestPieces, knows_what_is_covered) {
  NearestPieces nearest;
  nearest.insert({0, 0.5, 1, 2, 0, 0});
  EXPECT_EQ(nearest.least_nearness(), kNobody);
  nearest.insert({0.5, 1, 3, 4, 1, 0});
  EXPECT_EQ(nearest.least_nearness(), 1);
  nearest.insert({0, 1, 5, 6, 2, 0});
  EXPECT_EQ(nearest.least_nearness(), 5);
  EXPECT_EQ(nearest.pieces().size(), 1U);
  nearest.clear();
  EXPECT_EQ(nearest.least_nearness(), kNobody);
}

}  // namespace
}  // namespace arris
