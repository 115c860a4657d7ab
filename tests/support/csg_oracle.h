// csg_oracle.h — what a CSG tree means, point by point, and random trees to try
// What       membership straight from the description, by other formulas than the kernel's where there are others:
//            distances, triangle solid angles, angles round outlines
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

#include "arris/csg.h"

namespace arris::test {

using CsgRandom = std::mt19937_64;

inline double uniform(CsgRandom& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline Vec3d random_vector(CsgRandom& random, double reach) {
  return {uniform(random, -reach, reach), uniform(random, -reach, reach),
          uniform(random, -reach, reach)};
}
inline Vec3d random_unit(CsgRandom& random) {
  for (;;) {
    const Vec3d v = random_vector(random, 1);
    if (length(v) > 0.1 && length(v) < 1) return normalize(v);
  }
}

// Sum of the angles under which the edges are seen.
inline bool region_holds(const CsgRegion& region, double x, double y) {
  double angle = 0;
  for (const auto& outline : region.outlines) {
    for (std::size_t i = 0; i < outline.size() && outline.size() > 2; ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      const double ax = a.x - x, ay = a.y - y, bx = b.x - x, by = b.y - y;
      angle += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
  }
  return std::abs(angle) > kPi;
}

// Sum of the solid angles of the triangles (van Oosterom and Strackee).
inline bool mesh_holds(const CsgMesh& mesh, Vec3d p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d a = mesh.vertices[i] - p, b = mesh.vertices[j] - p, c = mesh.vertices[k] - p;
    const double x = length(a), y = length(b), z = length(c);
    angle += 2 * std::atan2(dot(a, cross(b, c)),
                            x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
  }
  return std::abs(angle) > 2 * kPi;
}

// Ericson, "Real-Time Collision Detection", 5.1.5, by the regions of the triangle.
inline double distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const auto to_segment = [&](Vec3d from, Vec3d to) {
    const Vec3d along = to - from;
    const double u = std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
    return length(p - (from + along * u));
  };
  const Vec3d n = cross(b - a, c - a);
  const bool over = dot(cross(b - a, p - a), n) > 0 && dot(cross(c - b, p - b), n) > 0 &&
                    dot(cross(a - c, p - c), n) > 0;
  if (over) return std::abs(dot(n, p - a)) / length(n);
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

// Every triangle between three of the vertices lies in the hull, and those on its faces cover them.
inline double distance_to_polyhedron(const CsgPolyhedron& solid, Vec3d p) {
  const bool inside = std::ranges::all_of(
      solid.faces, [&](const CsgHalfSpace& f) { return dot(f.normal, p) <= f.d; });
  double best = inside ? 0 : INFINITY;
  const std::vector<Vec3d>& v = solid.vertices;
  for (std::size_t i = 0; i < v.size() && !inside; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        best = std::min(best, distance_to_triangle(p, v[i], v[j], v[k]));
      }
    }
  }
  return best;
}

struct PrimitiveHolds {
  Vec3d p;
  bool operator()(const CsgSphere& s) const { return s.radius > 0 && length(p) < s.radius; }
  bool operator()(const CsgBox& b) const {
    return p.x > b.low.x && p.y > b.low.y && p.z > b.low.z && p.x < b.high.x && p.y < b.high.y &&
           p.z < b.high.z;
  }
  bool operator()(const CsgCone& c) const {
    const double u = (p.z - c.z_low) / (c.z_high - c.z_low);
    return u > 0 && u < 1 &&
           std::hypot(p.x, p.y) < c.radius_low + u * (c.radius_high - c.radius_low);
  }
  bool operator()(const CsgTorus& t) const {
    return std::hypot(std::hypot(p.x, p.y) - t.ring_radius, p.z) < t.tube_radius;
  }
  bool operator()(const CsgHalfSpace& h) const { return dot(h.normal, p) < h.d; }
  bool operator()(const CsgPolyhedron& h) const {
    return std::ranges::all_of(h.faces, [&](const CsgHalfSpace& f) { return (*this)(f); });
  }
  bool operator()(const CsgMesh& m) const { return mesh_holds(m, p); }
  bool operator()(const CsgPrism& s) const {
    const double u = (p.z - s.z_low) / (s.z_high - s.z_low);
    if (!(u > 0 && u < 1)) return false;
    return region_holds(s.region, p.x / (1 + u * (s.scale_high.x - 1)),
                        p.y / (1 + u * (s.scale_high.y - 1)));
  }
  bool operator()(const CsgRevolution& r) const {
    return region_holds(r.region, std::hypot(p.x, p.y), p.z);
  }
  bool operator()(const CsgRounded& r) const {
    return distance_to_polyhedron(r.core, p) < r.radius;
  }
};

inline bool leaf_holds(const CsgLeaf& leaf, Vec3d p) {
  return std::visit(PrimitiveHolds{transform_point(inverse(leaf.object_from_primitive), p)},
                    leaf.primitive);
}

// By number, children before parents.
inline bool tree_holds(const CsgTree& tree, Vec3d p) {
  std::vector<bool> holds(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const CsgNode& node = tree.nodes[i];
    if (node.leaf != CsgNode::kInner) {
      holds[i] = leaf_holds(tree.leaves[node.leaf], p);
      continue;
    }
    bool any = false, all = !node.children.empty(), others = false;
    for (std::size_t k = 0; k < node.children.size(); ++k) {
      const bool in = holds[node.children[k]];
      any = any || in;
      all = all && in;
      others = others || (k > 0 && in);
    }
    holds[i] = node.operation == CsgOperation::unite       ? any
               : node.operation == CsgOperation::intersect ? all
                                                           : !others && any;
  }
  return !tree.nodes.empty() && holds[0];
}

// ------------------------------------------------------------------------------------------ random solids

inline CsgPolyhedron make_tetrahedron(std::array<Vec3d, 4> v) {
  CsgPolyhedron solid;
  solid.vertices.assign(v.begin(), v.end());
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = v[(i + 1) % 4], b = v[(i + 2) % 4], c = v[(i + 3) % 4];
    Vec3d n = normalize(cross(b - a, c - a));
    if (dot(n, v[i] - a) > 0) n = -n;
    solid.faces.push_back({n, dot(n, a)});
  }
  return solid;
}
inline CsgPolyhedron random_polyhedron(CsgRandom& random) {
  for (;;) {
    const std::array<Vec3d, 4> v{random_vector(random, 1), random_vector(random, 1),
                                 random_vector(random, 1), random_vector(random, 1)};
    if (std::abs(dot(v[1] - v[0], cross(v[2] - v[0], v[3] - v[0]))) > 0.3) {
      return make_tetrahedron(v);
    }
  }
}

