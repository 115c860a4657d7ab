#include "rounding/bevel_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "arris/error.h"
#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/mesh_checks.h"
#include "support/nonconvex_solids.h"

namespace arris {
namespace {

using oracle::Polyhedron;

Mesh to_mesh(const Polyhedron& polyhedron, double scale = 1) {
  Mesh mesh;
  mesh.name = polyhedron.name;
  for (const Vec3d& p : polyhedron.vertices) mesh.positions.push_back(Vec3f(p * scale));
  for (const auto& face : polyhedron.faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      mesh.triangles.push_back({face[0], face[i], face[i + 1]});
    }
  }
  return mesh;
}

Mesh unit_cube() {
  return to_mesh(oracle::box({1, 1, 1}));
}

Mesh prism_over(const oracle::Outline& outline) {
  oracle::TriangleSoup prism = oracle::prism_over("prism", outline, {});
  Mesh mesh;
  mesh.name = std::move(prism.name);
  mesh.positions = std::move(prism.positions);
  mesh.triangles = std::move(prism.triangles);
  return mesh;
}

Mesh l_prism() {
  return prism_over({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
}

Mesh cylinder(int sides) {
  oracle::Outline circle;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * kPi * i / sides;
    circle.push_back({std::cos(a), std::sin(a)});
  }
  return prism_over(circle);
}

// As the knob of a toy brick: no lid below.
Mesh knob(int sides) {
  Mesh mesh = cylinder(sides);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return t[0] < std::uint32_t(sides) && t[1] < std::uint32_t(sides) &&
           t[2] < std::uint32_t(sides);
  });
  return mesh;
}

// A 1 x 1 x 1 box in the middle of a 3 x 3 plate of thickness 0.5, as one solid.
Mesh box_on_plate() {
  Mesh mesh;
  mesh.name = "box on plate";
  const auto square = [&](float half, float z) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
    return first;
  };
  const auto sides = [&](std::uint32_t low, std::uint32_t high) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      mesh.triangles.push_back({low + i, low + j, high + j});
      mesh.triangles.push_back({low + i, high + j, high + i});
    }
  };
  const std::uint32_t bottom = square(1.5F, -0.5F), rim = square(1.5F, 0), foot = square(0.5F, 0),
                      top = square(0.5F, 1);
  mesh.triangles = {{bottom, bottom + 2, bottom + 1},
                    {bottom, bottom + 3, bottom + 2},
                    {top, top + 1, top + 2},
                    {top, top + 2, top + 3}};
  sides(bottom, rim);
  sides(rim, foot);
  sides(foot, top);
  return mesh;
}

// A prism with a slanted lid whose edges turn by more than 30° at some and less at others, so that rounded
// edges run into sharp ones.
Mesh wedge() {
  Mesh mesh = prism_over({{0, 0}, {2, 0}, {2, 1}, {0, 1}});
  for (const std::uint32_t i : {5U, 6U}) mesh.positions[i].z = 0.05F;
  return mesh;
}

RoundingOptions radius_of(double radius) {
  RoundingOptions options;
  options.radius = radius;
  return options;
}

// Volume of the box of edges a, b, c rounded by r.
double rounded_box_volume(Vec3d size, double r) {
  const Vec3d core = size - Vec3d(2 * r);
  return core.x * core.y * core.z + 2 * r * (core.x * core.y + core.y * core.z + core.z * core.x) +
         kPi * r * r * (core.x + core.y + core.z) + 4.0 / 3 * kPi * r * r * r;
}

// Least cosine between a vertex normal and the normals of the triangles around it.
double least_normal_cosine(const Mesh& mesh) {
  double least = 1;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const Vec3d n = cross(b - a, c - a);
    if (!(length(n) > 1e-9)) continue;
    for (const std::uint32_t v : t) {
      least = std::min(least, dot(normalize(n), Vec3d(mesh.normals[v])));
    }
  }
  return least;
}

TEST(BevelMesh, has_the_triangles_of_a_modellers_bevel) {
  for (const int n : {1, 3, 10}) {
    const BevelMesh bevel = make_bevel_mesh(unit_cube(), radius_of(0.1), n);
    EXPECT_EQ(bevel.mesh.triangles.size(), std::size_t(12 + 24 * n + 8 * n * n)) << n;
    EXPECT_EQ(bevel.bevelled_solids, 1U);
    EXPECT_EQ(bevel.rounded_edges, 12U);
    EXPECT_EQ(bevel.rounded_corners, 8U);
    // Vertices are shared between faces, strips and patches.
    EXPECT_EQ(bevel.mesh.positions.size(), std::size_t(24 + 24 * (n - 1) + 4 * (n - 1) * (n - 2)))
        << n;
  }
}

