// leaf_cover.cpp — points and cells against leaves
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "csg/csg_leaf.h"

namespace arris {
namespace {

// Bounds that come from distances in plain doubles give way by this part of their size.
constexpr double kRounding = 1e-12;

// Undecided planes of a leaf that are looked at in pairs, at most.
constexpr std::size_t kMaxPairs = 8;

constexpr Cover cover_of_height(Interval height) {
  return height.hi < 0 ? Cover::in : height.lo > 0 ? Cover::out : Cover::on;
}

Interval coordinate_range(const SpaceCell& cell, int axis) {
  Vec3d n;
  n[axis] = 1;
  return linear_range(cell, n);
}

// Distance from the z axis.
Interval radial_range(const SpaceCell& cell) {
  return square_root(quadratic_range(cell, {1, 1, 0}));
}

Vec3d middle_of(const SpaceCell& cell) {
  const auto middle = [](Interval a) { return a.lo / 2 + a.hi / 2; };
  return {middle(cell.center.x), middle(cell.center.y), middle(cell.center.z)};
}

double signed_distance(const TorusLeaf& leaf, Vec3d p) {
  return std::hypot(std::hypot(p.x, p.y) - leaf.ring_radius, p.z) - leaf.tube_radius;
}

double distance_to_segment(Vec3d p, const RoundedLeaf::Edge& e) {
  const Vec3d along = e.b - e.a;
  const double u = std::clamp(dot(p - e.a, along) / dot(along, along), 0.0, 1.0);
  return length(p - (e.a + along * u));
}

struct CoverVisitor {
  const SurfaceTable& surfaces;
  const SpaceCell& cell;

  Cover operator()(const ConvexLeaf& leaf) const {
    std::array<PlaneRef, kMaxPairs> undecided;
    std::size_t count = 0;
    for (const PlaneRef& plane : leaf.planes) {
      const Cover cover = cover_of_height(surfaces.height_over(plane, cell));
      if (cover == Cover::out) return cover;
      if (cover == Cover::on && count++ < kMaxPairs) undecided[count - 1] = plane;
    }
    const Cover by_quadric =
        leaf.quadric ? cover_of_height(surfaces.value_of(*leaf.quadric, cell)) : Cover::in;
    if (by_quadric == Cover::out || count == 0) return by_quadric;
    // Beyond an edge: above neither of its planes throughout, but above their sum, whose normal is rounded.
    const Box3d box = box_of(cell);
    const Vec3d far = max(max(box.high, -box.high), max(box.low, -box.low));
    const double rounding = count > 1 ? kRounding * (far.x + far.y + far.z) : 0;
    for (std::size_t i = 0; i < std::min(count, kMaxPairs); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (height_over_both(undecided[i], undecided[j]).lo > rounding) return Cover::out;
      }
    }
    return Cover::on;
  }
  // The sum of the heights over two planes of one leaf, as one linear form.
  [[nodiscard]] Interval height_over_both(PlaneRef a, PlaneRef b) const {
    const CsgPlane &p = surfaces.planes()[a.plane], &q = surfaces.planes()[b.plane];
    const double s = a.flipped ? -1 : 1, t = b.flipped ? -1 : 1;
    return linear_range(cell, p.normal * s + q.normal * t) - Interval(p.d * s) - Interval(q.d * t);
  }
  Cover operator()(const TorusLeaf& leaf) const {
    const SpaceCell own = map_cell(leaf.primitive_from_object, cell);
    const Interval squares =
        square(radial_range(own) - Interval(leaf.ring_radius)) + square(coordinate_range(own, 2));
    const Interval by_squares = square_root(squares) - Interval(leaf.tube_radius);
    // The distance changes no faster than the place.
    const double middle = signed_distance(leaf, middle_of(own));
    const double radius =
        radius_of(own) * (1 + kRounding) + kRounding * (length(middle_of(own)) + leaf.ring_radius);
    return cover_of_height(intersection(by_squares, {middle - radius, middle + radius}));
  }
  Cover operator()(const PrismLeaf& leaf) const {
    const Cover slab = cover_of_height(surfaces.height_over(leaf.low, cell)) &
                       cover_of_height(surfaces.height_over(leaf.high, cell));
    if (slab == Cover::out) return slab;
    const SpaceCell own = map_cell(leaf.primitive_from_object, cell);
    Interval x = coordinate_range(own, 0), y = coordinate_range(own, 1);
    const Vec2d growth = leaf.growth();
    if (growth.x != 0 || growth.y != 0) {
      const Interval z =
          intersection(coordinate_range(own, 2), {leaf.shape.z_low, leaf.shape.z_high});
      const Interval above = z - Interval(leaf.shape.z_low);
      const Interval scale_x = Interval(1) + Interval(growth.x) * above;
      const Interval scale_y = Interval(1) + Interval(growth.y) * above;
      if (scale_x.lo <= 0 || scale_y.lo <= 0) return Cover::on;
      x = x / scale_x;
      y = y / scale_y;
    }
    return slab & leaf.region.cover(x, y, [&](std::size_t edge) {
      return leaf.walls.empty() || surfaces.height_over(leaf.walls[edge], cell).contains(0);
    });
  }
  Cover operator()(const RevolutionLeaf& leaf) const {
    const SpaceCell own = map_cell(leaf.primitive_from_object, cell);
    return leaf.region.cover(radial_range(own), coordinate_range(own, 2), [&](std::size_t edge) {
      return !std::holds_alternative<RevolutionLeaf::None>(leaf.swept[edge]);
    });
  }
  Cover operator()(const MeshLeaf& leaf) const { return leaf.mesh.cover(cell); }
  Cover operator()(const RoundedLeaf& leaf) const {
    const SpaceCell own = map_cell(leaf.primitive_from_object, cell);
    bool in_core = true;
    for (const RoundedLeaf::Face& face : leaf.faces) {
      const Interval height = linear_range(own, face.plane.normal) - Interval(face.plane.d);
      if (height.lo > leaf.radius) return Cover::out;
      in_core = in_core && height.hi < 0;
    }
    if (in_core) return Cover::in;
    const Vec3d middle = middle_of(own);
    const double distance = distance_to_core(leaf, middle), radius = radius_of(own);
    const double rounding = kRounding * (length(middle) + radius + leaf.radius);
    if (distance - radius - rounding > leaf.radius) return Cover::out;
    if (distance + radius + rounding < leaf.radius) return Cover::in;
    // A convex solid holds the cell if it holds its corners.
    for (int i = 0; i < 8; ++i) {
      const Vec3i corner = own.center + own.half[0] * Interval((i & 1) != 0 ? 1 : -1) +
                           own.half[1] * Interval((i & 2) != 0 ? 1 : -1) +
                           own.half[2] * Interval((i & 4) != 0 ? 1 : -1);
      const Vec3d p{corner.x.lo, corner.y.lo, corner.z.lo};
      if (!(distance_to_core(leaf, p) + rounding < leaf.radius)) return Cover::on;
    }
    return Cover::in;
  }
};

struct ContainsVisitor {
  const SurfaceTable& surfaces;
  Vec3d p;