// A star round (x, y), concave, with a hole.
inline CsgRegion random_region(CsgRandom& random, Vec2d middle) {
  CsgRegion region;
  const int points = 5 + int(random() % 6);
  std::vector<Vec2d> outer, inner;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * i / points, r = uniform(random, 0.4, 0.9);
    outer.push_back({middle.x + r * std::cos(angle), middle.y + r * std::sin(angle)});
    inner.push_back({middle.x + 0.3 * r * std::cos(-angle), middle.y + 0.3 * r * std::sin(-angle)});
  }
  region.outlines = {outer, inner};
  return region;
}

inline CsgMesh random_mesh(CsgRandom& random) {
  // A box with its vertices moved.
  CsgMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        Vec3d((i & 1) != 0 ? 0.7 : -0.7, (i & 2) != 0 ? 0.7 : -0.7, (i & 4) != 0 ? 0.7 : -0.7) +
        random_vector(random, 0.3));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline constexpr int kPrimitiveKinds = 11;

// Of about unit size; kind below kPrimitiveKinds: each of csg.h, prisms with flat and with curved walls.
inline CsgPrimitive random_primitive(CsgRandom& random, int kind) {
  switch (kind) {
    case 0:
      return CsgSphere{uniform(random, 0.5, 1)};
    case 1:
      return CsgBox{
          -Vec3d{uniform(random, 0.3, 1), uniform(random, 0.3, 1), uniform(random, 0.3, 1)},
          Vec3d{uniform(random, 0.3, 1), uniform(random, 0.3, 1), uniform(random, 0.3, 1)}};
    case 2: {
      const double low = uniform(random, 0.1, 1);
      const double high[] = {low, 0, uniform(random, 0.1, 1)};
      return CsgCone{uniform(random, -1, -0.2), uniform(random, 0.2, 1), low, high[random() % 3]};
    }
    case 3:
      return CsgTorus{uniform(random, 0.2, 0.8), uniform(random, 0.1, 0.5)};
    case 4:
      return random_polyhedron(random);
    case 5:
      return random_mesh(random);
    case 6: {
      const double s = random() % 3 == 0 ? 1 : uniform(random, 0, 1.4);
      return CsgPrism{random_region(random, {0, 0}), -0.6, 0.7, {s, s}};
    }
    case 7:
      return CsgPrism{random_region(random, {0.2, 0}),
                      -0.6,
                      0.7,
                      {uniform(random, 0.2, 1.4), uniform(random, 0.2, 1.4)}};
    case 8:
      return CsgRevolution{random_region(random, {1, 0})};
    case 9:
      return CsgRounded{random_polyhedron(random), uniform(random, 0.05, 0.4)};
    default:
      return CsgHalfSpace{random_unit(random), uniform(random, -0.5, 0.5)};
  }
}

