// thin_walls_test.cpp — where a growing ball gets stuck, and what rounding leaves of solids with walls too thin for it
#include "rounding/growing_ball.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"
#include "support/surface_of.h"

namespace arris::oracle {
namespace {

constexpr std::uint32_t kNoFace = 1000;

// Whether a ball gets stuck that begins to grow at a place of a face.
bool gets_stuck_at(const TriangleSoup& mesh, Vec3d x, Vec3d normal, double radius) {
  return gets_stuck(surface_of(mesh, radius), x, normal, kNoFace, radius);
}

TEST(GrowingBall, gets_stuck_between_parallel_walls) {
  const TriangleSoup slab = prism_over("slab", {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {});
  const double thickness = slab.positions.back().z - slab.positions.front().z;
  for (const double part : {0.51, 0.6, 1.0, 3.0}) {
    EXPECT_TRUE(gets_stuck_at(slab, {5, 5, 0}, {0, 0, -1}, part * thickness)) << part;
    EXPECT_TRUE(gets_stuck_at(slab, {0.01, 5, 0}, {0, 0, -1}, part * thickness)) << part;
    EXPECT_TRUE(gets_stuck_at(slab, {0, 0.2, 0.01}, {-1, 0, 0}, part * thickness)) << part;
  }
  for (const double part : {0.1, 0.3, 0.499}) {
    EXPECT_FALSE(gets_stuck_at(slab, {5, 5, 0}, {0, 0, -1}, part * thickness)) << part;
    EXPECT_FALSE(gets_stuck_at(slab, {0.01, 5, 0}, {0, 0, -1}, part * thickness)) << part;
    EXPECT_FALSE(gets_stuck_at(slab, {1e-4, 0.2, 0}, {0, 0, -1}, part * thickness)) << part;
  }
}

// A trapezoid whose sides lean by an angle each: a ball between them grows by the sine of it as it moves.
TEST(GrowingBall, gets_stuck_between_walls_that_are_nearly_parallel) {
  const auto is_stuck = [](double lean) {
    const double wide = 0.2 + 4 * std::tan(radians(lean));
    const TriangleSoup tooth =
        prism_over("tooth", {{-wide, 0}, {wide, 0}, {0.2, 4}, {-0.2, 4}}, {});
    const double height = 0.5 * (tooth.positions.front().z + tooth.positions.back().z);
    return gets_stuck_at(tooth, {0.05, 4, height}, {0, 1, 0}, 0.4);
  };
  for (const double lean : {0.0, 2.0, 10.0, 17.0}) EXPECT_TRUE(is_stuck(lean)) << lean;
  for (const double lean : {19.0, 25.0, 40.0}) EXPECT_FALSE(is_stuck(lean)) << lean;
}

// In a wedge of 30, 60 and 90 degrees all balls that begin to grow on its shortest side end as the one that touches all
// sides: by way of other sides, so that what is touched comes and goes.
TEST(GrowingBall, finds_the_only_place_where_it_fits) {
  const double a = std::sqrt(3), b = 1, inscribed = 0.5 * (a + b - 2);
  const TriangleSoup wedge = prism_over("wedge", {{0, 0}, {a, 0}, {0, b}}, {});
  const double low = wedge.positions.front().z, high = wedge.positions.back().z;
  ASSERT_GT(high - low, 2 * inscribed);
  for (int i = 1; i < 500; ++i) {
    for (const double height : {0.1, 0.3, 0.5}) {
      const Vec3d x(0, b * i / 500, low + (high - low) * height);
      EXPECT_FALSE(gets_stuck_at(wedge, x, {-1, 0, 0}, inscribed * (1 - 2e-5))) << x.y;
      EXPECT_TRUE(gets_stuck_at(wedge, x, {-1, 0, 0}, inscribed * (1 + 2e-5))) << x.y;
    }
  }
}

// A wheel whose teeth are narrower than two balls at their tips.
TriangleSoup gear(double tip) {
  Outline outline;
  constexpr int kTeeth = 9;
  for (int i = 0; i < kTeeth; ++i) {
    const double middle = 2 * kPi * i / kTeeth;
    for (const auto& [radius, turn] : {std::pair(1.0, -0.2), {1.4, -tip}, {1.4, tip}, {1.0, 0.2}}) {
      outline.push_back({radius * std::cos(middle + turn), radius * std::sin(middle + turn)});
    }
  }
  return prism_over("gear", outline, {});
}

Rounding round(const TriangleSoup& mesh, double radius, RoundEdges edges = RoundEdges::convex) {
  RoundingOptions options;
  options.radius = radius;
  options.edges = edges;
  options.too_large = TooLarge::leave_sharp;
  return make_rounding(mesh.view(), options, mesh.name);
}

struct Agreement {
  std::uint64_t rays = 0, through = 0;
  std::string examples;
};

// Shoots rays at the surface near edges, and others at the places that they hit.
class Shooter {
 public:
  Shooter(const TriangleSoup& mesh, double radius, RoundEdges edges = RoundEdges::convex)
      : mesh_(mesh),
        radius_(radius),
        far_(2 * mesh.size()),
        rounding_(round(mesh, radius, edges)) {}

  // A place that one ray comes to is where others that are aimed at it stop, too, if nothing is before it.
  void compare(int count, Agreement& out) {
    for (int i = 0; i < count; ++i) {
      const Ray first = at(near_edge(), random_direction(rng_));
      const auto hit = trace(first, {mesh_.view(), &rounding_});
      if (!hit) continue;
      const Vec3d x = first.origin + first.direction * hit->t;
      for (int k = 0; k < 4; ++k) {
        Vec3d d = random_direction(rng_);
        if (dot(d, hit->normal) > 0) d = -d;
        if (dot(d, hit->normal) < -kLeastCosine) look(at(x, d), *hit, x, out);
      }
    }
  }

 private:
  static constexpr double kLeastCosine = 0.2, kOff = 0.1;

  Vec3d near_edge() {
    const auto last = int(mesh_.triangles.size()) - 1;
    const Triangle& t = mesh_.triangles[std::size_t(uniform_int(rng_, 0, last))];
    const Vec3d p(mesh_.positions[t[0]]), q(mesh_.positions[t[1]]);
    return p + (q - p) * uniform(rng_, 0, 1) +
           random_direction(rng_) * (radius_ * uniform(rng_, 0, 1.5));
  }
  [[nodiscard]] Ray at(Vec3d target, Vec3d d) const { return {target - d * far_, d}; }

  void look(const Ray& ray, const RoundedHit& hit, Vec3d x, Agreement& out) const {
    const auto again = trace(ray, {mesh_.view(), &rounding_});
    const double beyond = again ? again->t - far_ : far_;
    if (beyond < -kOff * radius_) return;
    ++out.rays;
    if (beyond < kOff * radius_) return;
    ++out.through;
    out.examples += fmt::format(
        "{} radius {:.4f}: place ({:.5f}, {:.5f}, {:.5f}) on {}, from "
        "({:.3f}, {:.3f}, {:.3f}): {:.2f} radii behind it\n",
        mesh_.name, radius_, x.x, x.y, x.z, name_of(hit.feature), ray.direction.x, ray.direction.y,
        ray.direction.z, beyond / radius_);
  }

  const TriangleSoup& mesh_;
  double radius_, far_;
  Rounding rounding_;
  Random rng_{7};
};

TEST(ThinWalls, are_the_same_from_all_sides) {
  std::vector<std::pair<TriangleSoup, double>> cases{
      {gear(0.03), 0.08},
      {gear(0.08), 0.08},
      {gear(0.08), 0.15},
      {prism_over("wedge", {{0, 0}, {4, 0}, {4, 2}, {0, 0.3}}, {}), 0.3},
      {prism_over("bent wedge", {{0, 0}, {4, 0}, {4, 2}, {3, 2}, {3, 1.6}, {0, 0.3}}, {}), 0.3},
      {block_with_boss("thin boss", 0.1, 0.1, 0.9), 0.15},
      {block_with_boss("tapered boss", 0.2, 0.1, 0.9), 0.15},
      {block_with_boss("low boss", 0.1, 0.1, 0.05), 0.15},
      {block_with_boss("step", 0.8, 0.8, 0.05), 0.15},
      {block_with_boss("thin floor", 0.8, 0.8, -1.4), 0.15},
      {block_with_boss("leaning boss", 0.3, 0.1, 0.9, 0.4), 0.2}};
  Agreement found;
  for (const auto& [mesh, radius] : cases) Shooter(mesh, radius).compare(600, found);
  EXPECT_LE(found.through * 5000, found.rays) << found.examples;
  // Solids and radii at random: pieces of walls may be thinner than the steps in which they are looked for.
  Agreement any;
  for (std::uint64_t seed = 1; seed < 12; ++seed) {
    Random rng(seed);
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      Shooter(mesh, std::pow(10, uniform(rng, -2, -0.5)) * mesh.size()).compare(300, any);
    }
  }
  EXPECT_GT(any.rays, 50000U);
  EXPECT_LE(any.through * 5000, any.rays) << any.examples;
}

// Fillets end where gaps between walls are too narrow for the ball.
TEST(ThinWalls, narrow_gaps_are_the_same_from_all_sides) {
  Agreement found;
  for (const RoundEdges edges : {RoundEdges::concave, RoundEdges::both}) {
    for (const double width : {0.1, 0.3, 0.39}) {
      const TriangleSoup slot = plate_with_slot(width);
      Shooter(slot, 0.2, edges).compare(600, found);
    }
  }
  EXPECT_LE(found.through * 5000, found.rays) << found.examples;
  // The sides of their ends are met only by rays that come to the mesh behind them.
  Agreement any;
  for (std::uint64_t seed = 1; seed < 12; ++seed) {
    Random rng(seed);
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      Shooter(mesh, std::pow(10, uniform(rng, -2, -1)) * mesh.size(), RoundEdges::concave)
          .compare(300, any);
    }
  }
  EXPECT_GT(any.rays, 50000U);
  EXPECT_LE(any.through * 5000, any.rays) << any.examples;
}

// The wedge's long edges are rounded from where a ball fits between its sides, and listed as sharp up to there.
TEST(ThinWalls, edges_are_listed_as_far_as_they_stay) {
  const Vec3d from(0, 0.3, 0), to(4, 2, 0);
  const TriangleSoup mesh =
      prism_over("wedge", {{0, 0}, {4, 0}, {4, 2}, {3.9, 2}, {3.9, to.y - 0.0425}, {0, 0.3}}, {});
  constexpr double kRadius = 0.3;
  const Rounding rounding = round(mesh, kRadius);
  ASSERT_EQ(rounding.data().creased.size(), 1U);
  // Below the slanted side, r from both: y = r, and r / cos above it.
  const double slope = (to.y - from.y) / (to.x - from.x);
  const double x = (kRadius + kRadius * std::hypot(1, slope) - from.y) / slope;
  int listed = 0;
  for (const ClampedEdge& edge : rounding.report().clamped) {
    EXPECT_EQ(edge.radius, 0);
    const double least = std::min(edge.from.x, edge.to.x), most = std::max(edge.from.x, edge.to.x);
    if (most - least < 0.1) continue;
    ++listed;
    EXPECT_EQ(least, 0);
    // The ball's centre is beside the place where it touches the slanted side, by r sin.
    const bool is_straight = std::max(edge.from.y, edge.to.y) < 1e-6;
    EXPECT_NEAR(most, is_straight ? x : x - kRadius * slope / std::hypot(1, slope), 0.01);
  }
  EXPECT_EQ(listed, 4);
}

// A post on a slab, of some sides, by the radii of the circles in it at its foot and its top; 0: it ends in a tip.
TriangleSoup slab_with_post(std::uint32_t sides, double foot, double top, double height) {
  TriangleSoup mesh{"post", {}, {}};
  const auto add_ring = [&](double inscribed, double z) {
    const double radius = inscribed / std::cos(kPi / sides);
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * kPi * i / sides + 0.3;
      mesh.positions.push_back(
          {float(radius * std::cos(angle)), float(radius * std::sin(angle)), float(z)});
    }
  };
  const auto add_belt = [&](std::uint32_t low, std::uint32_t high) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const std::uint32_t j = (i + 1) % sides;
      mesh.triangles.push_back({low + i, low + j, high + j});
      mesh.triangles.push_back({low + i, high + j, high + i});
    }
  };
  const auto add_fan = [&](std::uint32_t first, bool is_up) {
    for (std::uint32_t i = 2; i < sides; ++i) {
      const Triangle t{first, first + i - 1, first + i};
      mesh.triangles.push_back(is_up ? t : Triangle{t[0], t[2], t[1]});
    }
  };
  add_ring(2, -1);
  add_ring(2, 0);
  add_ring(foot, 0);
  add_fan(0, false);
  add_belt(0, sides);
  add_belt(sides, 2 * sides);
  if (top > 0) {
    add_ring(top, height);
    add_belt(2 * sides, 3 * sides);
    add_fan(3 * sides, true);
  } else {
    mesh.positions.push_back({0, 0, float(height)});
    for (std::uint32_t i = 0; i < sides; ++i) {
      mesh.triangles.push_back({2 * sides + i, 2 * sides + (i + 1) % sides, 3 * sides});
    }
  }
  return mesh;
}

