// creased_curved_test.cpp — solids of revolution in facets, rounded, against the exact rounding of the curved solid
// Reference  a ball fits into a solid of revolution, or outside of it, iff its disc fits beside the profile, so opening
//            and closing are those of the profile, turned: quarters of circles at its convex, or concave, corners
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_judge.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

struct Spot {
  double x = 0, z = 0;  // distance from the axis, height
};

// Upright and level sides, counter-clockwise.
struct Profile {
  std::string name;
  std::vector<Spot> corners;
};

std::vector<Profile> make_profiles() {
  return {
      {"washer", {{1, 0}, {2, 0}, {2, 0.8}, {1, 0.8}}},
      {"collar", {{0.6, 0}, {2, 0}, {2, 0.6}, {1.2, 0.6}, {1.2, 1.3}, {0.6, 1.3}}},
      {"counterbore", {{0.6, 0}, {2, 0}, {2, 1.2}, {1.3, 1.2}, {1.3, 0.7}, {0.6, 0.7}}},
      {"groove", {{1, 0}, {2, 0}, {2, 0.6}, {1.5, 0.6}, {1.5, 1.1}, {2, 1.1}, {2, 1.7}, {1, 1.7}}}};
}

TriangleSoup turn(const Profile& profile, int facets) {
  TriangleSoup mesh{fmt::format("{} of {} facets", profile.name, facets), {}, {}};
  const auto m = std::uint32_t(profile.corners.size());
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * kPi * i / facets;
    for (const Spot& s : profile.corners) {
      mesh.positions.push_back(
          {float(s.x * std::cos(angle)), float(s.x * std::sin(angle)), float(s.z)});
    }
  }
  for (std::uint32_t i = 0; i < std::uint32_t(facets); ++i) {
    const std::uint32_t a = i * m, b = (i + 1) % std::uint32_t(facets) * m;
    for (std::uint32_t k = 0; k < m; ++k) {
      const std::uint32_t n = (k + 1) % m;
      mesh.triangles.push_back({a + k, b + k, b + n});
      mesh.triangles.push_back({a + k, b + n, a + n});
    }
  }
  return mesh;
}

// How deep a place lies in the opening, or the closing, of the turned profile; negative outside.
class TurnedRounding {
 public:
  TurnedRounding(Profile profile, double radius, RoundEdges edges)
      : profile_(std::move(profile)), r_(radius), side_(edges == RoundEdges::convex ? 1 : -1) {}

  [[nodiscard]] double depth(Vec3d p) const {
    const Spot at{std::hypot(p.x, p.y), p.z};
    const std::size_t m = profile_.corners.size();
    double nearest = INFINITY;
    bool inside = false;
    for (std::size_t k = 0; k < m; ++k) {
      const Spot a = profile_.corners[(k + m - 1) % m], b = profile_.corners[k],
                 c = profile_.corners[(k + 1) % m];
      nearest = std::min(nearest, distance(at, b, c));
      if ((b.z > at.z) != (c.z > at.z)) {
        inside ^= at.x < b.x + (c.x - b.x) * (at.z - b.z) / (c.z - b.z);
      }
      const double turn = (b.x - a.x) * (c.z - b.z) - (b.z - a.z) * (c.x - b.x);
      if (turn * side_ <= 0) continue;
      // Along both sides.
      const Spot in{sign(c.x - b.x) - sign(b.x - a.x), sign(c.z - b.z) - sign(b.z - a.z)};
      const double u = (at.x - b.x) * in.x, w = (at.z - b.z) * in.z;
      if (r_ > 0 && std::max(u, w) < r_ && std::min(u, w) > -r_)
        return side_ * (r_ - std::hypot(u - r_, w - r_));
    }
    return inside ? nearest : -nearest;
  }
  // Of the facets, too.
  [[nodiscard]] bool is_outside(Vec3d p) const { return depth(p) < -0.05; }

 private:
  static double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
  static double distance(Spot p, Spot a, Spot b) {
    const double dx = b.x - a.x, dz = b.z - a.z;
    const double u =
        std::clamp(((p.x - a.x) * dx + (p.z - a.z) * dz) / (dx * dx + dz * dz), 0., 1.);
    return std::hypot(p.x - a.x - u * dx, p.z - a.z - u * dz);
  }