inline Affine3d random_placement(CsgRandom& random, double reach) {
  const Vec3d z = random_unit(random), x = normalize(cross(z, random_unit(random)));
  const double scale = uniform(random, 0.5, 1.3);
  Affine3d m{{x * scale, cross(z, x) * scale, z * scale}, random_vector(random, reach)};
  const std::uint64_t more = random() % 4;
  if (more == 0) m.linear = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (more == 1) m.linear.x += z * 0.4;           // shear
  if (more == 2) m.linear.z = m.linear.z * -0.6;  // mirror
  return m;
}

// A full tree of the depth with two or three children each, bounded by the cube [-2, 2]³.
inline CsgTree random_tree(CsgRandom& random, int depth) {
  CsgTree tree;
  tree.name = "random";
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::intersect, {1, 2}});
  tree.nodes.push_back({0, CsgOperation::unite, {}});
  tree.leaves.push_back({CsgBox{Vec3d(-2), Vec3d(2)}, {}, {}});
  std::vector<std::pair<std::uint32_t, int>> open{{2, depth}};
  tree.nodes.emplace_back();
  while (!open.empty()) {
    const auto [index, left] = open.back();
    open.pop_back();
    if (left == 0 || random() % 8 == 0) {
      tree.nodes[index].leaf = std::uint32_t(tree.leaves.size());
      const MaterialId material{std::uint32_t(tree.leaves.size())};
      tree.leaves.push_back({random_primitive(random, int(random() % kPrimitiveKinds)),
                             random_placement(random, 0.8), material});
      continue;
    }
    tree.nodes[index].operation = CsgOperation(random() % 3);
    const std::uint64_t count = 2 + random() % 2;
    for (std::uint64_t i = 0; i < count; ++i) {
      tree.nodes[index].children.push_back(std::uint32_t(tree.nodes.size()));
      open.emplace_back(std::uint32_t(tree.nodes.size()), left - 1);
      tree.nodes.emplace_back();
    }
  }
  return tree;
}

inline CsgTree one_leaf(CsgPrimitive primitive, const Affine3d& placement = {}) {
  CsgTree tree;
  tree.name = "leaf";
  tree.nodes.push_back({0, CsgOperation::unite, {}});
  tree.leaves.push_back({std::move(primitive), placement, {}});
  return tree;
}

// operation of all the leaves
inline CsgTree flat_tree(CsgOperation operation, std::vector<CsgLeaf> leaves) {
  CsgTree tree;
  tree.name = "flat";
  tree.nodes.push_back({CsgNode::kInner, operation, {}});
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    tree.nodes[0].children.push_back(i + 1);
    tree.nodes.push_back({i, CsgOperation::unite, {}});
  }
  tree.leaves = std::move(leaves);
  return tree;
}

}  // namespace arris::test