// No two sides of a three-sided rod are opposite to each other.
TEST(ThinWalls, rods_stay) {
  constexpr double kRadius = 0.3, kFoot = 0.25, kHeight = 3;
  for (const double top : {0.2, 0.1}) {
    // Balls that grow lower than this, between leaning sides, come to the slab on their way to the axis.
    const double foot = 2 * kFoot * (kFoot - top) / kHeight;
    const TriangleSoup mesh = slab_with_post(3, kFoot, top, kHeight);
    const Rounding rounding = round(mesh, kRadius);
    ASSERT_EQ(rounding.data().creased.size(), 1U);
    EXPECT_EQ(rounding.report().clamped.size(), 6U);
    Random rng(3);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d target(uniform(rng, -0.4, 0.4), uniform(rng, -0.4, 0.4), uniform(rng, 0, 3.2));
      Vec3d d = random_direction(rng);
      if (d.z > 0) d.z = -d.z;  // not through the slab
      const Ray ray{target - d * 10.0, d};
      const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh.view());
      if (sharp.empty() || ray.origin.z + d.z * sharp.front().t < foot) continue;
      const auto hit = trace(ray, {mesh.view(), &rounding});
      ASSERT_TRUE(hit) << i;
      EXPECT_NEAR(hit->t, sharp.front().t, 1e-6) << i;
      ++met;
    }
    EXPECT_GT(met, 500);
  }
}