TEST(BevelMesh, volume_of_a_box_converges_to_the_rounded_volume_from_below) {
  const Vec3d size(1, 0.8, 0.5);
  const Mesh box = to_mesh(oracle::box(size));
  Vec3d low(1e9), high(-1e9);
  for (const Vec3f& p : box.positions) {
    low = min(low, Vec3d(p));
    high = max(high, Vec3d(p));
  }
  const double exact = rounded_box_volume(high - low, 0.1);
  double last_error = 1;
  for (const int n : {1, 2, 4, 8, 16, 32}) {
    const Mesh mesh = make_bevel_mesh(box, radius_of(0.1), n).mesh;
    const double error = exact - test::volume_of(mesh);
    EXPECT_GT(error, 0) << n;
    EXPECT_LT(error, last_error * 0.3) << n;
    last_error = error;
  }
  EXPECT_LT(last_error, 1e-4 * exact);
}

TEST(BevelMesh, convex_solids_are_closed_and_their_vertices_lie_on_the_rounded_surface) {
  std::size_t solids = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const Polyhedron& polyhedron : oracle::make_solids(seed)) {
      oracle::MeshStyle style;
      const oracle::SolidMesh made = oracle::make_mesh(polyhedron, style, seed);
      Mesh mesh;
      mesh.positions = made.positions;
      mesh.triangles = made.triangles;
      const double inradius = oracle::inradius(made.solid);
      for (const double part : {0.02, 0.3, 0.8}) {
        RoundingOptions options = radius_of(part * inradius);
        options.min_angle = 0;
        const BevelMesh bevel = make_bevel_mesh(mesh, options, 3, made.name);
        const std::string label = made.name + " r " + std::to_string(part);
        EXPECT_EQ(bevel.kept_solids, 0U) << label;
        EXPECT_TRUE(test::is_closed(bevel.mesh)) << label;
        const oracle::Opening opening(made.solid, options.radius);
        double farthest = 0, least_cosine = 1;
        for (std::size_t i = 0; i < bevel.mesh.positions.size(); ++i) {
          const Vec3d p(bevel.mesh.positions[i]);
          farthest = std::max(farthest, std::abs(opening.distance(p)));
          least_cosine = std::min(
              least_cosine, dot(normalize(opening.from_erosion(p)), Vec3d(bevel.mesh.normals[i])));
        }
        EXPECT_LT(farthest, 2e-6 * made.solid.size) << label;
        EXPECT_GT(least_cosine, part < 0.1 ? 0.999 : 0.99999) << label;
        EXPECT_GT(test::volume_of(bevel.mesh), 0) << label;
        EXPECT_LT(test::volume_of(bevel.mesh), test::volume_of(mesh)) << label;
        ++solids;
      }
    }
  }
  EXPECT_GT(solids, 200U);
}

struct Case {
  const char* name;
  Mesh mesh;
  double radius;
  bool closed;
};

std::vector<Case> mixed_solids() {
  std::vector<Case> cases;
  cases.push_back({"cylinder", cylinder(32), 0.1, true});
  cases.push_back({"thick cylinder rounding", cylinder(24), 0.4, true});
  cases.push_back({"knob", knob(24), 0.1, false});
  cases.push_back({"L prism", l_prism(), 0.1, true});
  cases.push_back({"box on plate", box_on_plate(), 0.1, true});
  cases.push_back({"wedge", wedge(), 0.02, true});
  return cases;
}

TEST(BevelMesh, rounds_solids_with_sharp_edges_without_holes) {
  for (const Case& c : mixed_solids()) {
    for (const int n : {1, 3, 10}) {
      const BevelMesh bevel = make_bevel_mesh(c.mesh, radius_of(c.radius), n, c.name);
      EXPECT_EQ(bevel.bevelled_solids, 1U) << c.name;
      EXPECT_EQ(bevel.kept_solids, 0U) << c.name;
      EXPECT_EQ(test::is_closed(bevel.mesh), c.closed) << c.name;
      EXPECT_GT(bevel.rounded_edges, 0U) << c.name;
      const double sharp = test::volume_of(c.mesh), rounded = test::volume_of(bevel.mesh);
      EXPECT_LT(rounded, sharp) << c.name;
      EXPECT_GT(rounded, 0.7 * sharp) << c.name;
      // No triangle is folded over, and normals are those of the surface.
      EXPECT_GT(least_normal_cosine(bevel.mesh), n == 1   ? 0.45
                                                 : n == 3 ? 0.85
                                                          : 0.98)
          << c.name << " N " << n;
    }
  }
}

