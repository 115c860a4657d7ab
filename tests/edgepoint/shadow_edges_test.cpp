// Shadow edges lie where the light comes into view, and nowhere else.
#include "edgepoint/shadow_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "edgepoint/shadow_scene.h"

namespace arris {
namespace {

using test::FinderRandom;
using test::ShadowScene;
using test::uniform;

// A point on a face, and a way to look to the light from it.
struct FacePoint {
  const test::ShadowObject* object;
  std::size_t receiver, face;
  Vec3d normal;  // unit, outward in the world

  [[nodiscard]] static FacePoint of(const ShadowScene& scene, std::size_t receiver,
                                    std::size_t face) {
    const test::ShadowObject& o = *scene.objects[receiver];
    const auto& t = o.world[face];
    Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
    if (determinant(o.world_from_object.linear) < 0) n = -n;
    return {&o, receiver, face, n};
  }
  [[nodiscard]] bool faces(const HomogeneousPoint& light) const {
    return dot(normal, light.xyz - object->world[face][0] * light.w) > 0;
  }
};

bool lit(const ShadowScene& scene, const FacePoint& at, Vec3d p, const HomogeneousPoint& light) {
  return scene.sees(p + at.normal * 1e-7, light);
}

// The face of a receiver that a point lies on.
FacePoint face_below(const ShadowScene& scene, std::size_t receiver, Vec3d p) {
  const test::ShadowObject& o = *scene.objects[receiver];
  std::size_t best = 0;
  double nearest = 1e30;
  for (std::size_t f = 0; f < o.world.size(); ++f) {
    const auto& t = o.world[f];
    const Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
    double outside = std::abs(dot(n, p - t[0]));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d e = normalize(t[(k + 1) % 3] - t[k]);
      outside = std::max(outside, -dot(cross(n, e), p - t[k]));
    }
    if (outside < nearest) nearest = outside, best = f;
  }
  return FacePoint::of(scene, receiver, best);
}

struct Tally {
  int right = 0, all = 0;
};

// On both sides of each edge's middle: one sees the light and the other does not.
Tally count_changes(const ShadowScene& scene, const std::vector<ShadowEdge>& edges,
                    const HomogeneousPoint& light) {
  Tally tally;
  for (const ShadowEdge& e : edges) {
    const Vec3d a(e.a), b(e.b), middle = (a + b) * 0.5;
    if (length(b - a) < 1e-3) continue;
    const FacePoint at = face_below(scene, e.receiver, middle);
    const Vec3d step = normalize(cross(at.normal, b - a)) * 1e-4;
    ++tally.all;
    tally.right +=
        lit(scene, at, middle + step, light) != lit(scene, at, middle - step, light) ? 1 : 0;
  }
  return tally;
}

// Random pairs of points of faces that look to the light: where one of them sees it, the place between where this
// changes must be on an edge. Returns the greatest distance.
double farthest_change(const ShadowScene& scene, const std::vector<ShadowEdge>& edges,
                       const HomogeneousPoint& light, FinderRandom& random, int& changes) {
  double farthest = 0;
  for (std::size_t r = 0; r < scene.objects.size(); ++r) {
    for (std::size_t f = 0; f < scene.objects[r]->world.size(); ++f) {
      const FacePoint at = FacePoint::of(scene, r, f);
      if (!at.faces(light)) continue;
      const auto& t = scene.objects[r]->world[f];
      const auto point = [&] {
        double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
      };
      const int pairs = r == 0 ? 300 : 6;
      for (int i = 0; i < pairs; ++i) {
        Vec3d p = point(), q = point();
        const bool p_lit = lit(scene, at, p, light);
        if (p_lit == lit(scene, at, q, light)) continue;
        for (int k = 0; k < 30; ++k) {
          const Vec3d m = (p + q) * 0.5;
          (lit(scene, at, m, light) == p_lit ? p : q) = m;
        }
        ++changes;
        farthest = std::max(farthest, test::distance_to_edges(p, edges, r));
      }
    }
  }
  return farthest;
}

TEST(ShadowEdges, lie_where_visibility_changes) {
  Tally all;
  int changes = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    FinderRandom random(seed);
    const ShadowScene scene = test::random_shadow_scene(random);
    HomogeneousPoint light{{uniform(random, -2, 2), uniform(random, -2, 2), 9}, 1};
    if (seed % 3 == 0) light = {{uniform(random, -1, 1), uniform(random, -1, 1), 2}, 0};
    const std::vector<ShadowEdge> edges = scene.all_shadow_edges(light);
    const Tally tally = count_changes(scene, edges, light);
    all.right += tally.right;
    all.all += tally.all;
    EXPECT_LT(farthest_change(scene, edges, light, random, changes), 2e-5) << seed;
  }
  EXPECT_GT(changes, 500);
  EXPECT_GT(all.all, 500);
  std::printf("%d of %d, %d changes\n", all.right, all.all, changes);
  EXPECT_GE(all.right, 0.99 * all.all);
}

}  // namespace
}  // namespace arris
