// near_triangles_test.cpp — bounds and lists of what is near a triangle hold all that a search finds
#include "rounding/near_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/creased_solids.h"
#include "support/surface_of.h"

namespace arris::oracle {
namespace {

struct Tally {
  int taken = 0, unbounded = 0, unlisted = 0, lists = 0;
};

// Places of a triangle from which a ball reaches into another one, by more than rounding errors.
void look(const SolidSurface& surface, const SurfaceTriangle& t, double radius, Random& rng,
          Tally& tally) {
  const Vec3d normal = normalize(cross(t.p1 - t.p0, t.p2 - t.p0));
  const NearTriangles near = find_near_triangles(surface, t, normal, radius);
  if (near.others) ++tally.lists;
  for (int i = 0; i < 40; ++i) {
    double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3d center = t.p0 + (t.p1 - t.p0) * u + (t.p2 - t.p0) * v - normal * radius;
    const double reach = (1 - 1e-6) * radius;
    if (!surface.is_near(center, reach, t.region)) continue;
    ++tally.taken;
    const auto holds = [&](const DepthAtCorners& d) {
      return d.d0 + (d.d1 - d.d0) * u + (d.d2 - d.d0) * v > 0;
    };
    if (std::none_of(near.depths.begin(), near.depths.end(), holds)) ++tally.unbounded;
    if (near.others && !surface.is_one_near(*near.others, center, reach, t.region)) {
      ++tally.unlisted;
    }
  }
}

TEST(NearTriangles, hold_all_that_balls_reach_into) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random rng(seed);
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      for (const double part : {0.003, 0.01, 0.05}) {
        const double radius = part * mesh.size();
        const SolidSurface surface = surface_of(mesh, radius);
        for (const SurfaceTriangle& t : surface.triangles()) {
          look(surface, t, radius, rng, tally);
        }
      }
    }
  }
  EXPECT_GT(tally.taken, 10000);
  EXPECT_GT(tally.lists, 1000);
  EXPECT_EQ(tally.unbounded, 0);
  EXPECT_EQ(tally.unlisted, 0);
}

}  // namespace
}  // namespace arris::oracle
