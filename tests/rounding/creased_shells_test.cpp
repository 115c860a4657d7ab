// creased_shells_test.cpp — exact rounding of large solids with concave edges, and of solids with hollows
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "base/parallel_for.h"
#include "rounding/rounding_data.h"
#include "support/ball_judge.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

// Cells of 1 in a grid; every other one of every other row is a pocket.
class PlateMaker {
 public:
  explicit PlateMaker(int pockets) : cells_(2 * pockets + 1) {
    for (int i = 0; i < cells_; ++i)
      for (int k = 0; k < cells_; ++k) add_cell(i, k);
    const int last = cells_;
    for (int i = 0; i < cells_; ++i) {
      add_wall({i, 0}, {i + 1, 0}, kBottom, 0);
      add_wall({last, i}, {last, i + 1}, kBottom, 0);
      add_wall({i + 1, last}, {i, last}, kBottom, 0);
      add_wall({0, i + 1}, {0, i}, kBottom, 0);
    }
  }
  [[nodiscard]] TriangleSoup take() {
    mesh_.name = fmt::format("plate of {} cells", cells_);
    return std::move(mesh_);
  }

 private:
  using Spot = std::pair<int, int>;
  static constexpr float kBottom = -1, kFloor = -0.625F;

  std::uint32_t vertex(Spot at, float z) {
    const auto [found, is_new] =
        vertices_.try_emplace({at, z}, std::uint32_t(mesh_.positions.size()));
    if (is_new) mesh_.positions.push_back({float(at.first), float(at.second), z});
    return found->second;
  }
  void add_quad(std::array<std::uint32_t, 4> v) {
    mesh_.triangles.push_back({v[0], v[1], v[2]});
    mesh_.triangles.push_back({v[0], v[2], v[3]});
  }
  void add_wall(Spot a, Spot b, float low, float high) {
    add_quad({vertex(a, low), vertex(b, low), vertex(b, high), vertex(a, high)});
  }
  void add_cell(int i, int k) {
    const bool pocket = i % 2 == 1 && k % 2 == 1;
    const std::array<Spot, 4> ring{{{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k + 1}}};
    const auto add = [&](float z, bool up) {
      std::array<std::uint32_t, 4> v{};
      for (std::size_t c = 0; c < 4; ++c) v[c] = vertex(ring[up ? c : 3 - c], z);
      add_quad(v);
    };
    add(pocket ? kFloor : 0, true);
    add(kBottom, false);
    if (!pocket) return;
    for (std::size_t c = 0; c < 4; ++c) add_wall(ring[(c + 1) % 4], ring[c], kFloor, 0);
  }

  int cells_;
  TriangleSoup mesh_;
  std::map<std::pair<Spot, float>, std::uint32_t> vertices_;
};

RoundingOptions options_of(double radius) {
  RoundingOptions options;
  options.radius = radius;
  return options;
}

// Those of one pocket alone, moved.
TEST(CreasedShells, each_pocket_of_a_plate_has_the_same_rounding) {
  const TriangleSoup one = PlateMaker(1).take(), many = PlateMaker(12).take();
  ASSERT_GT(many.triangles.size(), 2500U);
  const double r = 0.15;
  const Rounding of_one = make_rounding(one.view(), options_of(r), one.name);
  const Rounding of_many = make_rounding(many.view(), options_of(r), many.name);
  ASSERT_EQ(of_one.data().creased.size(), 1U);
  ASSERT_EQ(of_many.data().creased.size(), 1U);
  Random rng(3);
  int moved = 0, different = 0;
  for (int i = 0; i < 1500; ++i) {
    // About the pocket between 1 and 2, and 13 and 14.
    const Vec3d target{uniform(rng, 0.8, 2.2), uniform(rng, 0.8, 2.2), uniform(rng, -0.8, 0.2)};
    const Vec3d origin{uniform(rng, 0.5, 2.5), uniform(rng, 0.5, 2.5), uniform(rng, 1, 2)};
    const Ray ray{origin, target - origin};
    const Ray shifted{origin + Vec3d(12, 12, 0), ray.direction};
    const auto a = trace(ray, {one.view(), &of_one});
    const auto b = trace(shifted, {many.view(), &of_many});
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (!a) continue;
    moved += a->feature != Feature::face ? 1 : 0;
    // By no more than rays that graze a surface tell of its 32-bit coordinates.
    different += std::abs(a->t - b->t) > 1e-6 ? 1 : 0;
    EXPECT_NEAR(a->t, b->t, 1e-4) << i;
  }
  EXPECT_GT(moved, 150);
  EXPECT_LE(different, 3);
}