  Profile profile_;
  double r_, side_;
};

struct Deviation {
  double of_hits = 0;     // from the exact surface
  double of_passing = 0;  // depth in the exact solid to which rays go before they hit
  int moved = 0, faces = 0, missed = 0;
  std::string worst;
};

bool is_concave(const Profile& profile, const Spot& corner) {
  const std::size_t m = profile.corners.size(), k = std::size_t(&corner - profile.corners.data());
  const Spot a = profile.corners[(k + m - 1) % m], c = profile.corners[(k + 1) % m];
  return (corner.x - a.x) * (c.z - corner.z) < (corner.z - a.z) * (c.x - corner.x);
}

// Rays at the profile's corners, from outside.
Deviation measure(const Profile& profile, int facets, double radius, RoundEdges edges) {
  constexpr int kRays = 1500;
  const TriangleSoup mesh = turn(profile, facets);
  RoundingOptions options;
  options.radius = radius;
  options.edges = edges;
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  Deviation out;
  const bool opens = edges != RoundEdges::concave;
  EXPECT_EQ(opens ? rounding.data().creased.size() : rounding.data().filled.size(), 1U)
      << mesh.name;
  // With both kinds, places at convex corners are looked at.
  const RoundEdges kind = opens ? RoundEdges::convex : edges;
  const TurnedRounding exact(profile, radius, kind), sharp(profile, 0, kind);
  const TurnedRounding& larger = opens ? sharp : exact;
  Random rng(11);
  for (int i = 0; i < kRays; ++i) {
    const Spot& corner = profile.corners[std::size_t(i) % profile.corners.size()];
    const double angle = uniform(rng, 0, 2 * kPi);
    const double x = corner.x + uniform(rng, -1.5, 1.5) * radius;
    const Vec3d target{x * std::cos(angle), x * std::sin(angle),
                       corner.z + uniform(rng, -1.5, 1.5) * radius};
    const Vec3d d = normalize(Vec3d{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)} +
                              Vec3d(1e-3));
    // From a place outside that is not far: nothing of the solid is before.
    double back = radius;
    while (back < 4 && !larger.is_outside(target - d * back)) back += 0.5 * radius;
    const Ray ray{target - d * back, d};
    if (!larger.is_outside(ray.origin)) continue;
    const auto hit = trace(ray, {mesh.view(), &rounding});
    const double end = hit ? hit->t : 8;
    const auto worse = [&](double& known, double value, const char* what) {
      if (value <= known) return;
      known = value;
      out.worst = fmt::format(
          "{} {:.3g}: o ({:.9g}, {:.9g}, {:.9g}) d ({:.9g}, {:.9g}, {:.9g}) t {}", what, value,
          ray.origin.x, ray.origin.y, ray.origin.z, d.x, d.y, d.z, hit ? hit->t : -1);
    };
    for (double t = 0; t < end; t += 0.1 * radius) {
      worse(out.of_passing, exact.depth(ray.origin + d * t), "passes");
    }
    if (!hit) {
      ++out.missed;
      continue;
    }
    (hit->feature == Feature::face ? out.faces : out.moved) += 1;
    const Vec3d at = ray.origin + d * hit->t;
    const double apart = std::hypot(std::hypot(at.x, at.y) - corner.x, at.z - corner.z);
    if (edges == RoundEdges::both && (is_concave(profile, corner) || apart > 1.5 * radius))
      continue;
    worse(out.of_hits, std::abs(exact.depth(at)), "hits");
  }
  return out;
}

// Errors are a part of the height of chords, and get less with them.
void expect_to_converge(const Profile& profile, RoundEdges edges, int least_moved) {
  for (const double radius : {0.08, 0.2}) {
    double before = INFINITY;
    for (const int facets : {16, 32, 64}) {
      SCOPED_TRACE(fmt::format("{}, {} facets, radius {}", profile.name, facets, radius));
      const Deviation d = measure(profile, facets, radius, edges);
      // Chords lie by so much inside of the circle about the outside.
      const double chord = 2 * (1 - std::cos(kPi / facets));
      const double worst = std::max(d.of_hits, d.of_passing);
      EXPECT_LE(worst, 1.6 * chord) << d.worst;
      EXPECT_LT(worst, 0.5 * before) << d.worst;
      EXPECT_GT(d.moved, least_moved);
      EXPECT_GT(d.faces, 150);
      before = worst;
    }
  }
}

