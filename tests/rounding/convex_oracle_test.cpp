// convex_oracle_test.cpp — the oracle that judges the rounding is itself judged here: by closed
// forms, by brute force over all faces, edges and corners, and by the definition's slow search.
#include "support/convex_oracle.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/convex_solids.h"

namespace arris::oracle {
namespace {

// Nearest point by trying every set of one, two and three planes.
Vec3d nearest_by_enumeration(const ConvexSolid& solid, double inset, Vec3d x) {
  const auto& planes = solid.planes;
  double best = kInfinity;
  Vec3d nearest = x;
  const auto consider = [&](Vec3d c) {
    if (length(c - x) < best && !find_violated(planes, inset, c, 1e-11 * solid.size)) {
      best = length(c - x);
      nearest = c;
    }
  };
  consider(x);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double di = planes[i].offset - inset;
    consider(x - planes[i].normal * (dot(planes[i].normal, x) - di));
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const double dj = planes[j].offset - inset;
      const Vec3d axis = cross(planes[i].normal, planes[j].normal);
      if (length(axis) < 1e-9) continue;
      const Mat3d rows{planes[i].normal, planes[j].normal, axis};
      consider(inverse(transpose(rows)) * Vec3d(di, dj, dot(axis, x)));
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        const Mat3d corner{planes[i].normal, planes[j].normal, planes[k].normal};
        if (std::abs(determinant(corner)) < 1e-9) continue;
        consider(inverse(transpose(corner)) * Vec3d(di, dj, planes[k].offset - inset));
      }
    }
  }
  return nearest;
}

std::vector<SolidMesh> plain_meshes(std::uint64_t seed) {
  std::vector<SolidMesh> meshes;
  for (const Polyhedron& p : make_solids(seed)) meshes.push_back(make_mesh(p, {}, seed));
  return meshes;
}

double signed_volume(const SolidMesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](int i) {
      return Vec3d(mesh.positions[t[std::size_t(i)]]) - mesh.solid.center;
    };
    six += dot(at(0), cross(at(1), at(2)));
  }
  return six / 6;
}

TEST(ConvexOracle, inradius_of_regular_solids) {
  const auto radius = [](const Polyhedron& p) { return inradius(make_mesh(p, {}, 1).solid); };
  EXPECT_NEAR(radius(cube()), 0.5, 1e-7);
  EXPECT_NEAR(radius(box({1, 2, 0.25})), 0.125, 1e-7);
  EXPECT_NEAR(radius(tetrahedron()), 1 / std::sqrt(3), 1e-6);
  EXPECT_NEAR(radius(octahedron()), 1 / std::sqrt(3), 1e-6);
  EXPECT_NEAR(radius(prism(6, 0.5)), 0.25, 1e-6);
  EXPECT_NEAR(radius(prism(6, 5)), std::sqrt(3) / 2, 1e-6);
}

TEST(ConvexOracle, nearest_point_agrees_with_enumeration) {
  Random rng(11);
  for (const SolidMesh& mesh : plain_meshes(11)) {
    if (mesh.solid.planes.size() > 16) continue;
    for (double share : {0.05, 0.5, 0.94}) {
      const double r = share * inradius(mesh.solid);
      for (int i = 0; i < 30; ++i) {
        const Vec3d x = random_direction(rng) * uniform(rng, 0, 1.5) * mesh.solid.size;
        const auto c = find_nearest(mesh.solid.planes, r, x, mesh.solid.size);
        ASSERT_TRUE(c) << mesh.name;
        const Vec3d reference = nearest_by_enumeration(mesh.solid, r, x);
        EXPECT_NEAR(length(*c - x), length(reference - x), 1e-10 * mesh.solid.size) << mesh.name;
        EXPECT_LT(length(*c - reference), 1e-5 * mesh.solid.size) << mesh.name;
      }
    }
  }
}

