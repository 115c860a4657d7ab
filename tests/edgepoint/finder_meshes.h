// finder_meshes.h — meshes the edge finder is tested with
// What       closed smooth, irregular like a scan, open, non-manifold, with triangles of no area
// Guarantee  same seed, same mesh
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "arris/scene.h"
#include "edgepoint/edge_mesh.h"
#include "geometry/shapes.h"

namespace arris::test {

using FinderRandom = std::mt19937_64;

inline double uniform(FinderRandom& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Vec3d random_point(FinderRandom& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

inline Mesh make_torus_mesh(double major, double minor, std::uint32_t around,
                            std::uint32_t across) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / across;
      const double r = major + minor * std::cos(v);
      mesh.positions.push_back(
          {float(r * std::cos(u)), float(r * std::sin(u)), float(minor * std::sin(v))});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return (i % around) * across + j % across;
  };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// A sphere with waves of several sizes and grain, as a scanner sees a head. 20 · 4^subdivisions triangles.
inline Mesh make_scan_like_mesh(int subdivisions, double grain, std::uint64_t seed) {
  Mesh mesh = make_icosphere_mesh(1, subdivisions);
  FinderRandom random(seed);
  for (Vec3f& p : mesh.positions) {
    const Vec3d d = normalize(Vec3d(p));
    double r = 1;
    for (int k = 0; k < 4; ++k) {
      const double f = 3.1 * std::exp2(k);
      r += 0.12 / std::exp2(1.2 * k) *
           (std::sin(f * d.x + k) * std::sin(1.1 * f * d.y + 2) + std::sin(1.3 * f * d.z + d.x));
    }
    p = Vec3f(d * (r + uniform(random, -grain, grain)));
  }
  return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b, Vec3f by = {}) {
  const auto offset = std::uint32_t(a.positions.size());
  for (const Vec3f p : b.positions) a.positions.push_back(p + by);
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return a;
}

// Without some of its triangles.
inline Mesh torn(Mesh mesh, double share, FinderRandom& random) {
  std::erase_if(mesh.triangles, [&](const Triangle&) { return uniform(random, 0, 1) < share; });
  return mesh;
}

// Some triangles divided about a point on one of their edges, and not their neighbours: triangles of no area
// fill the gap.
inline Mesh with_empty_triangles(Mesh mesh, FinderRandom& random) {
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (random() % 4 != 0) continue;
    const Triangle t = mesh.triangles[i];
    const auto m = std::uint32_t(mesh.positions.size());
    mesh.positions.push_back((mesh.positions[t[0]] + mesh.positions[t[1]]) * 0.5F);
    mesh.triangles[i] = {m, t[1], t[2]};
    mesh.triangles.push_back({t[0], m, t[2]});
    mesh.triangles.push_back({t[0], t[1], m});
  }
  return mesh;
}

inline WeldedMesh weld(const Mesh& mesh) {
  return make_welded_mesh({mesh.positions, mesh.triangles}, mesh.name);
}

inline EdgeMesh edges_of(const Mesh& mesh, const EdgeMeshOptions& options = {}) {
  return make_edge_mesh(weld(mesh), options);
}

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

inline std::vector<NamedMesh> make_finder_meshes(std::uint64_t seed) {
  FinderRandom random(seed);
  std::vector<NamedMesh> all;
  all.push_back({"box", make_box_mesh({1, 2, 3})});
  all.push_back({"plane", make_plane_mesh({2, 1})});
  all.push_back({"sphere", make_sphere_mesh(1, 24)});
  all.push_back({"ball", make_icosphere_mesh(1, 3)});
  all.push_back({"prism", make_prism_mesh({})});
  all.push_back({"torus", make_torus_mesh(1, 0.4, 40, 20)});
  all.push_back({"scan", make_scan_like_mesh(4, 0.02, seed)});
  all.push_back({"rough scan", make_scan_like_mesh(3, 0.1, seed)});
  all.push_back({"torn torus", torn(make_torus_mesh(1, 0.4, 30, 16), 0.1, random)});
  all.push_back({"torn box", torn(make_box_mesh({1, 1, 1}), 0.3, random)});
  all.push_back(
      {"touching boxes", joined(make_box_mesh({1, 1, 1}), make_box_mesh({1, 1, 1}), {1, 1, 0})});
  Mesh doubled = make_icosphere_mesh(1, 1);
  doubled.triangles.push_back(doubled.triangles.front());
  all.push_back({"doubled face", doubled});
  all.push_back({"empty triangles", with_empty_triangles(make_icosphere_mesh(1, 2), random)});
  Mesh soup;
  for (std::uint32_t i = 0; i < 60; ++i) {
    soup.positions.push_back(Vec3f(random_point(random, 1)));
  }
  for (int i = 0; i < 100; ++i) {
    soup.triangles.push_back(
        {std::uint32_t(random() % 60), std::uint32_t(random() % 60), std::uint32_t(random() % 60)});
  }
  all.push_back({"soup", soup});
  Mesh small_far = make_scan_like_mesh(2, 0.05, seed);
  for (Vec3f& p : small_far.positions) p = p * 0.01F + Vec3f(100, -200, 300);
  all.push_back({"small and far", small_far});
  return all;
}

// Anywhere, at infinity, near, within, on vertices and edges, in planes of faces.
inline HomogeneousPoint random_viewpoint(const EdgeMesh& mesh, FinderRandom& random) {
  const Vec3d center = (mesh.bounds_min + mesh.bounds_max) * 0.5;
  const double size = length(mesh.bounds_max - mesh.bounds_min);
  const auto corner = [&] {
    const Triangle& t = mesh.triangles[random() % mesh.triangles.size()];
    return std::array{Vec3d(mesh.vertices[t[0]]), Vec3d(mesh.vertices[t[1]]),
                      Vec3d(mesh.vertices[t[2]])};
  };
  switch (random() % 8) {
    case 0:
      return {random_point(random, 1), 0};
    case 1:
      return {Vec3d{0, 0, 1}, 0};
    case 2:
      return {center + random_point(random, size * 1e4), 1};
    case 3:
      return {center + random_point(random, size / 4), 1};
    case 4:
      return {corner()[0], 1};
    case 5: {
      const auto c = corner();
      return {
          c[0] + (c[1] - c[0]) * uniform(random, -3, 3) + (c[2] - c[0]) * uniform(random, -3, 3),
          1};
    }
    case 6: {
      const auto c = corner();
      return {c[1] - c[0], 0};
    }
    default:
      return {center + random_point(random, size * 2), 1};
  }
}

}  // namespace arris::test
