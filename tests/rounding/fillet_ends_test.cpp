// fillet_ends_test.cpp — where fillets end at the rims of grooves, beside facets
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rounding/equidistant_curve.h"
#include "support/convex_solids.h"
#include "support/creased_solids.h"
#include "support/fillet_shooter.h"

namespace arris::oracle {
namespace {

double distance_to(const EdgeLine& line, Vec3d x) {
  const Vec3d w = x - line.point;
  return length(w - line.direction * dot(line.direction, w));
}

// Edges askew, nearly parallel, and corners.
TEST(EquidistantCurve, arcs_are_as_far_from_both) {
  Random rng(3);
  constexpr double kRadius = 0.7, kTolerance = 1e-7;
  int arcs = 0, found = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3d d = random_direction(rng), from = normalize(cross(d, random_direction(rng)));
    const double turn = uniform(rng, 0.001, 3);
    const Vec3d to = from * std::cos(turn) + cross(d, from) * std::sin(turn);
    const CylinderPart part{{random_direction(rng), d}, uniform(rng, 0.1, 3), from, to};
    EdgeLine other{part.axis.point + random_direction(rng) * uniform(rng, 0.1, 1.6), {}};
    if (i % 3 != 0) other.direction = random_direction(rng);
    if (i % 6 == 1) {
      const double lean = std::pow(10, uniform(rng, -7, -1));
      other.direction = normalize(d + random_direction(rng) * lean);
    }
    const auto curves = equidistant_curves(part, other, kRadius, kTolerance);
    found += curves.empty() ? 0 : 1;
    for (const CreaseCurve& curve : curves) {
      ++arcs;
      for (int k = 0; k <= 8; ++k) {
        const Vec3d x = curve.at(curve.u0 + (curve.u1 - curve.u0) * k / 8);
        EXPECT_NEAR(distance_to(part.axis, x), kRadius, 2 * kTolerance) << i;
        EXPECT_NEAR(distance_to(other, x), kRadius, 2 * kTolerance) << i;
      }
    }
    // All of it: places of the cylinder's part that are as far from the other, found by steps.
    for (int k = 0; k < 200; ++k) {
      const double theta = turn * uniform(rng, 0, 1);
      const Vec3d out = from * std::cos(theta) + cross(d, from) * std::sin(theta);
      const auto at = [&](double s) { return part.axis.point + d * s + out * kRadius; };
      constexpr double kStep = 0.05;
      for (double s = 0; s + kStep < part.length; s += kStep) {
        double low = s, high = s + kStep;
        const bool is_near = distance_to(other, at(low)) < kRadius;
        if (is_near == (distance_to(other, at(high)) < kRadius)) continue;
        for (int h = 0; h < 40; ++h) {
          const double middle = 0.5 * (low + high);
          ((distance_to(other, at(middle)) < kRadius) == is_near ? low : high) = middle;
        }
        double least = INFINITY;
        for (const CreaseCurve& curve : curves) {
          least = std::min(least, length(curve.at(nearest_parameter(curve, at(low))) - at(low)));
        }
        EXPECT_LT(least, 1e-5) << i;
      }
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_LT(arcs, 100 * found);
}

// A corner of a groove at the origin, upright, whose walls turn away in facets; the top leans to both sides of a ridge.
TriangleSoup faceted_groove(double opening, double facet, double turn, double slope) {
  std::vector<Vec3d> ring{{0, 0, 0}};
  const auto add_wall = [&](double angle, double side) {
    std::vector<Vec3d> wall;
    Vec3d p;
    const int facets = std::min(6, int(1.2 / turn));  // all are seen from the corner
    for (int i = 0; i < facets; ++i, angle -= side * turn) {
      p += Vec3d(std::cos(angle), std::sin(angle), 0) * (i + 1 < facets ? facet : 2);
      wall.push_back(p);
    }
    return wall;
  };
  const std::vector<Vec3d> right = add_wall(0, 1), left = add_wall(opening, -1);
  ring.insert(ring.end(), right.begin(), right.end());
  const double low = right.back().y - 2, far = std::min(left.back().x, 0.0) - 2;
  ring.push_back({right.back().x, low, 0});
  ring.push_back({far, low, 0});
  ring.push_back({far, left.back().y, 0});
  ring.insert(ring.end(), left.rbegin(), left.rend());
  const auto count = std::uint32_t(ring.size()), corner = std::uint32_t(right.size() + 2);
  const Vec3d ridge = normalize(ring[corner]);
  TriangleSoup mesh{fmt::format("groove {:.2f} {:.2f} {:.2f}", opening, turn, slope), {}, {}};
  for (const bool is_top : {false, true}) {
    for (const Vec3d p : ring) {
      const double z = is_top ? 2 - slope * std::abs(cross(ridge, p).z) : -2;
      mesh.positions.push_back({float(p.x), float(p.y), float(z)});
    }
  }
  for (std::uint32_t i = 1; i + 1 < count; ++i) {
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({count, count + i + 1, count + i});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    mesh.triangles.push_back({j, i, count + i});
    mesh.triangles.push_back({j, count + i, count + j});
  }
  return mesh;
}

TEST(FilletEnds, at_rims_of_facets_agree_with_the_balls) {
  FilletTally tally;
  Random rng(5);
  for (const double turn : {3.0, 12.0, 25.0}) {
    for (const double slope : {0.0, 0.25}) {
      for (const double opening : {80.0, 115.0}) {
        const CreasedCase groove{faceted_groove(radians(opening), 0.2, radians(turn), slope), 0.5};
        for (const RoundEdges edges : {RoundEdges::concave, RoundEdges::both}) {
          SCOPED_TRACE(groove.mesh.name);
          FilletShooter shooter(groove, edges, 7);
          for (int i = 0; i < 100; ++i) {
            const Vec3d target(uniform(rng, -0.1, 0.8), uniform(rng, -0.1, 0.8),
                               uniform(rng, 1.2, 2.1));
            const Vec3d d = random_direction(rng);
            const Ray ray{target - d * (20 * groove.radius), d};
            const auto hit = trace(ray, shooter.object());
            EXPECT_TRUE(!hit || dot(hit->normal, d) < 1e-3) << i;
            if (i % 4 == 0) shooter.judge(ray, tally);
          }
        }
      }
    }
  }
  EXPECT_GT(tally.fillets, 60);
  EXPECT_LE(300 * tally.wrong, tally.rays) << fmt::format("{}", fmt::join(tally.examples, "\n"));
}

}  // namespace
}  // namespace arris::oracle
