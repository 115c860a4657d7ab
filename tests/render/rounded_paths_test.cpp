// rounded_paths_test.cpp — light that goes from surface to surface of a rounded solid stays outside of it
// What       paths that are reflected diffusely: a surface that one of them meets from inside is one that it came
//            through, a hole in the rounding or between it and the mesh
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/prepared_scene.h"
#include "support/convex_solids.h"
#include "support/creased_solids.h"
#include "support/render_scenes.h"

namespace arris::oracle {
namespace {

struct Tally {
  int hits = 0, rounded = 0, within = 0;
  std::string examples;
};

class Walker {
 public:
  Walker(const TriangleSoup& mesh, double radius, RoundEdges edges)
      : name_(mesh.name), far_(2 * mesh.size()) {
    Camera camera;
    camera.position = {2, -3, 2};
    Scene scene = test::make_empty_scene(camera);
    Mesh of_scene;
    of_scene.name = mesh.name;
    of_scene.positions = mesh.positions;
    of_scene.triangles = mesh.triangles;
    for (const Vec3f p : mesh.positions) middle_ += Vec3d(p) / double(mesh.positions.size());
    test::add_object(scene, std::move(of_scene), test::make_lambert(1));
    scene.rounding.emplace();
    scene.rounding->method = RoundMethod::exact;
    scene.rounding->radius = radius;
    scene.rounding->edges = edges;
    scene_ = prepare_scene(std::move(scene));
  }

  void walk(int paths, Tally& tally) {
    for (int i = 0; i < paths; ++i) walk_once(tally);
  }

 private:
  void walk_once(Tally& tally) {
    constexpr int kMostBounces = 64;
    const Vec3d direction = random_direction(rng_);
    const Vec3d aim = middle_ + random_direction(rng_) * (0.2 * far_ * uniform(rng_, 0, 1));
    TraceRay ray;
    ray.origin = Vec3f(aim - direction * far_);
    ray.direction = Vec3f(direction);
    for (int bounce = 0; bounce < kMostBounces; ++bounce) {
      const std::optional<SurfaceHit> hit = scene_->intersect(ray);
      if (!hit) return;
      ++tally.hits;
      if (hit->feature != Feature::face) ++tally.rounded;
      if (hit->side != Side::outside) {
        ++tally.within;
        const Vec3f o = ray.origin, d = ray.direction;
        tally.examples += fmt::format(
            "{}: from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g}), bounce {}, to t "
            "{}\n",
            name_, o.x, o.y, o.z, d.x, d.y, d.z, bounce, hit->t);
        return;
      }
      const Vec3d normal(hit->geometric_normal), way = normal + random_direction(rng_);
      const bool is_flat = dot(normal, way) < 1e-3;
      ray = leave_surface(*hit, Vec3f(normalize(is_flat ? normal : way)));
    }
  }

  std::string name_;
  double far_;
  Vec3d middle_;
  std::shared_ptr<const PreparedScene> scene_;
  Random rng_{3};
};

TEST(RoundedPaths, do_not_come_into_the_solid) {
  std::vector<CreasedCase> cases = make_creased_cases();
  cases.push_back({block_with_boss("boss as wide as the ball", 0.5, 0.5, 0.8), 0.4});
  cases.push_back({block_with_boss("boss thinner than the ball", 0.3, 0.3, 0.8), 0.4});
  cases.push_back({block_with_boss("pocket with a thin floor", 0.8, 0.8, -1.2), 0.2});
  cases.push_back({plate_with_slot(0.3), 0.2});
  cases.push_back({plate_with_slot(0.39), 0.2});
  Tally all;
  for (const RoundEdges edges : {RoundEdges::convex, RoundEdges::concave, RoundEdges::both}) {
    for (const CreasedCase& c : cases) Walker(c.mesh, c.radius, edges).walk(20000, all);
  }
  EXPECT_GT(all.rounded, 100000);
  EXPECT_LE(all.within * 100000, all.hits) << all.examples;
}

}  // namespace
}  // namespace arris::oracle
