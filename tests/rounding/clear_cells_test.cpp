// clear_cells_test.cpp — in cells that are clear all is kept, and much of what is kept in bands lies in them
#include "rounding/clear_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

// A plate with a round hole of many facets, whose triangles are fans to its rim.
TriangleSoup plate_with_hole(int facets) {
  TriangleSoup mesh{"plate", {}, {}};
  const auto n = std::uint32_t(facets);
  for (const float z : {0.0F, 1.0F}) {
    for (const auto& [radius, corner] : {std::pair(10.0, true), {2.0, false}}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const double a = 2 * kPi * (i + 0.5) / n;
        const double r =
            corner ? radius / std::max(std::abs(std::cos(a)), std::abs(std::sin(a))) : radius;
        mesh.positions.push_back({float(r * std::cos(a)), float(r * std::sin(a)), z});
      }
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    quad(j, i, n + i, n + j);
    quad(2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i);
    quad(i, j, 2 * n + j, 2 * n + i);
    quad(n + j, n + i, 3 * n + i, 3 * n + j);
  }
  return mesh;
}

struct Tally {
  int kept = 0, clear = 0, wrong = 0;  // of hits in bands
};

Tally look(const TriangleSoup& mesh, double radius, int count) {
  RoundingOptions options;
  options.radius = radius;
  options.too_large = TooLarge::leave_sharp;
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  const Rounding::Data& data = rounding.data();
  Tally tally;
  Random rng(3);
  for (int i = 0; i < count; ++i) {
    const auto t = std::uint32_t(uniform_int(rng, 0, int(mesh.triangles.size()) - 1));
    double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const std::uint32_t face = data.face[t];
    const Solid& solid = data.solids[data.faces[face].solid];
    if (solid.creased == kNone || rounding.is_kept(t, u, v)) continue;
    const CreasedSolid& creased = *data.creased[solid.creased];
    const auto at = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.triangles[t][k]]); };
    const Vec3d x = at(0) + (at(1) - at(0)) * u + (at(2) - at(0)) * v - solid.center;
    const Vec3d normal(data.faces[face].normal);
    tally.kept += creased.is_kept(x, normal, face) ? 1 : 0;
    if (!creased.clear.is_clear(t, u, v)) continue;
    ++tally.clear;
    tally.wrong += creased.surface.is_near(x - normal * radius, radius, face) ? 1 : 0;
  }
  return tally;
}

TEST(ClearCells, hold_nothing_that_rounding_takes_away) {
  Tally all;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random rng(seed);
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      const Tally tally = look(mesh, std::pow(10, uniform(rng, -3, -1)) * mesh.size(), 2000);
      all.clear += tally.clear;
      all.wrong += tally.wrong;
    }
  }
  EXPECT_GT(all.clear, 1000);
  EXPECT_EQ(all.wrong, 0);
}

// Its notches' bottoms bound what is taken from triangles that reach far beyond them.
TEST(ClearCells, spare_searches_of_large_triangles) {
  const Outline notched{{0, 0}, {10, 0}, {10, 4}, {8, 4},   {8, 1}, {7, 1.5},
                        {7, 4}, {3, 4},  {3, 1},  {2, 0.7}, {2, 4}, {0, 4}};
  const Tally tally = look(prism_over("notched plate", notched, {}), 0.15, 20000);
  EXPECT_GT(tally.kept, 1000);
  EXPECT_GT(tally.clear * 3, tally.kept);
  EXPECT_EQ(tally.wrong, 0);
}

// What is left of facets at a rim is told by bands.
TEST(ClearCells, are_not_needed_along_a_rim_of_facets) {
  const Tally tally = look(plate_with_hole(64), 0.3, 20000);
  EXPECT_LT(tally.kept, 1000);
}

}  // namespace
}  // namespace arris::oracle
