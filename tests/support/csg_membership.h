// csg_membership.h — is a point in a CSG tree? By each primitive's definition, without acceleration
// Guarantee  decided in double from the sentences of arris/csg.h; surfaces themselves may fall on either side
// Limits     CsgRounded costs the square of its vertices; winding numbers the whole mesh
// Source     solid angle of a triangle: Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983)
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "arris/csg.h"

namespace arris::test {

// How often the outlines wind round the point.
inline int winding_number(const CsgRegion& region, Vec2d p) {
  int winding = 0;
  for (const std::vector<Vec2d>& outline : region.outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
      if (a.y <= p.y && b.y > p.y && side > 0) ++winding;
      if (a.y > p.y && b.y <= p.y && side < 0) --winding;
    }
  }
  return winding;
}

inline double winding_number(const CsgMesh& mesh, Vec3d p) {
  double angle = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p,
                c = mesh.vertices[t[2]] - p;
    const double la = length(a), lb = length(b), lc = length(c);
    angle += 2 * std::atan2(dot(a, cross(b, c)),
                            la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return angle / (4 * kPi);
}

inline bool is_inside(const CsgSphere& s, Vec3d p) {
  return length_squared(p) <= s.radius * s.radius;
}
inline bool is_inside(const CsgBox& b, Vec3d p) {
  return min(p, b.low) == b.low && max(p, b.high) == b.high;
}
inline bool is_inside(const CsgCone& c, Vec3d p) {
  if (p.z < c.z_low || p.z > c.z_high) return false;
  const double s = (p.z - c.z_low) / (c.z_high - c.z_low);
  return std::hypot(p.x, p.y) <= c.radius_low + s * (c.radius_high - c.radius_low);
}
inline bool is_inside(const CsgTorus& t, Vec3d p) {
  return std::hypot(std::hypot(p.x, p.y) - t.ring_radius, p.z) <= t.tube_radius;
}
inline bool is_inside(const CsgHalfSpace& h, Vec3d p) {
  return dot(h.normal, p) <= h.d;
}
inline bool is_inside(const CsgPolyhedron& polyhedron, Vec3d p) {
  return std::all_of(polyhedron.faces.begin(), polyhedron.faces.end(),
                     [&](const CsgHalfSpace& face) { return is_inside(face, p); });
}
inline bool is_inside(const CsgMesh& mesh, Vec3d p) {
  return std::abs(winding_number(mesh, p)) > 0.5;
}
inline bool is_inside(const CsgPrism& prism, Vec3d p) {
  if (p.z < prism.z_low || p.z > prism.z_high) return false;
  const double s = (p.z - prism.z_low) / (prism.z_high - prism.z_low);
  const double scale_x = 1 + s * (prism.scale_high.x - 1);
  const double scale_y = 1 + s * (prism.scale_high.y - 1);
  if (!(scale_x > 0) || !(scale_y > 0)) return false;
  return winding_number(prism.region, {p.x / scale_x, p.y / scale_y}) != 0;
}
inline bool is_inside(const CsgRevolution& revolution, Vec3d p) {
  return winding_number(revolution.region, {std::hypot(p.x, p.y), p.z}) != 0;
}

inline double distance_to_segment(Vec3d a, Vec3d b, Vec3d p) {
  const Vec3d along = b - a;
  const double squared = length_squared(along);
  const double s = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return length(p - (a + along * s));
}

// The nearest point is in a face, or on the segment between two vertices: edges are such segments, and the
// others lie inside.
inline double distance_to(const CsgPolyhedron& core, Vec3d p) {
  if (!core.faces.empty() && is_inside(core, p)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3d& a : core.vertices) {
    for (const Vec3d& b : core.vertices) nearest = std::min(nearest, distance_to_segment(a, b, p));
  }
  for (const CsgHalfSpace& face : core.faces) {
    const double above = dot(face.normal, p) - face.d;
    if (above <= 0 || above >= nearest) continue;
    const Vec3d foot = p - face.normal * above;
    const bool in_face = std::all_of(
        core.faces.begin(), core.faces.end(),
        [&](const CsgHalfSpace& other) { return &other == &face || is_inside(other, foot); });
    if (in_face) nearest = above;
  }
  return nearest;
}
inline bool is_inside(const CsgRounded& rounded, Vec3d p) {
  return distance_to(rounded.core, p) <= rounded.radius;
}

inline bool is_inside(const CsgLeaf& leaf, Vec3d p) {
  const Vec3d q = transform_point(inverse(leaf.object_from_primitive), p);
  return std::visit([&](const auto& primitive) { return is_inside(primitive, q); }, leaf.primitive);
}

// p in the object's space.
inline bool is_inside(const CsgTree& tree, Vec3d p, std::uint32_t index = 0) {
  const CsgNode& node = tree.nodes[index];
  if (node.leaf != CsgNode::kInner) return is_inside(tree.leaves[node.leaf], p);
  if (node.children.empty()) return false;
  const auto in = [&](std::uint32_t child) { return is_inside(tree, p, child); };
  switch (node.operation) {
    case CsgOperation::unite:
      return std::any_of(node.children.begin(), node.children.end(), in);
    case CsgOperation::intersect:
      return std::all_of(node.children.begin(), node.children.end(), in);
    case CsgOperation::subtract:
      return in(node.children[0]) &&
             std::none_of(node.children.begin() + 1, node.children.end(), in);
  }
  return false;
}

}  // namespace arris::test
