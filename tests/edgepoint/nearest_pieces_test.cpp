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

template <class Piece>
double nearest_at(const std::vector<Piece>& pieces, double s) {
  double best = kNobody;
  for (const Piece& p : pieces) {
    if (p.s0 <= s && s <= p.s1) best = std::max(best, p.nearness(s));
  }
  return best;
}

TEST(NearestPieces, keeps_the_nearest_everywhere) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 300; ++round) {
    std::vector<EventSegment> all;
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
  nearest.assign({});
  EXPECT_EQ(nearest.least_nearness(), kNobody);
}

TEST(NearestPieces, say_whether_a_segment_shows) {
  NearestPieces nearest;
  EXPECT_TRUE(nearest.insert({0, 1, 2, 2, 0, 7}));
  EXPECT_FALSE(nearest.insert({0.2, 0.8, 1, 1, 1, 8}));
  EXPECT_TRUE(nearest.insert({0.2, 0.8, 1, 3, 2, 9}));
  ASSERT_EQ(nearest.pieces().size(), 3U);
  EXPECT_EQ(nearest.pieces()[1].of.face, 9U);
  EXPECT_EQ(nearest.pieces()[2].of.face, 7U);
}

TEST(NearestPieces, do_not_depend_on_the_order_of_segments) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 2000; ++round) {
    std::vector<EventSegment> all;
    const auto count = std::uint32_t(2 + random() % 12);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double s0 = !all.empty() && i % 3 == 0 ? all.back().s1 : unit(random);
      const auto [low, high] = std::minmax({s0, unit(random)});
      if (low == high) continue;
      all.push_back({low, high, unit(random), unit(random), i, 0});
      // The same surface twice.
      if (i % 4 == 1) all.push_back({low, high, all.back().k0, all.back().k1, i, 1});
    }
    NearestPieces first;
    for (const EventSegment& s : all) first.insert(s);
    for (int again = 0; again < 3; ++again) {
      std::ranges::shuffle(all, random);
      NearestPieces shuffled, halfway;
      for (std::size_t i = 0; i < all.size() / 2; ++i) halfway.insert(all[i]);
      shuffled.assign(halfway.pieces());
      for (std::size_t i = all.size() / 2; i < all.size(); ++i) shuffled.insert(all[i]);
      ASSERT_EQ(shuffled.pieces(), first.pieces());
      ASSERT_EQ(shuffled.least_nearness(), first.least_nearness());
    }
  }
}

}  // namespace
}  // namespace arris