TEST(CreasedCurved, rounding_of_facets_comes_to_that_of_the_curved_solid) {
  for (const Profile& profile : make_profiles()) {
    expect_to_converge(profile, RoundEdges::convex, 150);
  }
}

TEST(CreasedCurved, fillets_of_facets_come_to_those_of_the_curved_solid) {
  for (const Profile& profile : make_profiles()) {
    if (profile.name == "washer") continue;  // has no concave edge
    expect_to_converge(profile, RoundEdges::concave, 30);
  }
}

// The rims of bores, whose smooth edges bend in.
TEST(CreasedCurved, fillets_leave_the_rounding_of_rims_as_it_is) {
  for (const Profile& profile : make_profiles()) {
    if (profile.name == "washer") continue;
    SCOPED_TRACE(profile.name);
    const Deviation d = measure(profile, 32, 0.2, RoundEdges::both);
    EXPECT_LE(d.of_hits, 1.6 * 2 * (1 - std::cos(kPi / 32))) << d.worst;
    EXPECT_GT(d.moved, 150);
  }
}

// Twisted prisms: their sides are two triangles each, and smooth edges between.
// What shades smoothly needs the two faces between which a rim lies.
TEST(CreasedCurved, rims_lie_between_the_faces_that_the_ball_touches) {
  for (const Profile& profile : make_profiles()) {
    SCOPED_TRACE(profile.name);
    const double r = 0.1;
    const TriangleSoup mesh = turn(profile, 32);
    RoundingOptions options;
    options.radius = r;
    const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
    Random rng(9);
    int rims = 0, blended = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3d target(
          mesh.positions[std::size_t(uniform(rng, 0, 0.999) * double(mesh.positions.size()))]);
      const Vec3d d =
          normalize(Vec3d(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)));
      const Ray ray{target - d * 8.0 + Vec3d(uniform(rng, -r, r), uniform(rng, -r, r), 0), d};
      const auto hit = trace(ray, {mesh.view(), &rounding});
      if (!hit || hit->feature == Feature::face) continue;
      ++rims;
      const Vec3d x = ray.origin + ray.direction * hit->t;
      const auto blend = rounding.blend_of(*hit, x);
      if (!blend) continue;
      ++blended;
      Vec3d sum;
      for (const EdgeBlend::Side& side : {blend->a, blend->b}) {
        sum += side.face_normal * side.weight;
        // In the face's plane, where the ball touches it.
        const Triangle& t = mesh.triangles[side.triangle];
        const Vec3d p0(mesh.positions[t[0]]);
        EXPECT_NEAR(dot(rounding.face_normal(side.triangle), side.point - p0), 0, 1e-3 * r);
        EXPECT_NEAR(length(side.point - (x - hit->normal * r)), r, 0.05 * r);
      }
      EXPECT_GT(dot(normalize(sum), hit->normal), 0.99);
    }
    EXPECT_GT(rims, 200);
    EXPECT_GT(blended, rims * 9 / 10);
  }
}

TEST(CreasedCurved, no_ray_passes_where_a_ball_fits) {
  int rays = 0, creased = 0;
  for (const std::uint64_t seed : {2, 16, 48}) {
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      if (mesh.name == "cells" || mesh.name == "spiky ball") continue;
      for (const double part : {0.004, 0.015}) {
        BallShooter shooter(mesh, part * mesh.size(), seed, radians(30));
        if (shooter.rounding().report().smooth_edges == 0) continue;
        if (shooter.rounding().data().creased.empty()) continue;
        ++creased;
        BallTally tally;
        shooter.shoot(12, tally);
        rays += tally.rays;
        for (const std::string& example : tally.examples) {
          EXPECT_EQ(example.find("goes through"), std::string::npos) << example;
        }
      }
    }
  }
  EXPECT_GT(creased, 10);
  EXPECT_GT(rays, 100);
}

}  // namespace
}  // namespace arris::oracle
