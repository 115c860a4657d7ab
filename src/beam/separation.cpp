#include "beam/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A primitive in a frame where it is simple.
struct Ball {};  // unit, about the origin
struct
    Rims {  // discs about the z axis and what is between them: cylinders, cones and their frustums
  double z[2], radius[2];
};
struct Corners {
  std::array<Vec3d, 8> points;
  std::size_t count = 8;

  [[nodiscard]] std::span<const Vec3d> all() const { return {points.data(), count}; }
};
struct Simple {
  Affine3d simple_from_object;
  std::variant<Ball, Rims, Corners> shape;
};

// The largest n·p over the primitive.
double support(const Simple& s, Vec3d n) {
  if (std::holds_alternative<Ball>(s.shape)) return length(n);
  if (const auto* rims = std::get_if<Rims>(&s.shape)) {
    const double across = std::hypot(n.x, n.y);
    return std::max(n.z * rims->z[0] + across * rims->radius[0],
                    n.z * rims->z[1] + across * rims->radius[1]);
  }
  double best = -kInfinity;
  for (const Vec3d& p : std::get<Corners>(s.shape).all()) best = std::max(best, dot(n, p));
  return best;
}

Simple make_box(const Box3d& b) {
  Corners corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners.points[i] = {(i & 1) != 0 ? b.high.x : b.low.x, (i & 2) != 0 ? b.high.y : b.low.y,
                         (i & 4) != 0 ? b.high.z : b.low.z};
  }
  return {{}, corners};
}

Simple make_triangle(const BeamShape& shape, const Facet& facet) {
  Corners corners{{}, 3};
  for (std::size_t k = 0; k < 3; ++k) {
    const BeamShape::Edge& edge = shape.edges()[facet.edges[k]];
    corners.points[k] = facet.turned[k] ? edge.b : edge.a;
  }
  return {{}, corners};
}

Simple make_simple(const BeamShape& shape, std::uint32_t index) {
  if (const Facet* facet = shape.facet(index)) return make_triangle(shape, *facet);
  const ConvexLeaf* convex = shape.convex(index);
  if (convex == nullptr || !convex->quadric) return make_box(shape.leaf_box(index));
  const CsgSolid& solid = shape.csg();
  const ConvexLeaf& leaf = *convex;
  const CsgQuadric& quadric = solid.surfaces().quadrics()[*leaf.quadric];
  if (quadric.form == CsgQuadric::Form::ellipsoid) return {quadric.unit_from_object, Ball{}};
  // The caps' heights in the quadric's frame.
  const Affine3d object_from_unit = inverse(quadric.unit_from_object);
  Rims rims{{-kInfinity, kInfinity}, {1, 1}};
  int caps = 0;
  for (const PlaneRef& ref : leaf.planes) {
    const CsgPlane& plane = solid.surfaces().planes()[ref.plane];
    const double along = dot(plane.normal, object_from_unit.linear.z);
    const double z = (plane.d - dot(plane.normal, object_from_unit.translation)) / along;
    if (caps < 2 && std::isfinite(z)) rims.z[caps++] = z;
  }
  if (caps < 2) return make_box(solid.leaf(index).bounds);
  if (quadric.form == CsgQuadric::Form::cone) {
    rims.radius[0] = std::abs(rims.z[0]);
    rims.radius[1] = std::abs(rims.z[1]);
  }
  return {quadric.unit_from_object, rims};
}

// Of lengths that are nothing beside others.
constexpr double kRounding = 1e-12;
// How far, for its distance from the origin, what lies on a base may reach over it.
constexpr double kContact = 1e-9;

// All of the beam is behind the plane through p with this normal.
bool is_beam_behind(const Pyramid& beam, Vec3d p, Vec3d n) {
  const double size = kRounding * length(n);
  return std::ranges::all_of(beam.edges, [&](const Ray& e) {
    return dot(n, e.direction) <= size * length(e.direction) &&
           dot(n, e.origin - p) <= size * length(e.origin);
  });
}

// The primitive is beyond that plane, or touches it, and the beam is not.
bool separates(const Pyramid& beam, const Simple& s, Vec3d p, Vec3d n) {
  const double size = length(n);
  return size > 0 && -support(s, -n) >= dot(n, p) - kRounding * size * length(p) &&
         is_beam_behind(beam, p, n);
}

// The plane of two edges in turn.
Vec3d side_normal(const Pyramid& beam, std::size_t i) {
  const Ray &a = beam.edges[i], &b = beam.edges[(i + 1) % 4];
  return cross(a.direction, b.origin + b.direction - a.origin);
}

