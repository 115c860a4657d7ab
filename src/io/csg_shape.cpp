#include "io/csg_shape.h"

#include <cmath>

namespace arris {
namespace {

// Six digits are written of a matrix.
constexpr double kSixDigits = 4e-6;

double dot(Vec2d a, Vec2d b) {
  return a.x * b.x + a.y * b.y;
}

// How far a primitive reaches in a direction, which need not be unit.
double reach(const CsgSphere& s, Vec3d d) {
  return s.radius * length(d);
}
double reach(const CsgBox& b, Vec3d d) {
  const Vec3d corner(d.x > 0 ? b.high.x : b.low.x, d.y > 0 ? b.high.y : b.low.y,
                     d.z > 0 ? b.high.z : b.low.z);
  return dot(d, corner);
}
double reach(const CsgCone& c, Vec3d d) {
  const double across = std::hypot(d.x, d.y);
  return std::max(c.z_low * d.z + c.radius_low * across, c.z_high * d.z + c.radius_high * across);
}
double reach(const CsgTorus& t, Vec3d d) {
  return t.ring_radius * std::hypot(d.x, d.y) + t.tube_radius * length(d);
}
// Half-spaces only cut.
double reach(const CsgHalfSpace& /*h*/, Vec3d /*d*/) {
  return 1e300;
}
double reach(const std::vector<Vec3d>& vertices, Vec3d d) {
  double most = -1e300;
  for (const Vec3d& p : vertices) most = std::max(most, dot(p, d));
  return most;
}
double reach(const CsgPolyhedron& p, Vec3d d) {
  return reach(p.vertices, d);
}
double reach(const CsgMesh& m, Vec3d d) {
  return reach(m.vertices, d);
}
double reach(const CsgPrism& prism, Vec3d d) {
  double most = -1e300;
  for (const Outline& outline : prism.region.outlines) {
    for (const Vec2d& p : outline) {
      most = std::max(
          {most, p.x * d.x + p.y * d.y + prism.z_low * d.z,
           p.x * prism.scale_high.x * d.x + p.y * prism.scale_high.y * d.y + prism.z_high * d.z});
    }
  }
  return most;
}
double reach(const CsgRevolution& revolution, Vec3d d) {
  double most = -1e300;
  for (const Outline& outline : revolution.region.outlines) {
    for (const Vec2d& p : outline) {
      most = std::max(most, p.x * std::hypot(d.x, d.y) + p.y * d.z);
    }
  }
  return most;
}
double reach(const CsgRounded& rounded, Vec3d d) {
  return reach(rounded.core, d) + rounded.radius * length(d);
}

double reach(const SolidShape& shape, Vec3d d) {
  if (shape.leaf) {
    const Affine3d& m = shape.leaf->object_from_primitive;
    const Vec3d local = transpose(m.linear) * d;
    return dot(m.translation, d) +
           std::visit([&](const auto& primitive) { return reach(primitive, local); },
                      shape.leaf->primitive);
  }
  const bool unite = shape.operation == CsgOperation::unite;
  double most = unite ? -1e300 : 1e300;
  for (const SolidShape& child : shape.children) {
    most = unite ? std::max(most, reach(child, d)) : std::min(most, reach(child, d));
    if (shape.operation == CsgOperation::subtract) break;
  }
  return most;
}

template <class Shape, class Visit>
void visit_leaves(Shape& shape, const Visit& visit) {
  if (shape.leaf) visit(shape);
  for (Shape& child : shape.children) visit_leaves(child, visit);
}

const SolidShape* find_colored(const SolidShape& shape) {
  if (shape.leaf && shape.has_color) return &shape;
  for (const SolidShape& child : shape.children) {
    if (const SolidShape* found = find_colored(child)) return found;
  }
  return nullptr;
}

std::uint32_t add_node(CsgTree& tree, SolidShape& shape) {
  const auto index = std::uint32_t(tree.nodes.size());
  tree.nodes.emplace_back();
  if (shape.leaf) {
    tree.nodes[index].leaf = std::uint32_t(tree.leaves.size());
    tree.leaves.push_back(std::move(*shape.leaf));
    return index;
  }
  tree.nodes[index].operation = shape.operation;
  std::vector<std::uint32_t> children;
  for (SolidShape& child : shape.children) children.push_back(add_node(tree, child));
  tree.nodes[index].children = std::move(children);
  return index;
}

}  // namespace

bool keeps_volume(const Mat3d& m) {
  const double scale = std::max({length(m.x), length(m.y), length(m.z)});
  return std::isfinite(scale) && std::abs(determinant(m)) > 1e-12 * scale * scale * scale;
}

SolidShape LeafMaker::operator()(CsgPrimitive primitive, const Affine3d& local) const {
  SolidShape shape;
  const Affine3d m = place * local;
  if (!keeps_volume(m.linear) || !is_finite(m.translation)) return shape;
  shape.leaf = CsgLeaf{std::move(primitive), m, material};
  shape.has_color = has_color;
  return shape;
}

FlatShape make_flat(FlatDisc disc) {
  FlatShape shape;
  shape.leaf = disc;
  return shape;
}

FlatShape make_flat(CsgRegion region) {
  FlatShape shape;
  if (!region.outlines.empty()) shape.leaf = std::move(region);
  return shape;
}

CsgRegion facets_of(const FlatDisc& disc) {
  Outline outline;
  for (int i = 0; i < disc.facets; ++i) {
    const double angle = 2 * kPi * i / disc.facets;
    outline.push_back(disc.center + disc.u * std::cos(angle) + disc.v * std::sin(angle));
  }
  if (cross(disc.u, disc.v) < 0) std::ranges::reverse(outline);
  return {{outline}};
}

std::optional<double> round_radius(const FlatDisc& disc) {
  const double uu = dot(disc.u, disc.u), vv = dot(disc.v, disc.v);
  if (std::abs(uu - vv) > kSixDigits * uu || std::abs(dot(disc.u, disc.v)) > kSixDigits * uu) {
    return std::nullopt;
  }
  return std::sqrt((uu + vv) / 2);
}

Bounds2d bounds_of(const FlatDisc& disc) {
  const Vec2d half{std::hypot(disc.u.x, disc.v.x), std::hypot(disc.u.y, disc.v.y)};
  return {disc.center - half, disc.center + half};
}

Bounds2d bounds_of(const FlatShape& shape) {
  if (shape.leaf) return std::visit([](const auto& leaf) { return bounds_of(leaf); }, *shape.leaf);
  Bounds2d bounds;
  for (std::size_t i = 0; i < shape.children.size(); ++i) {
    const Bounds2d child = bounds_of(shape.children[i]);
    if (i > 0 && shape.operation == CsgOperation::subtract) break;
    if (i > 0 && shape.operation == CsgOperation::intersect) {
      bounds.low = {std::max(bounds.low.x, child.low.x), std::max(bounds.low.y, child.low.y)};
      bounds.high = {std::min(bounds.high.x, child.high.x), std::min(bounds.high.y, child.high.y)};
    } else {
      bounds.add(child);
    }
  }
  return bounds;
}

bool is_inside(const FlatShape& shape, Vec2d p) {
  if (shape.leaf) {
    if (const auto* region = std::get_if<CsgRegion>(&*shape.leaf)) return is_inside(*region, p);
    const FlatDisc& disc = std::get<FlatDisc>(*shape.leaf);
    const double det = cross(disc.u, disc.v);
    const Vec2d d = p - disc.center;
    return std::hypot(cross(d, disc.v) / det, cross(disc.u, d) / det) <= 1;
  }
  const auto in = [&](const FlatShape& child) { return is_inside(child, p); };
  const auto begin = shape.children.begin(), end = shape.children.end();
  switch (shape.operation) {
    case CsgOperation::unite:
      return std::any_of(begin, end, in);
    case CsgOperation::intersect:
      return begin != end && std::all_of(begin, end, in);
    case CsgOperation::subtract:
      return begin != end && in(*begin) && std::none_of(begin + 1, end, in);
  }
  return false;
}

void transform(FlatShape& shape, const Affine2d& m) {
  const double scale = std::hypot(m.x.x, m.x.y) + std::hypot(m.y.x, m.y.y);
  if (!(std::abs(cross(m.x, m.y)) > 1e-12 * scale * scale) || !std::isfinite(scale)) shape = {};
  const bool mirrors = cross(m.x, m.y) < 0;
  visit_leaves(shape, [&](FlatShape& s) {
    if (auto* disc = std::get_if<FlatDisc>(&*s.leaf)) {
      *disc = {m.point(disc->center), m.vector(disc->u), m.vector(disc->v), disc->facets};
      return;
    }
    for (Outline& outline : std::get<CsgRegion>(*s.leaf).outlines) {
      for (Vec2d& p : outline) p = m.point(p);
      if (mirrors) std::ranges::reverse(outline);
    }
  });
}

Bounds3d bounds_of(const SolidShape& shape) {
  Bounds3d bounds;
  if (shape.is_empty()) return bounds;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d d;
    d[axis] = 1;
    bounds.high[axis] = reach(shape, d);
    bounds.low[axis] = -reach(shape, -d);
  }
  return bounds;
}

void transform(SolidShape& shape, const Affine3d& m) {
  if (!keeps_volume(m.linear) || !is_finite(m.translation)) shape = {};
  visit_leaves(shape, [&](SolidShape& s) {
    s.leaf->object_from_primitive = m * s.leaf->object_from_primitive;
  });
}

void color_holes(std::vector<SolidShape>& operands) {
  if (operands.empty()) return;
  const SolidShape* const colored = find_colored(operands[0]);
  if (colored == nullptr) return;
  const MaterialId material = colored->leaf->material;
  for (std::size_t i = 1; i < operands.size(); ++i) {
    visit_leaves(operands[i], [&](SolidShape& s) {
      if (s.has_color) return;
      s.leaf->material = material;
      s.has_color = true;
    });
  }
}

std::size_t count_leaves(const SolidShape& shape) {
  std::size_t count = 0;
  visit_leaves(shape, [&](const SolidShape&) { ++count; });
  return count;
}

CsgTree make_tree(SolidShape shape, std::string name) {
  CsgTree tree;
  tree.name = std::move(name);
  add_node(tree, shape);
  return tree;
}

}  // namespace arris
