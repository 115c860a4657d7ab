// bands_test.cpp — bands leave no void point out and stay few; the kd-tree finds what they find
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "arris/rounding.h"
#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/rounded_ray.h"
#include "support/rounding_judge.h"

namespace arris {
namespace {

// A plate of n × n cells, n odd: every second cell of every second row is a square hole.
class PerforatedPlate {
 public:
  explicit PerforatedPlate(int n) : n_(n) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (is_solid(i, j)) add_cell(i, j);
      }
    }
  }

  [[nodiscard]] MeshView view() const { return {positions_, triangles_}; }

 private:
  using Corner = std::array<int, 3>;

  [[nodiscard]] bool is_solid(int i, int j) const {
    return i >= 0 && j >= 0 && i < n_ && j < n_ && (i % 2 == 0 || j % 2 == 0);
  }

  std::uint32_t vertex(const Corner& c) {
    const auto [at, is_new] = vertices_.try_emplace(c, std::uint32_t(positions_.size()));
    if (is_new) positions_.push_back(Vec3f(float(c[0]), float(c[1]), float(c[2])));
    return at->second;
  }

  void add_quad(const std::array<Corner, 4>& q) {
    const std::uint32_t a = vertex(q[0]), b = vertex(q[1]), c = vertex(q[2]), d = vertex(q[3]);
    triangles_.push_back({a, b, c});
    triangles_.push_back({a, c, d});
  }

  void add_cell(int i, int j) {
    const int k = i + 1, l = j + 1;
    add_quad({{{i, j, 1}, {k, j, 1}, {k, l, 1}, {i, l, 1}}});
    add_quad({{{i, j, 0}, {i, l, 0}, {k, l, 0}, {k, j, 0}}});
    if (!is_solid(i - 1, j)) add_quad({{{i, j, 0}, {i, j, 1}, {i, l, 1}, {i, l, 0}}});
    if (!is_solid(i + 1, j)) add_quad({{{k, l, 0}, {k, l, 1}, {k, j, 1}, {k, j, 0}}});
    if (!is_solid(i, j - 1)) add_quad({{{k, j, 0}, {k, j, 1}, {i, j, 1}, {i, j, 0}}});
    if (!is_solid(i, j + 1)) add_quad({{{i, l, 0}, {i, l, 1}, {k, l, 1}, {k, l, 0}}});
  }

  int n_;
  std::map<Corner, std::uint32_t> vertices_;
  std::vector<Vec3f> positions_;
  std::vector<Triangle> triangles_;
};

double bytes_per_triangle(int cells) {
  const PerforatedPlate plate(cells);
  const Rounding rounding = make_rounding(plate.view(), {.radius = 0.1});
  return double(rounding.report().bytes) / double(plate.view().triangles.size());
}

TEST(Bands, memory_of_a_perforated_plate_grows_with_its_holes_alone) {
  EXPECT_LT(bytes_per_triangle(61), 1.1 * bytes_per_triangle(21));
}

constexpr double kEveryEdge = radians(0.01);

// A point in a triangle of a mesh, more often near its border than not.
struct MeshPoint {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;
  Vec3d position;
};

MeshPoint random_point(const MeshView& mesh, oracle::Random& rng) {
  MeshPoint p;
  p.triangle = std::uint32_t(oracle::uniform_int(rng, 0, int(mesh.triangles.size()) - 1));
  const double s = std::pow(oracle::uniform(rng, 0, 1), 3), along = oracle::uniform(rng, 0, 1);
  std::array<double, 3> weight{s, (1 - s) * along, (1 - s) * (1 - along)};
  std::rotate(weight.begin(), weight.begin() + oracle::uniform_int(rng, 0, 2), weight.end());
  p.u = weight[1];
  p.v = weight[2];
  const Triangle& t = mesh.triangles[p.triangle];
  for (std::size_t i = 0; i < 3; ++i) p.position += Vec3d(mesh.positions[t[i]]) * weight[i];
  return p;
}

TEST(Bands, leave_no_void_point_out) {
  int void_points = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    oracle::Random rng(seed);
    for (const oracle::Polyhedron& polyhedron : oracle::make_solids(seed)) {
      const oracle::SolidMesh mesh = oracle::make_mesh(polyhedron, oracle::random_style(rng), seed);
      const double radius = oracle::inradius(mesh.solid) * oracle::uniform(rng, 0.02, 0.9);
      const oracle::Opening opening(mesh.solid, radius);
      const Rounding rounding =
          make_rounding(mesh.view(), {.radius = radius, .min_angle = kEveryEdge}, mesh.name);
      const double depth = 1e-7 * mesh.solid.size + 4 * mesh.quantum;
      for (int i = 0; i < 1000; ++i) {
        const MeshPoint p = random_point(mesh.view(), rng);
        const double distance = opening.distance(p.position);
        if (distance <= depth) continue;
        ++void_points;
        ASSERT_FALSE(rounding.is_kept(p.triangle, p.u, p.v))
            << mesh.name << " seed " << seed << ": " << distance / mesh.solid.size << " deep";
      }
    }
  }
  EXPECT_GT(void_points, 10'000);
}

// ---- the kd-tree

// Rays at points near a mesh's edges; those whose answers differ by more than the rounding of floats.
int count_differences(const MeshView& mesh, const RoundingOptions& options, double size,
                      int& moved) {
  RoundingOptions with_tree = options;
  with_tree.detection = Detection::kd_tree;
  const Rounding bands = make_rounding(mesh, options), tree = make_rounding(mesh, with_tree);
  oracle::Random rng(11);
  int differences = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d target = random_point(mesh, rng).position;
    const Vec3d direction = oracle::random_direction(rng);
    const Ray ray{target - direction * (2 * size), direction};
    const auto a = oracle::trace(ray, {mesh, &bands}), b = oracle::trace(ray, {mesh, &tree});
    moved += a && a->feature != Feature::face ? 1 : 0;
    const bool same = a && b ? std::abs(a->t - b->t) <= 1e-6 * size &&
                                   oracle::angle_deg(a->normal, b->normal) <= 0.1
                             : !a && !b;
    differences += same ? 0 : 1;
  }
  return differences;
}

TEST(DetectionTree, answers_like_the_bands_on_convex_solids) {
  int differences = 0, moved = 0;
  for (const oracle::Polyhedron& polyhedron : oracle::make_solids(21)) {
    const oracle::SolidMesh mesh = oracle::make_mesh(polyhedron, {}, 21);
    const double radius = 0.2 * oracle::inradius(mesh.solid);
    differences += count_differences(mesh.view(), {.radius = radius, .min_angle = kEveryEdge},
                                     mesh.solid.size, moved);
  }
  EXPECT_EQ(differences, 0);
  EXPECT_GT(moved, 10'000);
}

TEST(DetectionTree, answers_like_the_bands_on_solids_that_are_not_convex) {
  const PerforatedPlate plate(7);
  int moved = 0;
  EXPECT_EQ(count_differences(plate.view(), {.radius = 0.1}, 7, moved), 0);
  EXPECT_GT(moved, 200);
}

}  // namespace
}  // namespace arris
