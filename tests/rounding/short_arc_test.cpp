// short_arc_test.cpp — where lines come to balls around arcs and leave them, against distances at many places
#include "rounding/short_arc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "support/convex_solids.h"

namespace arris::oracle {
namespace {

CreaseCurve random_arc(Random& rng) {
  CreaseCurve arc;
  arc.is_line = false;
  arc.center = random_direction(rng);
  arc.a = random_direction(rng) * std::pow(10, uniform(rng, -1, 0.5));
  arc.b = normalize(cross(arc.a, random_direction(rng))) * std::pow(10, uniform(rng, -1, 0.5));
  arc.u0 = uniform(rng, -kPi, kPi);
  arc.u1 = arc.u0 + radians(uniform(rng, 1, 20));
  return arc;
}

double distance_by_trial(const CreaseCurve& arc, Vec3d x) {
  constexpr int kSteps = 100;
  double least = INFINITY;
  for (int i = 0; i <= kSteps; ++i) {
    least = std::min(least, length(x - arc.at(arc.u0 + (arc.u1 - arc.u0) * i / kSteps)));
  }
  return least;
}

struct Within {
  double from, to;
};

std::vector<Within> spans_of(const ShortArc& arc, Vec3d x, Vec3d direction, double end, double r) {
  std::vector<Within> spans;
  double from = 0;
  while (const auto in = arc.enter(x, direction, from, end, r)) {
    spans.push_back({in->along, arc.leave(x, direction, in->along, r).along});
    from = spans.back().to + 1e-6 * r;
  }
  return spans;
}

// A line that nearly touches the balls.
struct Line {
  Vec3d x, direction;
};

Line line_beside(const CreaseCurve& arc, double r, Random& rng) {
  const Vec3d normal = random_direction(rng);
  const Vec3d direction = normalize(cross(normal, random_direction(rng)));
  const double lift = uniform(rng, -1, 1) * std::pow(10, uniform(rng, -4, 0));
  return {arc.at(uniform(rng, arc.u0, arc.u1)) + normal * (r * (1 - lift)), direction};
}

// On the side to which the arc bends, so that both ends are nearer than the middle.
Line line_within_bend(const CreaseCurve& arc, double r, Random& rng) {
  const double middle = 0.5 * (arc.u0 + arc.u1);
  const Vec3d inward = 0.5 * (arc.at(arc.u0) + arc.at(arc.u1)) - arc.at(middle);
  return {arc.at(middle) + inward * uniform(rng, 0, 0.5) + normalize(inward) * r,
          normalize(arc.derivative(middle))};
}

TEST(ShortArc, lines_are_within_balls_where_distances_say_so) {
  Random rng(17);
  int twice = 0, places = 0;
  for (int i = 0; i < 1500; ++i) {
    const CreaseCurve curve = random_arc(rng);
    const ShortArc arc(curve);
    const double r = std::pow(10, uniform(rng, -1, 0.5)), end = 4 * r;
    const auto [middle, beside] =
        i % 2 == 0 ? line_beside(curve, r, rng) : line_within_bend(curve, r, rng);
    const Vec3d x = middle - beside * (0.5 * end);
    const std::vector<Within> spans = spans_of(arc, x, beside, end, r);
    twice += spans.size() > 1 ? 1 : 0;
    constexpr int kPlaces = 400;
    for (int k = 0; k < kPlaces; ++k) {
      const double along = end * (k + 0.5) / kPlaces;
      const double d = distance_by_trial(curve, x + beside * along);
      if (std::abs(d - r) < 1e-5 * r + 1e-4 * (length(curve.a) + length(curve.b))) continue;
      const bool is_within = std::ranges::any_of(
          spans, [&](const Within& w) { return along >= w.from && along <= w.to; });
      ASSERT_EQ(is_within, d < r) << "line " << i << " at " << along << ", distance " << d / r;
      ++places;
    }
  }
  EXPECT_GT(places, 300'000);
  EXPECT_GT(twice, 10);
}

}  // namespace
}  // namespace arris::oracle