// As a blade, a needle whose sides meet in its tip is rounded, however slim it is; so is a cone.
TEST(ThinWalls, needles_are_rounded) {
  constexpr double kRadius = 0.3, kFoot = 0.6, kHeight = 6;
  for (const std::uint32_t sides : {3U, 4U, 5U, 6U, 7U, 8U, 16U, 48U}) {
    SCOPED_TRACE(sides);
    const TriangleSoup mesh = slab_with_post(sides, kFoot, 0, kHeight);
    const Rounding rounding = round(mesh, kRadius);
    ASSERT_EQ(rounding.data().creased.size(), 1U);
    EXPECT_TRUE(rounding.report().clamped.empty());
    // The ball that touches all sides; its top is the tip.
    const double lean = std::atan(kFoot / kHeight);
    const double center = kHeight - kRadius / std::sin(lean);
    const auto down = trace({{0, 0, 10}, {0, 0, -1}}, {mesh.view(), &rounding});
    ASSERT_TRUE(down);
    // Creases may end by their tolerance too late, which is more along the axis.
    const double slack = 2 * rounding.data().creased[0]->tolerance / std::sin(lean);
    EXPECT_NEAR(10 - down->t, center + kRadius, slack);
    for (int i = 0; i < 100; ++i) {
      const double z = center + kRadius + (kHeight - center - kRadius) * (i + 0.5) / 100;
      EXPECT_FALSE(trace({{-5, 1e-3, z}, {1, 0, 0}}, {mesh.view(), &rounding})) << z;
    }
  }
}

