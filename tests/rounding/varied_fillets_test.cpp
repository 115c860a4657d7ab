// varied_fillets_test.cpp — fillets in hollows, and of edges with radii of their own
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_oracle.h"
#include "support/creased_solids.h"
#include "support/rounded_box.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

// A block with a hollow like a box; the block's centre lies elsewhere.
TriangleSoup block_around(const TriangleSoup& box) {
  TriangleSoup mesh = box;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const auto first = std::uint32_t(mesh.positions.size());
  for (const Vec3f& p : box.positions) {
    mesh.positions.push_back({p.x > 0 ? 5.0F : -3.0F, p.y > 0 ? 3.0F : -4.0F, 3 * p.z});
  }
  for (const Triangle& t : box.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  mesh.name = "block";
  return mesh;
}

struct HollowTally {
  int fillets = 0, beside_seams = 0;
};

// What a ray within the hollow meets is what one within a solid of the hollow's shape leaves by.
void expect_like_a_box(const RoundedBox& box, RoundEdges edges, Random& rng, HollowTally& tally) {
  const TriangleSoup block = block_around(box.mesh);
  RoundingOptions options = box.options;
  options.edges = edges;
  // The block's own edges have none, or the object's.
  const Rounding solid = make_rounding(box.mesh.view(), box.options, "box");
  const Rounding hollow = make_rounding(block.view(), options, "block");
  ASSERT_EQ(hollow.data().filled.size(), 1U);
  for (int i = 0; i < 600; ++i) {
    const BoxEdge& e = box.edges[std::size_t(uniform_int(rng, 0, 11))];
    const Vec3d target =
        e.p0 + (e.p1 - e.p0) * uniform(rng, 0, 1) + random_direction(rng) * uniform(rng, 0, 0.4);
    const Vec3d start = random_direction(rng) * uniform(rng, 0, 0.8);
    const Ray ray{start, normalize(target - start)};
    const auto expected = trace(ray, {box.mesh.view(), &solid}, RayStart::inside);
    const auto hit = trace(ray, {block.view(), &hollow}, RayStart::outside);
    ASSERT_TRUE(expected && hit) << i;
    EXPECT_NEAR(hit->t, expected->t, 1e-6) << i << " " << name_of(hit->feature);
    tally.beside_seams += length(hit->normal + expected->normal) > 1e-4 ? 1 : 0;
    EXPECT_EQ(hit->feature == Feature::fillet, expected->feature != Feature::face) << i;
    tally.fillets += hit->feature == Feature::fillet ? 1 : 0;
    // Glass: from the other side of the fillet.
    if (hit->feature != Feature::fillet || dot(hit->normal, ray.direction) > -0.2) continue;
    const double way = 0.02;
    const Ray back{start + ray.direction * (hit->t + way), -ray.direction};
    const auto out = trace(back, {block.view(), &hollow}, RayStart::inside);
    ASSERT_TRUE(out) << i;
    EXPECT_NEAR(out->t, way, 1e-6) << i << " " << name_of(out->feature);
  }
}

void expect_good(const HollowTally& tally, int boxes) {
  EXPECT_GT(tally.fillets, 150 * boxes);
  // Where two balls cross, up to a millionth of a radius from there, either's normal will do: 1 in 1000 measured.
  EXPECT_LE(200 * tally.beside_seams, tally.fillets);
}

TEST(VariedFillets, hollows_are_like_solids_of_their_shape) {
  Random rng(4);
  HollowTally tally;
  for (const RoundEdges edges : {RoundEdges::concave, RoundEdges::both}) {
    RoundedBox box = make_box({2, 1.5, 1.2}, rng, {0.3});
    box.options.rules.clear();
    expect_like_a_box(box, edges, rng, tally);
  }
  expect_good(tally, 2);
}

TEST(VariedFillets, edges_of_hollows_have_their_own_radii) {
  Random rng(5);
  HollowTally tally;
  for (int k = 0; k < 6; ++k) {
    SCOPED_TRACE(k);
    const RoundedBox box = make_box({2, 1.5, 1.2}, rng, {0.15, 0.3, 0.05, k % 2 == 0 ? 0 : 0.2});
    expect_like_a_box(box, k % 3 == 0 ? RoundEdges::both : RoundEdges::concave, rng, tally);
  }
  expect_good(tally, 6);
}

struct BetweenTally {
  int rays = 0, fillets = 0, wrong = 0;
};

// A fillet is air that no ball of the largest radius reaches; no ray goes through the solid, nor through what even the
// smallest ball doesn't reach.
void expect_between(const MeshView& mesh, const Rounding& rounding, double least, double most,
                    Random& rng, BetweenTally& tally) {
  const BallOracle small(mesh, least, Space::outside), large(mesh, most, Space::outside);
  const auto boxes = rounding.fillet_boxes();
  for (int i = 0; i < 80; ++i) {
    const auto& box = boxes[std::size_t(uniform_int(rng, 0, int(boxes.size()) - 1))];
    const Vec3d target(uniform(rng, box.low.x, box.high.x), uniform(rng, box.low.y, box.high.y),
                       uniform(rng, box.low.z, box.high.z));
    const Vec3d d = random_direction(rng);
    const Ray ray{target - d * (20 * most), d};
    if (small.depth(ray.origin) < 0.1) continue;
    const auto hit = trace(ray, {mesh, &rounding});
    ++tally.rays;
    bool right = true;
    const double end = hit ? hit->t : 25 * most;
    for (double t = 17 * most; t < end - 0.02 * most; t += 0.3 * most) {
      right = right && small.margin(ray.origin + d * t, rng) > -0.003 * least;
    }
    if (hit && hit->feature == Feature::fillet) {
      ++tally.fillets;
      const Vec3d x = ray.origin + d * hit->t;
      right = right && small.depth(x) > -1e-6 &&
              large.margin(x - hit->normal * (0.01 * least), rng) < 0.003 * most;
    }
    tally.wrong += right ? 0 : 1;
    EXPECT_TRUE(right) << i << " " << (hit ? name_of(hit->feature) : "nothing");
  }
}

// On solids with mixed corners.
TEST(VariedFillets, rays_agree_with_the_smallest_and_the_largest_balls) {
  Random rng(8);
  BetweenTally tally;
  for (const CreasedCase& c : make_creased_cases()) {
    SCOPED_TRACE(c.mesh.name);
    const MeshView mesh = c.mesh.view();
    RoundingOptions options;
    options.radius = 0.6 * c.radius;
    options.min_angle = radians(5);
    options.edges = RoundEdges::concave;
    for (int k = 0; k < 4; ++k) {
      const Vec3d corner(
          mesh.positions[std::size_t(uniform_int(rng, 0, int(mesh.positions.size()) - 1))]);
      EdgeRule rule;
      rule.radius = k % 2 == 0 ? 0.3 * c.radius : c.radius;
      rule.box = {corner - Vec3d(1.1), corner + Vec3d(1.1)};
      options.rules.push_back(rule);
    }
    const Rounding rounding = make_rounding(mesh, options, c.mesh.name);
    ASSERT_EQ(rounding.data().filled.size(), 1U);
    expect_between(mesh, rounding, 0.3 * c.radius, c.radius, rng, tally);
  }
  EXPECT_GT(tally.fillets, 200);
  EXPECT_LE(300 * tally.wrong, tally.rays);
}

// The floor's edges in a slot narrower than the ball get half the radius, which fits.
TEST(VariedFillets, edges_without_room_get_a_smaller_radius) {
  constexpr double kWidth = 0.3, kRadius = 0.2, kFloor = -0.6;
  const TriangleSoup mesh = plate_with_slot(kWidth);
  RoundingOptions options;
  options.radius = kRadius;
  options.edges = RoundEdges::concave;
  options.on_overlap = OnOverlap::clamp;
  const Rounding rounding = make_rounding(mesh.view(), options, "slot");
  ASSERT_EQ(rounding.report().clamped.size(), 2U);
  for (const ClampedEdge& e : rounding.report().clamped) {
    EXPECT_EQ(e.radius, kRadius / 2);
    EXPECT_NEAR(length(e.to - e.from), 1, 1e-6);
    EXPECT_NEAR(e.from.z, kFloor, 1e-6);
  }
  // Half way along, a fifth of the radius from the wall: 2/5 of it above the floor.
  const auto hit =
      trace({{1.5, kWidth / 2 - kRadius / 10, 1}, {0, 0, -1}}, {mesh.view(), &rounding});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->feature, Feature::fillet);
  EXPECT_NEAR(hit->t, 1 - kFloor - 0.4 * kRadius / 2, 1e-6);
  Random rng(2);
  BetweenTally tally;
  for (int i = 0; i < 2; ++i) {
    expect_between(mesh.view(), rounding, kRadius / 2, kRadius, rng, tally);
  }
  EXPECT_GT(tally.fillets, 20);
}