TEST(ConvexOracle, agrees_with_the_search_over_balls) {
  Random rng(12);
  int inside = 0, outside = 0;
  for (const SolidMesh& mesh : plain_meshes(12)) {
    const double r = uniform(rng, 0.05, 0.95) * inradius(mesh.solid);
    const Opening opening(mesh.solid, r);
    for (int i = 0; i < 60; ++i) {
      const auto& [a, b] = mesh.edges[std::size_t(uniform_int(rng, 0, int(mesh.edges.size()) - 1))];
      const double u = uniform(rng, 0, 1);
      const Vec3d x = a * (1 - u) + b * u + random_direction(rng) * uniform(rng, 0, r);
      if (!opening.in_sharp_solid(x) || std::abs(opening.distance(x)) < 3e-3 * r) continue;
      const double reached = sampled_inside_distance(mesh.solid, r, x, std::uint64_t(i));
      const bool kept = opening.contains(x);
      (kept ? inside : outside)++;
      // The search can only fall short of the maximum.
      if (kept) {
        EXPECT_GT(reached, r * (1 - 2e-3)) << mesh.name << " r " << r;
      } else {
        EXPECT_LT(reached, r) << mesh.name << " r " << r;
      }
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

TEST(ConvexOracle, cube_edge_and_corner_have_their_closed_forms) {
  const double r = 0.2;
  const Opening opening(make_mesh(cube(), {}, 1).solid, r);
  // Towards the middle of an edge along the bisector, and towards a corner along the diagonal.
  const auto edge = opening.intersect({{5, 5, 0.1}, {-1, -1, 0}});
  ASSERT_TRUE(edge);
  const double on_edge = 0.3 + r / std::sqrt(2);
  EXPECT_NEAR(edge->t, 5 - on_edge, 1e-12);
  EXPECT_NEAR(edge->normal.x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(edge->normal.z, 0, 1e-12);
  const auto corner = opening.intersect({{5, 5, 5}, {-2, -2, -2}});
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->t, (5 - 0.3 - r / std::sqrt(3)) / 2, 1e-12);
  EXPECT_FALSE(corner->inside);
  const auto from_inside = opening.intersect({{0, 0, 0}, {1, 1, 1}});
  ASSERT_TRUE(from_inside);
  EXPECT_TRUE(from_inside->inside);
  EXPECT_NEAR(from_inside->t, 0.3 + r / std::sqrt(3), 1e-12);
  // Through the void between the sharp and the rounded edge.
  EXPECT_FALSE(opening.intersect({{0.48, 0.48, -3}, {0, 0, 1}}));
  EXPECT_TRUE(opening.in_sharp_solid({0.48, 0.48, 0}));
  EXPECT_NEAR(opening.least_distance({{0.48, 0.48, -3}, {0, 0, 1}}), 0.18 * std::sqrt(2) - r,
              1e-12);
}

TEST(ConvexOracle, hits_lie_on_the_surface_with_its_normal) {
  Random rng(13);
  int hits = 0;
  for (const SolidMesh& mesh : plain_meshes(13)) {
    const Opening opening(mesh.solid, uniform(rng, 0.01, 0.95) * inradius(mesh.solid));
    for (int i = 0; i < 40; ++i) {
      const Vec3d origin =
          mesh.solid.center + random_direction(rng) * mesh.solid.size * uniform(rng, 0, 3);
      const Vec3d target =
          mesh.corners[std::size_t(uniform_int(rng, 0, int(mesh.corners.size()) - 1))];
      const Ray ray{origin,
                    (target - origin) * 0.7 + random_direction(rng) * 0.05 * mesh.solid.size};
      const auto hit = opening.intersect(ray);
      if (!hit) {
        EXPECT_GT(opening.least_distance(ray), -1e-12 * mesh.solid.size);
        continue;
      }
      ++hits;
      const Vec3d x = ray.origin + ray.direction * hit->t;
      EXPECT_NEAR(opening.distance(x), 0, 1e-12 * mesh.solid.size) << mesh.name;
      EXPECT_GE(hit->inside ? dot(hit->normal, ray.direction) : -dot(hit->normal, ray.direction),
                -1e-9);
      // Nothing of the solid before an entry, nothing but the solid before an exit.
      const double middle = opening.distance(ray.origin + ray.direction * (0.5 * hit->t));
      EXPECT_TRUE(hit->inside ? middle < 1e-12 * mesh.solid.size : middle > 0) << mesh.name;
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(ConvexSolids, every_style_closes_the_same_solid) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const Polyhedron& p : make_solids(seed)) {
      Random rng(seed);
      MeshStyle style = random_style(rng);
      style.scale = 1;
      style.inward = seed % 2 == 0;
      const SolidMesh plain = make_mesh(p, {}, seed), mesh = make_mesh(p, style, seed);
      EXPECT_NEAR(signed_volume(mesh), signed_volume(plain) * (style.inward ? -1 : 1),
                  1e-5 * signed_volume(plain))
          << p.name;
      // Welded, every directed edge has its opposite exactly once.
      std::map<std::array<float, 3>, std::uint32_t> welded;
      std::multiset<std::pair<std::uint32_t, std::uint32_t>> directed;
      const auto weld = [&](std::uint32_t v) {
        const Vec3f q = mesh.positions[v];
        return welded.emplace(std::array{q.x, q.y, q.z}, std::uint32_t(welded.size()))
            .first->second;
      };
      for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) directed.emplace(weld(t[i]), weld(t[(i + 1) % 3]));
      for (const auto& [a, b] : directed) {
        EXPECT_EQ(directed.count({a, b}), 1U) << p.name;
        EXPECT_EQ(directed.count({b, a}), 1U) << p.name;
      }
    }
  }
}

TEST(ConvexSolids, corners_lie_on_or_under_every_plane) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const Polyhedron& p : make_solids(seed)) {
      Random rng(seed);
      const SolidMesh mesh = make_mesh(p, random_style(rng), seed);
      for (Vec3d c : mesh.corners)
        EXPECT_FALSE(
            find_violated(mesh.solid.planes, 0, c - mesh.solid.center, 1e-6 * mesh.solid.size))
            << p.name;
      EXPECT_EQ(mesh.corners.size() + mesh.solid.planes.size(), mesh.edges.size() + 2) << p.name;
    }
  }
}

TEST(ConvexSolids, crooked_apex_has_the_faces_asked_for) {
  Random rng(5);
  for (int sides = 4; sides <= 7; ++sides) {
    const Polyhedron p = crooked_pyramid(rng, sides);
    std::vector<int> faces_at(p.vertices.size());
    for (const auto& face : p.faces)
      for (auto v : face) ++faces_at[v];
    EXPECT_EQ(*std::max_element(faces_at.begin(), faces_at.end()), sides);
  }
}

}  // namespace
}  // namespace arris::oracle
