// csg_shape.h — plane and solid shapes while a .csg file is read: trees of leaves and operations
// What       FlatShape: discs (circles and ellipses, kept exact) and outlines; SolidShape: leaves of a
//            CsgTree. combine() makes an operation of shapes as OpenSCAD does: what is empty is left out, or
//            makes the whole empty; unions of unions are one
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arris/csg.h"
#include "io/csg_region.h"

namespace arris {

struct Affine2d {
  Vec2d x{1, 0}, y{0, 1}, t;

  friend constexpr Affine2d operator*(const Affine2d& a, const Affine2d& b) {
    return {a.vector(b.x), a.vector(b.y), a.point(b.t)};
  }
  [[nodiscard]] constexpr Vec2d vector(Vec2d v) const { return x * v.x + y * v.y; }
  [[nodiscard]] constexpr Vec2d point(Vec2d p) const { return vector(p) + t; }
};

// center + u cos φ + v sin φ and what is inside.
struct FlatDisc {
  Vec2d center, u, v;
  int facets = 0;  // that OpenSCAD cuts it into, from φ = 0
};

struct FlatShape {
  std::optional<std::variant<FlatDisc, CsgRegion>> leaf;
  CsgOperation operation = CsgOperation::unite;
  std::vector<FlatShape> children;

  [[nodiscard]] bool is_empty() const { return !leaf && children.empty(); }
};

struct SolidShape {
  std::optional<CsgLeaf> leaf;
  bool has_color = false;  // its own, not the default
  CsgOperation operation = CsgOperation::unite;
  std::vector<SolidShape> children;

  [[nodiscard]] bool is_empty() const { return !leaf && children.empty(); }
};

// What a shape is that .csg text describes and this reader can't make: OpenSCAD must.
struct ScadUnsupported {
  std::string why;
};

// Leaves of one place and colour.
struct LeafMaker {
  Affine3d place;
  MaterialId material;
  bool has_color = false;

  // Empty if the place flattens it.
  [[nodiscard]] SolidShape operator()(CsgPrimitive primitive, const Affine3d& local = {}) const;
};

// False for what flattens and for what is not a number.
bool keeps_volume(const Mat3d& m);

template <class Shape>
Shape combine(CsgOperation operation, std::vector<Shape> shapes) {
  const auto is_empty = [](const Shape& shape) { return shape.is_empty(); };
  const bool is_nothing =
      shapes.empty() || (operation == CsgOperation::subtract && shapes[0].is_empty()) ||
      (operation == CsgOperation::intersect && std::any_of(shapes.begin(), shapes.end(), is_empty));
  if (is_nothing) return {};
  Shape result;
  result.operation = operation;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    Shape& shape = shapes[i];
    if (shape.is_empty()) continue;
    // a - (b ∪ c) is a - b - c, and (a - b) - c too.
    const bool first_of_difference = operation == CsgOperation::subtract && i == 0;
    const CsgOperation same =
        operation == CsgOperation::subtract && i > 0 ? CsgOperation::unite : operation;
    if (!shape.leaf && shape.operation == same &&
        (same != CsgOperation::subtract || first_of_difference)) {
      std::move(shape.children.begin(), shape.children.end(), std::back_inserter(result.children));
    } else {
      result.children.push_back(std::move(shape));
    }
  }
  if (result.children.size() != 1) return result;
  Shape only = std::move(result.children[0]);
  return only;
}

FlatShape make_flat(FlatDisc disc);
FlatShape make_flat(CsgRegion region);  // empty if it has no outline

// As OpenSCAD cuts it.
CsgRegion facets_of(const FlatDisc& disc);
// Round, and its radius; nothing for an ellipse.
std::optional<double> round_radius(const FlatDisc& disc);
Bounds2d bounds_of(const FlatDisc& disc);
// Of a difference: of its first shape, of an intersection: of what the bounds share.
Bounds2d bounds_of(const FlatShape& shape);
// True if bounds_of() is as narrow as can be: no differences and intersections.
template <class Shape>
bool has_exact_bounds(const Shape& shape) {
  if (shape.leaf || shape.children.empty()) return true;
  return shape.operation == CsgOperation::unite &&
         std::all_of(shape.children.begin(), shape.children.end(),
                     [](const Shape& child) { return has_exact_bounds(child); });
}
bool is_inside(const FlatShape& shape, Vec2d p);
void transform(FlatShape& shape, const Affine2d& m);

struct Bounds3d {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};
Bounds3d bounds_of(const SolidShape& shape);
void transform(SolidShape& shape, const Affine3d& m);

// Shapes without a colour of their own take that of the first that has one: the walls of a hole are of what it
// is cut into.
void color_holes(std::vector<SolidShape>& operands);

std::size_t count_leaves(const SolidShape& shape);
CsgTree make_tree(SolidShape shape, std::string name);

}  // namespace arris