// A radius larger than the solid costs the other edges nothing.
TEST(VariedFillets, edges_with_far_too_large_radii_get_what_fits) {
  const TriangleSoup mesh = plate_with_slot(0.8);
  RoundingOptions options;
  options.radius = 0.1;
  options.edges = RoundEdges::concave;
  EdgeRule rule;
  rule.radius = 1e6;
  rule.segments = {{Vec3d(-1, -1, -0.6), Vec3d(-1, -1, 0)}};
  options.rules = {rule};
  const Rounding rounding = make_rounding(mesh.view(), options, "plate");
  ASSERT_EQ(rounding.data().filled.size(), 1U);
  ASSERT_EQ(rounding.report().clamped.size(), 1U);
  EXPECT_GE(rounding.report().clamped[0].radius, 0.1);
  // Another upright edge of the pocket: at its middle the surface is (√2 − 1) r from where it was.
  const Vec3d inward = normalize(Vec3d(1, 1, 0));
  const auto hit =
      trace({Vec3d(0, 0, -0.2), inward * -1 + Vec3d(0, 2, 0) * inward.y}, {mesh.view(), &rounding});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->feature, Feature::fillet);
  EXPECT_NEAR(hit->t, std::sqrt(2.0) - 0.1 * (std::sqrt(2.0) - 1), 1e-5);
}