  bool operator()(const ConvexLeaf& leaf) const {
    return std::ranges::all_of(
               leaf.planes, [&](PlaneRef plane) { return surfaces.height_over(plane, p) <= 0; }) &&
           (!leaf.quadric || surfaces.value_of(*leaf.quadric, p) <= 0);
  }
  bool operator()(const TorusLeaf& leaf) const {
    return signed_distance(leaf, transform_point(leaf.primitive_from_object, p)) <= 0;
  }
  bool operator()(const PrismLeaf& leaf) const {
    if (surfaces.height_over(leaf.low, p) > 0 || surfaces.height_over(leaf.high, p) > 0)
      return false;
    const Vec3d q = transform_point(leaf.primitive_from_object, p);
    const Vec2d growth = leaf.growth();
    const double above = q.z - leaf.shape.z_low;
    return leaf.region.contains({q.x / (1 + growth.x * above), q.y / (1 + growth.y * above)});
  }
  bool operator()(const RevolutionLeaf& leaf) const {
    const Vec3d q = transform_point(leaf.primitive_from_object, p);
    return leaf.region.contains({std::hypot(q.x, q.y), q.z});
  }
  bool operator()(const MeshLeaf& leaf) const { return leaf.mesh.contains(p); }
  bool operator()(const RoundedLeaf& leaf) const {
    return distance_to_core(leaf, transform_point(leaf.primitive_from_object, p)) <= leaf.radius;
  }
};

struct NormalVisitor {
  const SurfaceTable& surfaces;
  std::uint32_t face;
  Vec3d p;