// A blade on a block: a ball fits where it begins, and rounds it, or does not, and it stays but for what is thinner
// than a part of the radius at its tip.
TEST(ThinWalls, blades_on_too_thin_a_foot_stay) {
  constexpr double kRadius = 0.5, kHeight = 5;
  for (const double half_foot : {0.05, 0.1, 0.2, 0.4, 0.9, 1.5}) {
    SCOPED_TRACE(half_foot);
    const Outline outline{{-6, -4},     {6, -4},         {6, 0}, {half_foot, 0},
                          {0, kHeight}, {-half_foot, 0}, {-6, 0}};
    const TriangleSoup mesh = prism_over("blade", outline, {9, 1, 0});
    const Rounding rounding = round(mesh, kRadius);
    ASSERT_EQ(rounding.data().creased.size(), 1U);
    const bool stays = half_foot < kRadius;
    EXPECT_EQ(rounding.report().clamped.empty(), !stays);
    const double lean = std::atan(half_foot / kHeight);
    const double top = stays ? kHeight : kHeight - kRadius / std::sin(lean) + kRadius;
    const double slack = 2 * rounding.data().creased[0]->tolerance / std::sin(lean);
    for (int i = 0; i < 200; ++i) {
      const double y = kHeight * (i + 0.5) / 200;
      const double thickness = 2 * half_foot * (1 - y / kHeight);
      if (std::abs(y - top) < slack || thickness < 0.005 * kRadius) continue;
      const auto hit = trace({{-5, y, 3.1}, {1, 0, 0}}, {mesh.view(), &rounding});
      EXPECT_EQ(hit.has_value(), y < top) << y;
    }
  }
}