TEST(VariedFillets, rules_may_be_for_one_kind_of_edges) {
  const TriangleSoup l = plain_l();
  RoundingOptions options;
  options.radius = 0.2;
  options.edges = RoundEdges::both;
  EdgeRule rule;
  rule.kind = RoundEdges::concave;
  rule.radius = 0.1;
  options.rules = {rule};
  const auto outer_radius = [](const Rounding& r) { return r.data().creased[0]->radius; };
  const Rounding smaller = make_rounding(l.view(), options, "L");
  ASSERT_EQ(smaller.data().filled.size(), 1U);
  EXPECT_EQ(smaller.data().filled[0]->outside.radius, 0.1);
  EXPECT_EQ(outer_radius(smaller), 0.2);
  EXPECT_TRUE(smaller.data().creased[0]->field.is_uniform());
  EXPECT_EQ(smaller.report().rounded_edges, 18U);
  // An edge without a radius has no fillet, and is told.
  options.rules[0].radius = 0;
  const Rounding none = make_rounding(l.view(), options, "L");
  EXPECT_TRUE(none.data().filled.empty());
  EXPECT_EQ(none.report().rounded_edges, 17U);
  ASSERT_EQ(none.report().notes.size(), 1U);
  EXPECT_EQ(none.report().notes[0].count, 1U);
  EXPECT_EQ(none.report().notes[0].one, "edge stays sharp: its radius is 0");
  options.rules[0].kind = RoundEdges::convex;
  options.rules[0].radius = 0.05;
  const Rounding sharper = make_rounding(l.view(), options, "L");
  EXPECT_EQ(outer_radius(sharper), 0.05);
  ASSERT_EQ(sharper.data().filled.size(), 1U);
  EXPECT_EQ(sharper.data().filled[0]->outside.radius, 0.2);
}

}  // namespace
}  // namespace arris::oracle
