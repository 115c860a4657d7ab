// plain_crease_test.cpp — hits beside plain stretches of creases against what searches of all the solid answer
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/creased_solids.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

struct AgreementTally {
  int hits = 0, beside = 0;  // of all, those that stretches settled
  std::vector<std::string> wrong;
};

// Without the lists of stretches every hit is searched.
Rounding without_stretches(Rounding rounding) {
  auto& data = const_cast<Rounding::Data&>(rounding.data());
  data.plain_begin.clear();
  return rounding;
}

const char* name_of(Resolution::Outcome outcome) {
  constexpr const char* kNames[] = {"kept", "moved", "passed"};
  return kNames[std::size_t(outcome)];
}

class Comparison {
 public:
  Comparison(const TriangleSoup& mesh, const RoundingOptions& options, std::uint64_t seed)
      : mesh_(mesh.view()),
        name_(mesh.name),
        r_(options.radius),
        quick_(make_rounding(mesh_, options, name_)),
        slow_(without_stretches(make_rounding(mesh_, options, name_))),
        rng_(seed) {}

  [[nodiscard]] const Rounding::Data& data() const { return quick_.data(); }

  // At edges and corners, some nearly along an edge or a face; all hits, from outside and from inside.
  void shoot(int rays, AgreementTally& tally) {
    for (int i = 0; i < rays; ++i) {
      const Ray ray = make_ray(i);
      compare(ray, RayStart::unknown, tally);
      compare(ray, RayStart::inside, tally);
      leave(ray, tally);
    }
  }

 private:
  Ray make_ray(int i) {
    std::uniform_int_distribution<std::size_t> pick(0, mesh_.triangles.size() - 1);
    const Triangle& t = mesh_.triangles[pick(rng_)];
    const Vec3d p(mesh_.positions[t[0]]), q(mesh_.positions[t[1]]), o(mesh_.positions[t[2]]);
    Vec3d target = p + (q - p) * (i % 5 == 0 ? 0.0 : uniform(rng_, 0, 1));
    target += random_direction(rng_) * (uniform(rng_, 0, 1.5) * r_);
    Vec3d d = random_direction(rng_);
    if (i % 4 == 1) d = normalize(normalize(q - p) + d * uniform(rng_, 0, 0.4));
    if (i % 4 == 2) d = normalize(normalize((q - p) + (o - p)) + d * uniform(rng_, 0, 0.1));
    const double length_of_direction = std::pow(10, uniform(rng_, -1, 1));
    return {target - d * (uniform(rng_, 0, 12) * r_), d * length_of_direction};
  }

  // From where the ray meets the surface.
  void leave(const Ray& ray, AgreementTally& tally) {
    const auto hit = trace(ray, {mesh_, &slow_});
    if (!hit || dot(hit->normal, ray.direction) > 0) return;
    const Vec3d x = ray.origin + ray.direction * hit->t;
    Vec3d away = random_direction(rng_);
    if (dot(away, hit->normal) < 0) away = -away;
    compare({x, away}, RayStart::outside, tally);
    compare({x, -away}, RayStart::inside, tally);
  }

  void compare(const Ray& ray, RayStart start, AgreementTally& tally) {
    for (const MeshHit& hit : intersect_mesh(ray, mesh_)) {
      if (quick_.is_kept(hit.triangle, hit.u, hit.v)) continue;
      // A search looks for a way out that is a tolerance away.
      if (hit.t * length(ray.direction) < 1e-4 * r_) continue;
      const Resolution a = quick_.resolve(ray, hit, start);
      const Resolution b = slow_.resolve(ray, hit, start);
      ++tally.hits;
      if (!plain_creases_on(quick_.data(), hit.triangle).empty()) ++tally.beside;
      if (is_same(ray, hit, a, b)) continue;
      if (tally.wrong.size() > 8) continue;
      tally.wrong.push_back(fmt::format(
          "{}: o ({:.9g}, {:.9g}, {:.9g}) d ({:.9g}, {:.9g}, {:.9g}) start {} hit {:.9g} of {}: {} "
          "{:.9g}, not {} {:.9g}",
          name_, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
          ray.direction.z, int(start), hit.t, hit.triangle, name_of(a.outcome), a.hit.t,
          name_of(b.outcome), b.hit.t));
    }
  }

  // The smallest of all solids'.
  [[nodiscard]] double tolerance() const {
    double least = INFINITY;
    for (const auto& solid : data().creased) least = std::min(least, solid->tolerance);
    for (const auto& solid : data().filled) least = std::min(least, solid->outside.tolerance);
    return least;
  }

  // A hit that is kept by less than the tolerance may as well have moved by next to nothing.
  [[nodiscard]] bool is_same(const Ray& ray, const MeshHit& hit, const Resolution& a,
                             const Resolution& b) const {
    const auto place = [&](const Resolution& r) {
      if (r.outcome == Resolution::Outcome::kept) return hit.t;
      return r.outcome == Resolution::Outcome::moved ? r.hit.t
                                                     : std::numeric_limits<double>::infinity();
    };
    if (a.outcome == Resolution::Outcome::passed && b.outcome == a.outcome) return true;
    double apart = std::abs(place(a) - place(b)) * length(ray.direction);
    double most = 1e-5 * r_;
    if (a.outcome == b.outcome && a.outcome == Resolution::Outcome::moved) {
      // Creases lie where they should by a tolerance, so that one may hide another's pipe by as much. Where a ball
      // at a place s beyond a cylinder's end lies as high above it, s² / 2 r is that, and s / r their normals' angle.
      apart *= std::abs(dot(a.hit.normal, ray.direction)) / length(ray.direction);
      most += tolerance();
    }
    if (!(apart < most)) return false;
    return a.outcome != b.outcome || a.outcome == Resolution::Outcome::kept ||
           dot(a.hit.normal, b.hit.normal) > 1 - most / r_;
  }

  MeshView mesh_;
  std::string name_;
  double r_;
  Rounding quick_, slow_;
  Random rng_;
};

void expect_agreement(RoundEdges edges) {
  AgreementTally all;
  const auto add = [&](const TriangleSoup& mesh, double radius, int rays) {
    RoundingOptions options;
    options.radius = radius;
    options.edges = edges;
    options.min_angle = radians(5);
    options.too_large = TooLarge::leave_sharp;
    Comparison comparison(mesh, options, 17);
    if (comparison.data().plain.empty()) return false;
    comparison.shoot(rays, all);
    return true;
  };
  for (const CreasedCase& solid : make_creased_cases()) {
    SCOPED_TRACE(solid.mesh.name);
    EXPECT_TRUE(add(solid.mesh, solid.radius, 1500));
  }
  int solids = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      for (const double part : {0.004, 0.015, 0.04}) {
        solids += add(mesh, part * mesh.size(), 60) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(solids, 20);
  EXPECT_GT(all.beside, all.hits / 2);
  EXPECT_TRUE(all.wrong.empty()) << fmt::format("{}", fmt::join(all.wrong, "\n"));
}

TEST(PlainCrease, hits_beside_convex_edges_are_settled_as_all_others) {
  expect_agreement(RoundEdges::convex);
}

TEST(PlainCrease, hits_on_fillets_are_settled_as_all_others) {
  expect_agreement(RoundEdges::concave);
}

TEST(PlainCrease, hits_beside_both_kinds_of_edges_are_settled_as_all_others) {
  expect_agreement(RoundEdges::both);
}

}  // namespace
}  // namespace arris::oracle