// By Pappus: the rim of a true cylinder takes away (1 − π/4) r² · 2π(R − x) with x = r (10 − 3π)/(12 − 3π).
TEST(BevelMesh, rim_of_a_faceted_cylinder_takes_away_what_it_should) {
  const double r = 0.2;
  const Mesh sharp = cylinder(64);
  RoundingOptions options = radius_of(r);
  const Mesh rounded = make_bevel_mesh(sharp, options, 32).mesh;
  const double x = r * (10 - 3 * kPi) / (12 - 3 * kPi);
  const double expected = 2 * (1 - kPi / 4) * r * r * 2 * kPi * (1 - x);
  EXPECT_NEAR(test::volume_of(sharp) - test::volume_of(rounded), expected, 0.01 * expected);
}

// What is lost along an edge is its section times the length; a corner of three edges loses less than three
// sections (an octant of a ball stays), and at the notch the strips go on to the mitre plane.
TEST(BevelMesh, rounding_of_an_L_takes_away_what_it_should) {
  const double r = 0.1;
  const Mesh rounded = make_bevel_mesh(l_prism(), radius_of(r), 24).mesh;
  const double section = (1 - kPi / 4) * r * r;
  const double corner = 3 * section * r - r * r * r * (1 - kPi / 6);
  const double x = r * (10 - 3 * kPi) / (12 - 3 * kPi);  // centroid of the section
  const double length = 2 * 8 + 5;
  const double expected = length * section - 10 * corner + 2 * 2 * section * x;
  EXPECT_NEAR(test::volume_of(l_prism()) - test::volume_of(rounded), expected, 0.005 * expected);
}

TEST(BevelMesh, keeps_source_materials_uv_and_normals) {
  Mesh mesh = to_mesh(oracle::box({1, 1, 1}));
  for (const Vec3f& p : mesh.positions) mesh.uvs.push_back({2 * p.x + p.y, p.z - p.y});
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangle_materials.push_back(MaterialId{t / 2});
  }
  const Mesh bevel = make_bevel_mesh(mesh, radius_of(0.1), 4).mesh;
  ASSERT_EQ(bevel.uvs.size(), bevel.positions.size());
  ASSERT_EQ(bevel.triangle_materials.size(), bevel.triangles.size());
  EXPECT_TRUE(test::is_closed(bevel));
  std::map<std::uint32_t, double> area;
  for (std::size_t i = 0; i < bevel.triangles.size(); ++i) {
    const Triangle& t = bevel.triangles[i];
    const Vec3d a(bevel.positions[t[0]]), b(bevel.positions[t[1]]), c(bevel.positions[t[2]]);
    area[bevel.triangle_materials[i].index] += length(cross(b - a, c - a)) / 2;
    const Vec3d n = normalize(cross(b - a, c - a));
    if (max_component(max(n, -n)) < 1 - 1e-6) continue;
    // On a face the map is the source's.
    for (const std::uint32_t v : t) {
      const Vec3f p = bevel.positions[v];
      EXPECT_NEAR(bevel.uvs[v].x, 2 * p.x + p.y, 1e-5);
      EXPECT_NEAR(bevel.uvs[v].y, p.z - p.y, 1e-5);
    }
  }
  ASSERT_EQ(area.size(), 6U);
  for (const auto& [material, a] : area) {
    EXPECT_NEAR(a, area[0], 0.01) << material;
  }
}

TEST(BevelMesh, keeps_triangles_and_says_so_where_a_face_has_several_materials) {
  Mesh mesh = unit_cube();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangle_materials.push_back(MaterialId{t % 2});
  }
  const BevelMesh bevel = make_bevel_mesh(mesh, radius_of(0.1), 2);
  EXPECT_EQ(bevel.kept_solids, 1U);
  EXPECT_EQ(bevel.mesh.triangles.size(), 12U);
  ASSERT_FALSE(bevel.notes.empty());
  EXPECT_NE(bevel.notes.back().text().find("several materials"), std::string::npos);
}

TEST(BevelMesh, rejects_what_the_exact_rounding_rejects) {
  EXPECT_THROW(make_bevel_mesh(unit_cube(), radius_of(0.6), 2, "cube"), Error);
  EXPECT_THROW(make_bevel_mesh(unit_cube(), radius_of(0), 2, "cube"), Error);
}

}  // namespace
}  // namespace arris