  Vec3d operator()(const ConvexLeaf& leaf) const {
    if (face < leaf.planes.size()) return surfaces.normal_of(leaf.planes[face]);
    return surfaces.gradient_of(*leaf.quadric, p);
  }
  Vec3d operator()(const TorusLeaf& leaf) const {
    const Vec3d q = transform_point(leaf.primitive_from_object, p);
    const double radial = std::hypot(q.x, q.y);
    const double scale = radial > 0 ? 1 - leaf.ring_radius / radial : 0;
    return outward(leaf.primitive_from_object, {q.x * scale, q.y * scale, q.z});
  }
  Vec3d operator()(const PrismLeaf& leaf) const {
    if (face == 0) return surfaces.normal_of(leaf.low);
    if (face == 1) return surfaces.normal_of(leaf.high);
    if (!leaf.walls.empty()) return surfaces.normal_of(leaf.walls[face - 2]);
    // Of n·(x / scale_x, y / scale_y) = c, times both scales.
    const auto& [a, b] = leaf.region.edges()[face - 2];
    const Vec2d n{b.y - a.y, a.x - b.x}, growth = leaf.growth();
    const double c = n.x * a.x + n.y * a.y;
    const Vec3d q = transform_point(leaf.primitive_from_object, p);
    const double above = q.z - leaf.shape.z_low;
    const double sx = 1 + growth.x * above, sy = 1 + growth.y * above;
    return outward(leaf.primitive_from_object, {n.x * sy, n.y * sx,
                                                n.x * q.x * growth.y + n.y * q.y * growth.x -
                                                    c * (growth.x * sy + growth.y * sx)});
  }
  Vec3d operator()(const RevolutionLeaf& leaf) const {
    if (const auto* ring = std::get_if<RevolutionLeaf::Ring>(&leaf.swept[face])) {
      return surfaces.normal_of(ring->plane);
    }
    const auto* band = std::get_if<RevolutionLeaf::Band>(&leaf.swept[face]);
    return band != nullptr ? surfaces.gradient_of(band->quadric, p) : Vec3d(0, 0, 1);
  }
  Vec3d operator()(const MeshLeaf& leaf) const { return surfaces.normal_of(leaf.planes[face]); }
  Vec3d operator()(const RoundedLeaf& leaf) const {
    if (face < leaf.faces.size()) return surfaces.normal_of(leaf.faces[face].moved);
    const Vec3d q = transform_point(leaf.primitive_from_object, p);
    const std::size_t edge = face - leaf.faces.size();
    if (edge >= leaf.edges.size()) {
      return outward(leaf.primitive_from_object, q - leaf.vertices[edge - leaf.edges.size()]);
    }
    const Vec3d along = leaf.edges[edge].b - leaf.edges[edge].a;
    const Vec3d from = q - leaf.edges[edge].a;
    return outward(leaf.primitive_from_object,
                   from - along * (dot(from, along) / dot(along, along)));
  }
  static Vec3d outward(const Affine3d& primitive_from_object, Vec3d n) {
    return transpose(primitive_from_object.linear) * n;
  }
};

}  // namespace

double distance_to_core(const RoundedLeaf& leaf, Vec3d p) {
  double best = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (const RoundedLeaf::Face& face : leaf.faces) {
    const double height = dot(face.plane.normal, p) - face.plane.d;
    if (height <= 0) continue;
    inside = false;
    const bool over_face = std::ranges::all_of(
        face.sides, [&](const CsgHalfSpace& side) { return dot(side.normal, p) <= side.d; });
    if (over_face) best = std::min(best, height);
  }
  if (inside) return 0;
  for (const RoundedLeaf::Edge& e : leaf.edges) best = std::min(best, distance_to_segment(p, e));
  return best;
}

Cover cover_of(const PlacedLeaf& leaf, const SurfaceTable& surfaces, const SpaceCell& cell) {
  return std::visit(CoverVisitor{surfaces, cell}, leaf.shape);
}
std::optional<SoleSurface> sole_surface_of(const PlacedLeaf& leaf, const SurfaceTable& surfaces,
                                           const SpaceCell& cell) {
  const auto* convex = std::get_if<ConvexLeaf>(&leaf.shape);
  if (convex == nullptr) return std::nullopt;
  std::optional<SoleSurface> sole;
  for (const PlaneRef& plane : convex->planes) {
    if (cover_of_height(surfaces.height_over(plane, cell)) == Cover::in) continue;
    if (sole) return std::nullopt;
    sole = SoleSurface{SoleSurface::Kind::plane, plane.plane, plane.flipped};
  }
  if (convex->quadric && cover_of_height(surfaces.value_of(*convex->quadric, cell)) != Cover::in) {
    if (sole) return std::nullopt;
    sole = SoleSurface{SoleSurface::Kind::quadric, *convex->quadric, false};
  }
  return sole;
}
bool contains(const PlacedLeaf& leaf, const SurfaceTable& surfaces, Vec3d p) {
  return std::visit(ContainsVisitor{surfaces, p}, leaf.shape);
}
Vec3d normal_at(const PlacedLeaf& leaf, const SurfaceTable& surfaces, std::uint32_t face, Vec3d p) {
  return std::visit(NormalVisitor{surfaces, face, p}, leaf.shape);
}

}  // namespace arris
