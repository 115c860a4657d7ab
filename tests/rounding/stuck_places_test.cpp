// stuck_places_test.cpp — what is remembered of places where balls get stuck is what would be found there
#include "rounding/stuck_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "arris/rounding.h"
#include "rounding/growing_ball.h"
#include "rounding/rounding_data.h"
#include "rounding/thin_walls.h"
#include "support/creased_solids.h"

namespace arris::oracle {
namespace {

struct Tally {
  int places = 0, stuck = 0, wrong = 0;
};

void compare(const TriangleSoup& mesh, double radius, Random& rng, Tally& tally) {
  SCOPED_TRACE(mesh.name);
  RoundingOptions options;
  options.radius = radius;
  options.min_angle = radians(5);
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  ASSERT_EQ(rounding.data().creased.size(), 1U);
  const CreasedSolid& solid = *rounding.data().creased[0];
  const auto& triangles = solid.surface.triangles();
  for (int i = 0; i < 20000; ++i) {
    const SurfaceTriangle& t =
        triangles[std::size_t(uniform_int(rng, 0, int(triangles.size()) - 1))];
    double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3d x = t.p0 + (t.p1 - t.p0) * u + (t.p2 - t.p0) * v, normal = normal_of(t);
    if (solid.is_kept(x, normal, t.region) &&
        !solid.surface.is_near(x - normal * radius, radius - solid.tolerance, t.region)) {
      continue;  // a ball fits
    }
    if (solid.surface.is_firm(t.region)) continue;
    const bool is_stuck = is_between_walls(solid.surface, x - normal * radius, 2 * radius) &&
                          gets_stuck(solid.surface, x, normal, t.region, radius - solid.tolerance);
    // A normal that was computed in another way.
    const auto turned = [](double c) { return c == 0 ? -0.0 : c; };
    const Vec3d same(turned(normal.x), turned(normal.y), turned(normal.z));
    ++tally.places;
    tally.stuck += is_stuck ? 1 : 0;
    tally.wrong += solid.stays(x, i % 2 == 0 ? normal : same, t.region, radius) == is_stuck ? 0 : 1;
  }
}

// A prism over an outline of ribs, tapered and not, thinner than the ball and thicker, with slots between.
TEST(StuckPlaces, are_what_is_found_in_the_place_itself) {
  Random rng(11);
  Tally tally;
  for (int k = 0; k < 6; ++k) {
    Outline outline{{0, 0}, {10, 0}, {10, 1}};
    for (double x = 9; x > 1; x -= 2) {
      const double foot = uniform(rng, 0.1, 0.9), tip = uniform(rng, 0.3, 1) * foot;
      const double top = uniform(rng, 1.3, 4);
      outline.insert(
          outline.end(),
          {{x + 0.5 * foot, 1}, {x + 0.5 * tip, top}, {x - 0.5 * tip, top}, {x - 0.5 * foot, 1}});
    }
    outline.emplace_back(0, 1);
    compare(prism_over("ribs", outline, {uniform(rng, 1, 4), 1, 0}), uniform(rng, 0.1, 0.4), rng,
            tally);
  }
  EXPECT_GT(tally.stuck, 500);
  EXPECT_GT(tally.places - tally.stuck, 300);
  // Within a cell of a border that its corners don't see: 1 in 15,000 measured, 1 in 4,500 if cells of two frames are
  // one.
  EXPECT_LE(6000 * tally.wrong, tally.places)
      << tally.wrong << " of " << tally.places << " stuck " << tally.stuck;
}

}  // namespace
}  // namespace arris::oracle