// A wedge one side of which is curved, in facets: the first two meet the other side at 36 and 48 degrees, so that the
// one is opposite to it and the other isn't, and the first lies more than two radii from the crease.
TEST(ThinWalls, facets_at_the_tip_of_a_wedge_are_rounded_away) {
  Outline side{{0, 0}};
  for (const auto& [way, slope] :
       {std::pair(0.05, 36.0), {1.0, 48.0}, {1.0, 60.0}, {1.0, 72.0}, {1.0, 84.0}}) {
    const auto [x, y] = side.back();
    side.emplace_back(x + way * std::cos(radians(slope)), y + way * std::sin(radians(slope)));
  }
  Outline outline{{8, 0}, {8, 5}, {side.back().first, 5}};
  outline.insert(outline.end(), side.rbegin(), side.rend());
  const TriangleSoup mesh = prism_over("wedge", outline, {8, 1, 0});
  const double middle = 0.5 * (mesh.positions.front().z + mesh.positions.back().z);
  for (const double radius : {0.1, 0.2, 0.35}) {
    const Rounding rounding = round(mesh, radius);
    ASSERT_EQ(rounding.data().creased.size(), 1U);
    EXPECT_TRUE(rounding.report().clamped.empty()) << radius;
    // The centre of the ball that touches both sides is 2.2 radii from the tip or farther.
    for (int i = 0; i < 100; ++i) {
      const Vec3d x(1.1 * radius * (i + 0.5) / 100, 0, middle);
      for (const double way : {-1.0, 1.0}) {
        const Ray ray{x - Vec3d(0, 10 * way, 0.1), {0, way, 0}};
        EXPECT_FALSE(trace(ray, {mesh.view(), &rounding})) << radius << " " << x.x;
      }
    }
  }
}

}  // namespace
}  // namespace arris::oracle
