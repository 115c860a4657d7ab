#include "rounding/convex_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace arris::bench {

Piece make_box(Vec3d low, Vec3d high) {
  Piece box;
  for (int i = 0; i < 8; ++i)
    box.vertices.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  box.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return box;
}

Piece make_tetrahedron(double half_edge) {
  const double s = half_edge;
  return {{{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

Piece make_prism(int sides, double radius, double low, double high, Bottom bottom) {
  Piece prism;
  const auto n = std::uint32_t(sides);
  for (double z : {low, high})
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * kPi * i / n;
      prism.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    prism.faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  std::vector<std::uint32_t> top(n), base(n);
  std::iota(top.begin(), top.end(), n);
  std::iota(base.rbegin(), base.rend(), 0U);
  prism.faces.push_back(top);
  if (bottom == Bottom::closed) prism.faces.push_back(base);
  return prism;
}

Piece make_dodecahedron(double circumradius) {
  const double g = std::numbers::phi, s = circumradius / std::sqrt(3.0);
  Piece solid;
  for (double a : {-1.0, 1.0})
    for (double b : {-1.0, 1.0}) {
      for (double c : {-1.0, 1.0}) solid.vertices.push_back(Vec3d(a, b, c) * s);
      solid.vertices.push_back(Vec3d(0, a / g, b * g) * s);
      solid.vertices.push_back(Vec3d(a / g, b * g, 0) * s);
      solid.vertices.push_back(Vec3d(b * g, 0, a / g) * s);
    }
  // Each face's normal points at a corner of the dual icosahedron; its corners are those farthest along it.
  for (double a : {-1.0, 1.0})
    for (double b : {-g, g})
      for (const Vec3d axis : {Vec3d(0, b, a), Vec3d(b, a, 0), Vec3d(a, 0, b)}) {
        const Vec3d n = normalize(axis);
        double farthest = 0;
        for (Vec3d v : solid.vertices) farthest = std::max(farthest, dot(n, v));
        std::vector<std::uint32_t> face;
        for (std::uint32_t i = 0; i < solid.vertices.size(); ++i)
          if (dot(n, solid.vertices[i]) > farthest * (1 - 1e-6)) face.push_back(i);
        const Vec3d u = normalize(solid.vertices[face[0]] - n * farthest), w = cross(n, u);
        std::sort(face.begin(), face.end(), [&](std::uint32_t i, std::uint32_t j) {
          const Vec3d p = solid.vertices[i], q = solid.vertices[j];
          return std::atan2(dot(p, w), dot(p, u)) < std::atan2(dot(q, w), dot(q, u));
        });
        solid.faces.push_back(face);
      }
  return solid;
}

double lowest_z(const Piece& piece, const Affine3d& placed) {
  double low = std::numeric_limits<double>::infinity();
  for (Vec3d v : piece.vertices) low = std::min(low, transform_point(placed, v).z);
  return low;
}

void append(Mesh& mesh, const Piece& piece, const Affine3d& placed) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (Vec3d v : piece.vertices) mesh.positions.push_back(Vec3f(transform_point(placed, v)));
  for (const auto& face : piece.faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      mesh.triangles.push_back({first + face[0], first + face[i - 1], first + face[i]});
}

}  // namespace arris::bench
