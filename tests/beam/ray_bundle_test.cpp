#include "beam/ray_bundle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

Vec3i ranges_at(const ModelVec& v, double x, double y) {
  const auto at = [&](const TaylorModel& a) { return range_over(Quadratic(a), {x, y, x, y}); };
  return {at(v.x), at(v.y), at(v.z)};
}

// Rays are equal but for their length.
void expect_holds(const RayBundle& bundle, double u, double v, Vec3d origin, Vec3d direction) {
  const Vec3i o = ranges_at(bundle.origin, u, v), d = ranges_at(bundle.direction, u, v);
  const double slack = 1e-9;
  // Some multiple of the direction lies between the bounds.
  double least = 0, most = 1e9;
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(o[k].lo, origin[k] + slack);
    EXPECT_GE(o[k].hi, origin[k] - slack);
    if (std::abs(direction[k]) < 1e-12) {
      EXPECT_LE(d[k].lo, slack);
      EXPECT_GE(d[k].hi, -slack);
      continue;
    }
    const double a = d[k].lo / direction[k], b = d[k].hi / direction[k];
    least = std::max(least, std::min(a, b));
    most = std::min(most, std::max(a, b));
  }
  EXPECT_LE(least, most * (1 + slack) + slack);
}

// Against the ray.
Vec3d normal_at(const BeamScene& scene, const SeenSurface& seen, const Ray& ray, double depth) {
  const BeamSolid& solid = scene.placed[seen.solid];
  const Ray own{transform_point(solid.object_from_world, ray.origin),
                transform_vector(solid.object_from_world, ray.direction)};
  const CsgBoundary boundary{depth, seen.leaf, seen.face, seen.entering};
  const Vec3d n = normalize(transpose(solid.object_from_world.linear) *
                            solid.shape->csg().outward_normal(boundary, own));
  return dot(n, ray.direction) < 0 ? n : -n;
}

// Of random solids, at random pixels, from outside and then within.
TEST(ray_bundle, holds_each_ray_that_is_reflected_or_refracted) {
  CsgRandom random(77);
  int reflected = 0, refracted = 0, again = 0;
  for (int i = 0; i < 3000; ++i) {
    BeamScene scene;
    scene.add(one_leaf(random_convex(random)), random_placement(random, 1));
    scene.eye = look_at({uniform(random, -2, 2), -7, 3}, {0, 0, 0}, 30, 64, 64);
    const double side = std::exp2(-int(random() % 5));
    const double x = uniform(random, 16, 48), y = uniform(random, 16, 48);
    const Rect rect{x, y, x + side, y + side};
    const std::optional<RaySight> middle = see(scene, rect.middle_x(), rect.middle_y());
    if (!middle) continue;
    const RayBundle eye = make_bundle(scene.eye, rect);
    const double eta = 1 / 1.5;
    const std::optional<RayBundle> mirrored = reflect(eye, scene.placed, middle->seen.surface);
    const std::optional<RayBundle> bent = refract(eye, scene.placed, middle->seen.surface, eta);
    for (int k = 0; k < 12; ++k) {
      const double u = uniform(random, -1, 1), v = uniform(random, -1, 1);
      const double px = rect.middle_x() + u * side / 2, py = rect.middle_y() + v * side / 2;
      const std::optional<RaySight> sight = see(scene, px, py);
      if (!sight || !(sight->seen == middle->seen)) continue;
      const Ray ray = ray_through(scene.eye, {px, py});
      const Vec3d at = ray.origin + ray.direction * sight->depth;
      const Vec3d n = normal_at(scene, sight->seen, ray, sight->depth);
      const Vec3d d = normalize(ray.direction);
      if (mirrored) {
        expect_holds(*mirrored, u, v, at, d - n * (2 * dot(n, d)));
        ++reflected;
      }
      if (!bent) continue;
      const double cosine = -dot(n, d);
      const Vec3d in =
          d * eta + n * (eta * cosine - std::sqrt(1 - eta * eta * (1 - cosine * cosine)));
      expect_holds(*bent, u, v, at, in);
      ++refracted;
      // On to where the ray leaves the solid, where the solid reflects it.
      const Ray inside{at + in * 1e-9, in};
      std::vector<BeamPart> roots{{0, scene.placed[0].shape->root()}};
      const std::optional<RaySight> end = see(scene.placed, roots, inside);
      if (!end || end->seen.entering) continue;
      SeenSurface leaving = end->seen;
      if (!leaving.surface.is_plane()) leaving.surface.root = BeamSurface::Root::leaving;
      const std::optional<RayBundle> second = reflect(*bent, scene.placed, leaving.surface);
      if (!second) continue;
      const Vec3d m = normal_at(scene, leaving, inside, end->depth);
      expect_holds(*second, u, v, inside.origin + in * end->depth, in - m * (2 * dot(m, in)));
      ++again;
    }
  }
  EXPECT_GT(reflected, 3000);
  EXPECT_GT(refracted, 3000);
  EXPECT_GT(again, 1500);
}

TEST(ray_bundle, total_reflection_is_no_refraction) {
  BeamScene scene;
  scene.add(one_leaf(CsgBox{Vec3d(-1), Vec3d(1)}));
  // From within, flat against the upper face.
  scene.eye = look_at({-0.9, 0, 0.5}, {0.9, 0, 1}, 1, 4, 4);
  const std::optional<RaySight> sight = see(scene, 2, 2);
  ASSERT_TRUE(sight && !sight->seen.entering);
  const RayBundle eye = make_bundle(scene.eye, {0, 0, 4, 4});
  EXPECT_FALSE(refract(eye, scene.placed, sight->seen.surface, 1.5).has_value());
  EXPECT_TRUE(refract(eye, scene.placed, sight->seen.surface, 1.01).has_value());
}

}  // namespace
}  // namespace arris::test
