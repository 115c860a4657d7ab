// rounded_paths_test.cpp — light that goes from surface to surface of a rounded solid stays on its side of it
// What       paths that are reflected diffusely, outside or within: a surface that one of them meets from the other
//            side is one that it came through, a hole in the rounding or between it and the mesh
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
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
  int hits = 0, rounded = 0, wrong = 0;
  std::string examples;
};

class Walker {
 public:
  Walker(const TriangleSoup& mesh, double radius, RoundEdges edges,
         std::vector<EdgeRule> rules = {})
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
    scene.rounding->rules = std::move(rules);
    scene_ = prepare_scene(std::move(scene));
  }

  void walk(int paths, Tally& tally) {
    for (int i = 0; i < paths; ++i) {
      const auto hit = shoot();
      if (!hit) continue;
      ++tally.hits;
      if (hit->feature != Feature::face) ++tally.rounded;
      if (hit->side != Side::outside) ++tally.wrong;
      walk_from(*hit, Side::outside, tally);
    }
  }

  // The same within the solid.
  void walk_within(int paths, Tally& tally) {
    for (int i = 0; i < paths; ++i) {
      const auto hit = shoot();
      if (hit && hit->side == Side::outside) walk_from(*hit, Side::inside, tally);
    }
  }

 private:
  std::optional<SurfaceHit> shoot() {
    const Vec3d direction = random_direction(rng_);
    const Vec3d aim = middle_ + random_direction(rng_) * (0.2 * far_ * uniform(rng_, 0, 1));
    TraceRay ray;
    ray.origin = Vec3f(aim - direction * far_);
    ray.direction = Vec3f(direction);
    return scene_->intersect(ray);
  }

  // On this side of the surface, from one place of it to the next.
  void walk_from(SurfaceHit hit, Side side, Tally& tally) {
    constexpr int kMostBounces = 64;
    for (int bounce = 0; bounce < kMostBounces; ++bounce) {
      const Vec3d outward(hit.geometric_normal);
      const Vec3d normal = side == Side::outside ? outward : -outward;
      const Vec3d way = normal + random_direction(rng_);
      const bool is_flat = dot(normal, way) < 1e-3;
      const TraceRay ray = leave_surface(hit, Vec3f(normalize(is_flat ? normal : way)));
      const std::optional<SurfaceHit> next = scene_->intersect(ray);
      if (!next && side == Side::outside) return;
      ++tally.hits;
      if (next && next->feature != Feature::face) ++tally.rounded;
      if (!next || next->side != side) {
        ++tally.wrong;
        const Vec3f o = ray.origin, d = ray.direction;
        tally.examples += fmt::format(
            "{}: from ({:.9g}, {:.9g}, {:.9g}) on {} along ({:.9g}, {:.9g}, {:.9g}), bounce {}, to "
            "{} at {}\n",
            name_, o.x, o.y, o.z, name_of(hit.feature), d.x, d.y, d.z, bounce,
            next ? name_of(next->feature) : "nothing", next ? next->t : INFINITY);
        return;
      }
      hit = *next;
    }
  }

  std::string name_;
  double far_;
  Vec3d middle_;
  std::shared_ptr<const PreparedScene> scene_;
  Random rng_{3};
};

std::vector<CreasedCase> make_path_cases() {
  std::vector<CreasedCase> cases = make_creased_cases();
  cases.push_back({block_with_boss("boss as wide as the ball", 0.5, 0.5, 0.8), 0.4});
  cases.push_back({block_with_boss("boss thinner than the ball", 0.3, 0.3, 0.8), 0.4});
  cases.push_back({block_with_boss("pocket with a thin floor", 0.8, 0.8, -1.2), 0.2});
  return cases;
}

// Where fillets end in gaps.
std::vector<CreasedCase> make_gap_cases() {
  return {{plate_with_slot(0.3), 0.2}, {plate_with_slot(0.39), 0.2}};
}

constexpr std::array kAllKinds{RoundEdges::convex, RoundEdges::concave, RoundEdges::both};

TEST(RoundedPaths, do_not_come_into_the_solid) {
  Tally all;
  for (const RoundEdges edges : kAllKinds) {
    for (const auto& cases : {make_path_cases(), make_gap_cases()}) {
      for (const CreasedCase& c : cases) Walker(c.mesh, c.radius, edges).walk(20000, all);
    }
  }
  EXPECT_GT(all.rounded, 100000);
  EXPECT_LE(all.wrong * 100000, all.hits) << all.examples;
}

// As in glass.
TEST(RoundedPaths, do_not_come_out_of_the_solid) {
  for (const double part : {1.0, 1.7}) {
    Tally all;
    for (const RoundEdges edges : kAllKinds) {
      for (const CreasedCase& c : make_path_cases()) {
        Walker(c.mesh, c.radius * part, edges).walk_within(1000, all);
      }
    }
    EXPECT_GT(all.rounded, 10000);
    EXPECT_LE(all.wrong * 100000, all.hits) << all.examples;
  }
}

// Edges in parts of the solid, up to a plane each, have radii of their own.
std::vector<EdgeRule> random_rules(const CreasedCase& c, Random& rng) {
  std::vector<EdgeRule> rules;
  for (int i = 0; i < 3; ++i) {
    Vec3d low(-10), high(10);
    const int axis = uniform_int(rng, 0, 2);
    high[axis] =
        c.mesh.positions[std::size_t(uniform_int(rng, 0, int(c.mesh.positions.size()) - 1))][axis];
    EdgeRule rule;
    rule.radius = c.radius * uniform(rng, 0.2, 1);
    rule.box = {low, high};
    rules.push_back(rule);
  }
  return rules;
}

TEST(RoundedPaths, stay_on_their_side_of_edges_with_radii_of_their_own) {
  Random rng(8);
  Tally outside, within;
  for (const CreasedCase& c : make_path_cases()) {
    for (int i = 0; i < 4; ++i) {
      Walker walker(c.mesh, c.radius, RoundEdges::convex, random_rules(c, rng));
      walker.walk(10000, outside);
      walker.walk_within(500, within);
    }
  }
  EXPECT_LE(outside.wrong * 100000, outside.hits) << outside.examples;
  EXPECT_LE(within.wrong * 100000, within.hits) << within.examples;
}

// A fillet's side in a gap is met only by rays that come to the mesh behind it.
TEST(RoundedPaths, seldom_come_out_of_fillets_in_gaps) {
  Tally all;
  for (const RoundEdges edges : {RoundEdges::concave, RoundEdges::both}) {
    for (const CreasedCase& c : make_gap_cases()) {
      Walker(c.mesh, c.radius, edges).walk_within(1000, all);
    }
  }
  EXPECT_GT(all.rounded, 10000);
  EXPECT_LE(all.wrong * 5000, all.hits) << all.examples;
}

}  // namespace
}  // namespace arris::oracle