// Of its base, away from the beam.
CsgPlane base_plane(const PyramidBase& base) {
  Vec3d n = cross(base.along[0], base.along[1]);
  if (dot(n, base.toward) > 0) n = -n;
  return {n, dot(n, base.origin) - kContact * length(n) * length(base.origin)};
}

// Normals of planes through an edge that touch the primitive.
void add_tangents(const Simple& s, const Ray& edge, std::vector<Vec3d>& normals) {
  const Vec3d apex = edge.origin, v = edge.direction;
  if (std::holds_alternative<Ball>(s.shape)) {
    // From the edge to the center.
    normals.push_back(-(apex - v * (dot(apex, v) / dot(v, v))));
    return;
  }
  if (const auto* rims = std::get_if<Rims>(&s.shape)) {
    const Vec3d d{0, 0, 1};
    const Vec3d across = cross(d, v);
    normals.push_back(cross(v, across));
    normals.push_back(across);
    const double size = length(across);
    if (rims->radius[0] == rims->radius[1] || !(size > 0)) return;
    for (const double side : {1.0, -1.0}) {
      const Vec3d q0 = across * (side * rims->radius[0] / size) + d * rims->z[0];
      const Vec3d q1 = across * (side * rims->radius[1] / size) + d * rims->z[1];
      normals.push_back(cross(v, q1 - q0));
    }
    return;
  }
  for (const Vec3d& p : std::get<Corners>(s.shape).all()) normals.push_back(cross(v, p - apex));
}

}  // namespace

Pyramid transform(const Affine3d& m, const Pyramid& beam) {
  Pyramid to = beam;
  for (Ray& e : to.edges) {
    e = {transform_point(m, e.origin), transform_vector(m, e.direction)};
  }
  if (to.base) {
    to.base->origin = transform_point(m, to.base->origin);
    for (Vec3d& along : to.base->along) along = transform_vector(m, along);
    to.base->toward = transform_vector(m, to.base->toward);
  }
  return to;
}

BeamSeparation::BeamSeparation(const Pyramid& beam) : beam_(beam) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d p = beam.edges[i].origin, n = side_normal(beam, i);
    for (const Vec3d& way : {n, -n}) {
      if (is_beam_behind(beam, p, way)) planes_.push_back({way, dot(way, p)});
    }
  }
  if (beam.base) planes_.push_back(base_plane(*beam.base));
}

// Its corner that is least far along the normal is beyond the plane.
bool BeamSeparation::is_box_outside(const Box3d& box) const {
  return std::ranges::any_of(planes_, [&](const CsgPlane& plane) {
    const Vec3d n = plane.normal;
    return n.x * (n.x > 0 ? box.low.x : box.high.x) + n.y * (n.y > 0 ? box.low.y : box.high.y) +
               n.z * (n.z > 0 ? box.low.z : box.high.z) >
           plane.d;
  });
}

bool BeamSeparation::is_separated(const BeamShape& shape, std::uint32_t leaf) const {
  if (shape.volume(leaf) != nullptr) return false;
  if (is_box_outside(shape.leaf_box(leaf))) return true;
  const Simple s = make_simple(shape, leaf);
  const Pyramid own = transform(s.simple_from_object, beam_);
  if (own.base) {
    const CsgPlane plane = base_plane(*own.base);
    if (-support(s, -plane.normal) > plane.d) return true;
  }
  std::vector<Vec3d> normals;
  for (std::size_t i = 0; i < 4; ++i) {
    normals.assign(1, side_normal(own, i));
    add_tangents(s, own.edges[i], normals);
    const Vec3d p = own.edges[i].origin;
    if (std::ranges::any_of(normals, [&](Vec3d n) {
          return separates(own, s, p, n) || separates(own, s, p, -n);
        })) {
      return true;
    }
  }
  return false;
}

std::vector<BeamPart> parts_near(std::span<const BeamSolid> solids,
                                 const std::vector<BeamPart>& parts, const Pyramid& beam) {
  std::vector<BeamPart> kept;
  std::vector<Cover> covers;
  for (const BeamPart& part : parts) {
    const BeamSolid& solid = solids[part.solid];
    const BeamSeparation separation(transform(solid.object_from_world, beam));
    covers.clear();
    for (const std::uint32_t leaf : part.expression.leaves()) {
      const bool is_out = separation.is_separated(*solid.shape, leaf);
      covers.push_back(is_out ? Cover::out : Cover::on);
    }
    BeamPart pruned{part.solid, part.expression.prune(covers)};
    if (!pruned.expression.is_decided()) kept.push_back(std::move(pruned));
  }
  return kept;
}

}  // namespace arris
