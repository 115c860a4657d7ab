#include "beam/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
  for (const Vec3d& p : std::get<Corners>(s.shape).points) best = std::max(best, dot(n, p));
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

Simple make_simple(const BeamShape& shape, std::uint32_t index) {
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

// The primitive is beyond the plane through the apex with this normal, the beam is not.
bool separates(const Pyramid& beam, const Simple& s, Vec3d n) {
  const bool beam_behind =
      std::ranges::all_of(beam.edges, [&](Vec3d e) { return dot(n, e) <= 1e-12 * length(n); });
  return beam_behind && -support(s, -n) > dot(n, beam.apex);
}

// Normals of planes through an edge that touch the primitive.
void add_tangents(const Simple& s, Vec3d apex, Vec3d v, std::vector<Vec3d>& normals) {
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
  for (const Vec3d& p : std::get<Corners>(s.shape).points) normals.push_back(cross(v, p - apex));
}

}  // namespace

bool is_separated(const Pyramid& beam, const BeamShape& shape, std::uint32_t leaf) {
  if (shape.volume(leaf) != nullptr) return false;
  const Simple s = make_simple(shape, leaf);
  Pyramid own;
  own.apex = transform_point(s.simple_from_object, beam.apex);
  for (std::size_t i = 0; i < 4; ++i) {
    own.edges[i] = transform_vector(s.simple_from_object, beam.edges[i]);
  }
  std::vector<Vec3d> normals;
  for (std::size_t i = 0; i < 4; ++i)
    normals.push_back(cross(own.edges[i], own.edges[(i + 1) % 4]));
  for (const Vec3d& edge : own.edges) add_tangents(s, own.apex, edge, normals);
  return std::ranges::any_of(
      normals, [&](Vec3d n) { return separates(own, s, n) || separates(own, s, -n); });
}

}  // namespace arris
