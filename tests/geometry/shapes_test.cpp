#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>

namespace arris {
namespace {

using Point = std::tuple<float, float, float>;
Point point(Vec3f p) {
  return {p.x, p.y, p.z};
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    sum += dot(Vec3d(mesh.positions[t[0]]),
               cross(Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])));
  }
  return sum / 6;
}

// Each directed edge once, its reverse once: a closed surface of one orientation.
void expect_closed(const Mesh& mesh) {
  std::map<std::pair<Point, Point>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{point(mesh.positions[t[k]]), point(mesh.positions[t[(k + 1) % 3]])}];
    }
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << mesh.name;
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << mesh.name;
    ASSERT_NE(edge.first, edge.second) << mesh.name << ": a triangle without area";
  }
}

void expect_normals_outward(const Mesh& mesh) {
  if (mesh.normals.empty()) return;
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3f flat = cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                             mesh.positions[t[2]] - mesh.positions[t[0]]);
    for (const std::uint32_t i : t) {
      EXPECT_NEAR(length(mesh.normals[i]), 1, 1e-5);
      EXPECT_GT(dot(mesh.normals[i], flat), 0) << mesh.name;
    }
  }
}

struct ShapeCase {
  std::string name;
  Mesh mesh;
  double volume;
  std::size_t triangles;
};

std::vector<ShapeCase> shape_cases() {
  const double phi = std::numbers::phi, s3 = std::sqrt(3.0);
  // Volumes of the regular solids of edge a, with a from the radius of their corners.
  const double tet_edge = 4 / std::sqrt(6.0), oct_edge = std::sqrt(2.0);
  const double dod_edge = 2 / (s3 * phi), ico_edge = 1 / std::sin(2 * kPi / 5);
  return {
      {"box", make_box_mesh({1, 2, 3}), 6, 12},
      {"tetrahedron", make_tetrahedron_mesh(1), std::pow(tet_edge, 3) / (6 * std::sqrt(2.0)), 4},
      {"octahedron", make_octahedron_mesh(1), std::pow(oct_edge, 3) * std::sqrt(2.0) / 3, 8},
      {"dodecahedron", make_dodecahedron_mesh(1),
       std::pow(dod_edge, 3) * (15 + 7 * std::sqrt(5.0)) / 4, 36},
      {"icosahedron", make_icosahedron_mesh(2),
       8 * std::pow(ico_edge, 3) * 5 * (3 + std::sqrt(5.0)) / 12, 20},
      {"prism", make_prism_mesh({1, 1, 2, 6}), 1.5 * s3 * 2, 20},
      {"pyramid", make_prism_mesh({1, 0, 3, 4}), 2, 6},
      {"upside-down pyramid", make_prism_mesh({0, 1, 3, 4}), 2, 6},
      {"frustum", make_prism_mesh({2, 1, 3, 4}), 3.0 / 3 * (8 + 2 + 4), 12},
      {"cylinder", make_cone_mesh({1, 1, 2, 512}), 2 * kPi * std::sin(kPi / 256) * 256 / kPi, 2044},
      {"cone", make_cone_mesh({1, 0, 3, 512}), kPi * std::sin(kPi / 256) * 256 / kPi, 1022},
      {"tip down", make_cone_mesh({0, 1, 3, 512}), kPi * std::sin(kPi / 256) * 256 / kPi, 1022},
      {"sphere", make_sphere_mesh(1, 512), 4.0 / 3 * kPi, 261120},
      {"icosphere", make_icosphere_mesh(1, 6), 4.0 / 3 * kPi, 81920},
  };
}

TEST(Shapes, are_closed_and_have_the_volume_of_their_solid) {
  for (const ShapeCase& shape : shape_cases()) {
    SCOPED_TRACE(shape.name);
    expect_closed(shape.mesh);
    expect_normals_outward(shape.mesh);
    EXPECT_NEAR(volume(shape.mesh) / shape.volume, 1, 5e-4);
    EXPECT_EQ(shape.mesh.triangles.size(), shape.triangles);
  }
}

TEST(Shapes, are_closed_with_the_fewest_segments) {
  for (const Mesh& mesh : {make_sphere_mesh(1, 3), make_cone_mesh({1, 1, 1, 3}),
                           make_cone_mesh({1, 0, 1, 3}), make_prism_mesh({1, 0.5, 1, 3})}) {
    expect_closed(mesh);
    EXPECT_GT(volume(mesh), 0);
  }
}

TEST(Shapes, faces_the_plane_up) {
  const Mesh plane = make_plane_mesh({2, 4});
  double area = 0;
  for (const Triangle& t : plane.triangles) {
    area += cross(plane.positions[t[1]] - plane.positions[t[0]],
                  plane.positions[t[2]] - plane.positions[t[0]])
                .z /
            2;
  }
  EXPECT_EQ(area, 8);
}

}  // namespace
}  // namespace arris