TEST(CreasedShells, are_the_same_whatever_the_number_of_threads) {
  const TriangleSoup plate = PlateMaker(12).take();
  std::vector<Rounding> made;
  for (const int threads : {1, 2}) {
    parallel_for(1, {.threads = threads}, [&](std::size_t) {
      made.push_back(make_rounding(plate.view(), options_of(0.1), plate.name));
    });
  }
  const CreasedSolid& a = *made[0].data().creased.at(0);
  const CreasedSolid& b = *made[1].data().creased.at(0);
  ASSERT_EQ(a.pipes.creases().size(), b.pipes.creases().size());
  for (std::size_t i = 0; i < a.pipes.creases().size(); ++i) {
    const CreaseCurve& p = a.pipes.creases()[i];
    const CreaseCurve& q = b.pipes.creases()[i];
    EXPECT_TRUE(p.at(p.u0) == q.at(q.u0) && p.at(p.u1) == q.at(q.u1)) << i;
  }
  const auto& bands_a = made[0].data().bands;
  const auto& bands_b = made[1].data().bands;
  ASSERT_EQ(bands_a.size(), bands_b.size());
  for (std::size_t i = 0; i < bands_a.size(); ++i) {
    EXPECT_TRUE(bands_a[i].c0 == bands_b[i].c0 && bands_a[i].cu == bands_b[i].cu &&
                bands_a[i].cv == bands_b[i].cv)
        << i;
  }
}

void append(TriangleSoup& to, const TriangleSoup& mesh, Vec3f at, bool inside_out) {
  const auto first = std::uint32_t(to.positions.size());
  for (const Vec3f& p : mesh.positions) to.positions.push_back(p + at);
  for (const Triangle& t : mesh.triangles) {
    to.triangles.push_back(inside_out ? Triangle{t[2] + first, t[1] + first, t[0] + first}
                                      : Triangle{t[0] + first, t[1] + first, t[2] + first});
  }
}

TriangleSoup block(double x, double y, double z) {
  return prism_over("block", {{0, 0}, {x, 0}, {x, y}, {0, y}}, {z, 1, 0});
}

// A block with hollows: near its walls, askew, of an L shape, and one with another solid in it.
std::vector<TriangleSoup> make_hollow_solids() {
  std::vector<TriangleSoup> solids;
  const TriangleSoup l = prism_over(
      "L", {{0, 0}, {1.2, 0}, {1.2, 0.5}, {0.5, 0.5}, {0.5, 1.2}, {0, 1.2}}, {0.7, 1, 0});
  TriangleSoup box{"box with a box in it", {}, {}};
  append(box, block(2, 2, 2), {}, false);
  append(box, block(1.2, 1, 1), {0.26F, 0.5F, 0.5F}, true);
  solids.push_back(box);
  TriangleSoup two{"box with two hollows", {}, {}};
  append(two, block(3, 2, 2), {}, false);
  append(two, block(1, 1, 1), {0.25F, 0.5F, 0.5F}, true);
  TriangleSoup twisted =
      prism_over("twisted", {{-0.6, -0.6}, {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}}, {1.2, 0.8, 0});
  for (Vec3f& p : twisted.positions) p = {p.x + 0.1F * p.z, p.y - 0.2F * p.z, p.z};
  append(two, twisted, {2.1F, 1.1F, 0.4F}, true);
  solids.push_back(two);
  TriangleSoup bent{"box with an L in it", {}, {}};
  append(bent, block(2, 2, 1.2), {}, false);
  append(bent, l, {0.3F, 0.4F, 0.25F}, true);
  solids.push_back(bent);
  TriangleSoup both{"L with a hollow", {}, {}};
  append(both,
         prism_over("L", {{0, 0}, {3, 0}, {3, 1.4}, {1.4, 1.4}, {1.4, 3}, {0, 3}}, {1.2, 1, 0}), {},
         false);
  append(both, block(0.7, 0.8, 0.6), {0.35F, 0.3F, 0.3F}, true);
  solids.push_back(both);
  TriangleSoup nested{"box in a box", {}, {}};
  append(nested, block(3, 3, 3), {}, false);
  append(nested, block(2.4, 2.4, 2.4), {0.3F, 0.3F, 0.3F}, true);
  append(nested, block(1.6, 1.5, 1.4), {0.7F, 0.8F, 0.8F}, false);
  append(nested, block(0.8, 0.7, 0.6), {1.0F, 1.2F, 1.2F}, true);
  solids.push_back(nested);
  return solids;
}

TEST(CreasedShells, hollow_solids_agree_with_the_balls_that_fit) {
  int rays = 0, wrong = 0;
  std::vector<std::string> examples;
  for (const TriangleSoup& mesh : make_hollow_solids()) {
    SCOPED_TRACE(mesh.name);
    BallShooter shooter(mesh, 0.12, 5);
    ASSERT_EQ(shooter.rounding().data().creased.size(), mesh.name == "box in a box" ? 2U : 1U);
    EXPECT_EQ(shooter.rounding().report().exact_solids, shooter.rounding().report().solids);
    BallTally tally;
    shooter.shoot(80, tally);
    EXPECT_GT(tally.moved, 8);
    rays += tally.rays;
    wrong += tally.wrong;
    examples.insert(examples.end(), tally.examples.begin(), tally.examples.end());
  }
  EXPECT_LE(wrong * 300, rays) << fmt::format("{}", fmt::join(examples, "\n"));
}

// The walls of a hollow hold no ball of the radius: they stay, and the rest is exact.
TEST(CreasedShells, walls_of_hollows_that_would_vanish_stay) {
  TriangleSoup mesh{"one thin wall", {}, {}};
  append(mesh, block(2, 2, 2), {}, false);
  append(mesh, block(1.2, 1, 1), {0.2F, 0.5F, 0.5F}, true);
  const Rounding rounding = make_rounding(mesh.view(), options_of(0.12), mesh.name);
  ASSERT_EQ(rounding.data().creased.size(), 1U);
  Random rng(9);
  for (int i = 0; i < 500; ++i) {
    const Vec3d target(0, uniform(rng, 0.2, 1.8), uniform(rng, 0.2, 1.8));
    const Vec3d d = normalize(Vec3d(1, uniform(rng, -0.5, 0.5), uniform(rng, -0.5, 0.5)));
    const auto hit = trace({target - d, d}, {mesh.view(), &rounding});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 1, 1e-6);
  }
}

// Rounded as if it had no hollow, the outside would reach into that at its corners.
TEST(CreasedShells, solids_whose_walls_are_all_too_thin_stay_sharp) {
  TriangleSoup mesh{"thin", {}, {}};
  append(mesh, block(2, 2, 2), {}, false);
  append(mesh, block(1.9, 1.9, 1.9), {0.05F, 0.05F, 0.05F}, true);
  const Rounding rounding = make_rounding(mesh.view(), options_of(0.12), mesh.name);
  EXPECT_TRUE(rounding.data().creased.empty());
  EXPECT_EQ(rounding.report().exact_solids, 0U);
  EXPECT_EQ(rounding.report().rounded_edges, 0U);
  EXPECT_EQ(rounding.report().clamped.size(), 12U);
  Random rng(5);
  for (int i = 0; i < 500; ++i) {
    const Vec3d d = random_direction(rng);
    const Vec3d target(uniform(rng, 0, 0.2), uniform(rng, 0, 0.2), uniform(rng, 0, 0.2));
    const RoundedMesh object{mesh.view(), &rounding};
    const Ray ray{target - d * 9.0, d};
    const auto hit = trace(ray, object);
    const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh.view());
    ASSERT_EQ(hit.has_value(), !sharp.empty());
    if (!hit) continue;
    EXPECT_NEAR(hit->t, sharp.front().t, 1e-9);
  }
}

}  // namespace
}  // namespace arris::oracle
