// place_leaf.cpp — from a reader's primitive to what is evaluated
#include <algorithm>
#include <cmath>
#include <limits>

#include "csg/csg_leaf.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A placement flattens if its volume is this small against its longest column.
constexpr double kFlat = 1e-14;
// A vertex lies on a plane of its polyhedron within this of the polyhedron's size.
constexpr double kOnPlane = 1e-7;

bool is_usable(const Affine3d& m) {
  const double size = std::max({length(m.linear.x), length(m.linear.y), length(m.linear.z)});
  return std::isfinite(size) && is_finite(m.translation) &&
         std::abs(determinant(m.linear)) > kFlat * size * size * size;
}

bool is_positive(double x) {
  return x > 0 && std::isfinite(x);
}

// The largest of w·p over the points of each kind of primitive; -infinity for one without points.
struct Support {
  Vec3d w;

  [[nodiscard]] double radial() const { return std::hypot(w.x, w.y); }
  [[nodiscard]] double of_points(const std::vector<Vec3d>& points) const {
    double best = -kInfinity;
    for (const Vec3d& p : points) best = std::max(best, dot(w, p));
    return best;
  }
  double operator()(const CsgSphere& s) const {
    return is_positive(s.radius) ? s.radius * length(w) : -kInfinity;
  }
  double operator()(const CsgBox& b) const {
    const Vec3d size = b.high - b.low;
    if (!(size.x > 0 && size.y > 0 && size.z > 0) || !is_finite(b.low) || !is_finite(b.high)) {
      return -kInfinity;
    }
    const Vec3d far = max(w * b.low, w * b.high);
    return far.x + far.y + far.z;
  }
  double operator()(const CsgCone& c) const {
    if (!is_positive(c.z_high - c.z_low) || !(c.radius_low >= 0 && c.radius_high >= 0) ||
        !is_positive(c.radius_low + c.radius_high)) {
      return -kInfinity;
    }
    return std::max(w.z * c.z_low + radial() * c.radius_low,
                    w.z * c.z_high + radial() * c.radius_high);
  }
  double operator()(const CsgTorus& t) const {
    if (!is_positive(t.tube_radius) || !(t.ring_radius >= 0) || !std::isfinite(t.ring_radius)) {
      return -kInfinity;
    }
    return radial() * t.ring_radius + length(w) * t.tube_radius;
  }
  double operator()(const CsgHalfSpace& h) const {
    return is_finite(h.normal) && length(h.normal) > 0 && std::isfinite(h.d) ? kInfinity
                                                                             : -kInfinity;
  }
  double operator()(const CsgPolyhedron& p) const {
    return p.faces.size() < 4 ? -kInfinity : of_points(p.vertices);
  }
  double operator()(const CsgMesh& m) const {
    return m.triangles.size() < 4 ? -kInfinity : of_points(m.vertices);
  }
  double operator()(const CsgPrism& p) const {
    if (!is_positive(p.z_high - p.z_low) || !(p.scale_high.x >= 0 && p.scale_high.y >= 0) ||
        !std::isfinite(p.scale_high.x + p.scale_high.y)) {
      return -kInfinity;
    }
    double best = -kInfinity;
    const Region region(p.region);
    for (const RegionEdge& e : region.edges()) {
      const double x = e.a.x * w.x, y = e.a.y * w.y;
      best = std::max(
          {best, x + y + w.z * p.z_low, x * p.scale_high.x + y * p.scale_high.y + w.z * p.z_high});
    }
    return best;
  }
  double operator()(const CsgRevolution& r) const {
    double best = -kInfinity;
    const Region region(r.region);
    for (const RegionEdge& e : region.edges()) {
      best = std::max(best, std::abs(e.a.x) * radial() + e.a.y * w.z);
    }
    return best;
  }
  double operator()(const CsgRounded& r) const {
    if (!(r.radius >= 0) || r.core.faces.size() < 4) return -kInfinity;
    return of_points(r.core.vertices) + r.radius * length(w);
  }
};

CsgPlane map_plane(const Affine3d& m, Vec3d normal, double d) {
  const Vec3d n = transform_normal(m, normal);
  const double scale = 1 / length(n);
  // A point of the plane decides d, so that both agree with the mapped points.
  const Vec3d p = transform_point(m, normal * (d / dot(normal, normal)));
  return {n * scale, dot(n * scale, p)};
}

class Placer {
 public:
  Placer(const CsgLeaf& leaf, const Box3d& bounds, SurfaceTable& surfaces)
      : m_(leaf.object_from_primitive), bounds_(bounds), surfaces_(surfaces) {}

  CsgShape operator()(const CsgSphere& s) {
    return ConvexLeaf{{},
                      quadric(CsgQuadric::Form::ellipsoid,
                              {{s.radius, 0, 0}, {0, s.radius, 0}, {0, 0, s.radius}}, 0)};
  }
  CsgShape operator()(const CsgBox& b) {
    ConvexLeaf leaf;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d n;
      n[axis] = 1;
      leaf.planes.push_back(plane(-n, -b.low[axis]));
      leaf.planes.push_back(plane(n, b.high[axis]));
    }
    return leaf;
  }
  CsgShape operator()(const CsgCone& c) {
    return ConvexLeaf{{plane({0, 0, -1}, -c.z_low), plane({0, 0, 1}, c.z_high)},
                      band({c.radius_low, c.z_low}, {c.radius_high, c.z_high})};
  }
  CsgShape operator()(const CsgTorus& t) {
    return TorusLeaf{inverse(m_), t.ring_radius, t.tube_radius};
  }
  CsgShape operator()(const CsgHalfSpace& h) { return ConvexLeaf{{plane(h.normal, h.d)}, {}}; }
  CsgShape operator()(const CsgPolyhedron& p) {
    ConvexLeaf leaf;
    for (const CsgHalfSpace& face : p.faces) {
      const PlaneRef ref = plane(face.normal, face.d);
      const bool is_new = std::ranges::none_of(leaf.planes, [&](PlaneRef other) {
        return other.plane == ref.plane && other.flipped == ref.flipped;
      });
      if (is_new) leaf.planes.push_back(ref);
    }
    return leaf;
  }
  CsgShape operator()(const CsgMesh& m) {
    std::vector<Vec3d> vertices;
    vertices.reserve(m.vertices.size());
    for (const Vec3d& v : m.vertices) vertices.push_back(transform_point(m_, v));
    MeshLeaf leaf{ClosedMesh(std::move(vertices), m.triangles), {}};
    for (std::uint32_t i = 0; i < leaf.mesh.triangles().size(); ++i) {
      const Vec3d n = leaf.mesh.normal_of(i);
      const double size = length(n);
      const Vec3d unit = size > 0 ? n * (1 / size) : Vec3d(0, 0, 1);
      const Vec3d a = leaf.mesh.vertices()[leaf.mesh.triangles()[i][0]];
      leaf.planes.push_back(surfaces_.add(CsgPlane{unit, dot(unit, a)}, bounds_));
    }
    return leaf;
  }
  CsgShape operator()(const CsgPrism& p) {
    PrismLeaf leaf{
        inverse(m_), p, Region(p.region), plane({0, 0, -1}, -p.z_low), plane({0, 0, 1}, p.z_high),
        {}};
    const Vec2d growth = leaf.growth();
    if (growth.x != growth.y) return leaf;
    for (const auto& [a, b] : leaf.region.edges()) {
      // a·x + b·y = c at z_low, where c grows with the scale.
      const Vec3d n{b.y - a.y, a.x - b.x, 0};
      const double c = n.x * a.x + n.y * a.y;
      leaf.walls.push_back(plane({n.x, n.y, -c * growth.x}, c * (1 - growth.x * p.z_low)));
    }
    return leaf;
  }
  CsgShape operator()(const CsgRevolution& r) {
    RevolutionLeaf leaf{inverse(m_), Region(r.region), {}};
    for (const auto& [a, b] : leaf.region.edges()) {
      if (a.y == b.y) {
        leaf.swept.emplace_back(RevolutionLeaf::Ring{plane({0, 0, 1}, a.y)});
      } else if (a.x == 0 && b.x == 0) {
        leaf.swept.emplace_back(RevolutionLeaf::None{});
      } else {
        leaf.swept.emplace_back(RevolutionLeaf::Band{band(a, b)});
      }
    }
    return leaf;
  }
  CsgShape operator()(const CsgRounded& r);

 private:
  PlaneRef plane(Vec3d normal, double d) {
    const double size = length(normal);
    return surfaces_.add(map_plane(m_, normal * (1 / size), d / size), bounds_);
  }
  // Of the unit form moved by z and mapped by `primitive_from_unit`.
  std::uint32_t quadric(CsgQuadric::Form form, const Mat3d& primitive_from_unit, double z) {
    const Affine3d object_from_unit = m_ * Affine3d{primitive_from_unit, {0, 0, z}};
    return surfaces_.add(CsgQuadric{form, inverse(object_from_unit)}, bounds_);
  }
  // The cylinder or cone that an edge of the half plane sweeps; x is the radius, y the height.
  std::uint32_t band(Vec2d a, Vec2d b) {
    if (a.x == b.x) {
      return quadric(CsgQuadric::Form::cylinder, {{a.x, 0, 0}, {0, a.x, 0}, {0, 0, b.y - a.y}},
                     a.y);
    }
    // Height at which the radius is 0; the unit cone's z is the radius.
    const double slope = (b.x - a.x) / (b.y - a.y);
    const double apex = a.y - a.x / slope;
    return quadric(CsgQuadric::Form::cone, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1 / slope}}, apex);
  }

  Affine3d m_;
  Box3d bounds_;
  SurfaceTable& surfaces_;
};

// The vertices of one face in order round its middle, counter-clockwise seen from outside.
std::vector<Vec3d> polygon_of(const CsgPolyhedron& core, const CsgHalfSpace& face, double size) {
  std::vector<Vec3d> polygon;
  Vec3d middle;
  for (const Vec3d& v : core.vertices) {
    if (std::abs(dot(face.normal, v) - face.d) > kOnPlane * size) continue;
    polygon.push_back(v);
    middle += v;
  }
  if (polygon.size() < 3) return {};
  middle = middle * (1 / double(polygon.size()));
  const Vec3d x = normalize(polygon[0] - middle), y = cross(face.normal, x);
  std::ranges::sort(polygon, {},
                    [&](Vec3d v) { return std::atan2(dot(v - middle, y), dot(v - middle, x)); });
  return polygon;
}

CsgShape Placer::operator()(const CsgRounded& r) {
  RoundedLeaf leaf{inverse(m_), r.radius, {}, {}, r.core.vertices};
  Vec3d low(kInfinity), high(-kInfinity);
  for (const Vec3d& v : r.core.vertices) {
    low = min(low, v);
    high = max(high, v);
  }
  const double size = length(high - low);
  for (const CsgHalfSpace& described : r.core.faces) {
    const double scale = 1 / length(described.normal);
    RoundedLeaf::Face face{{described.normal * scale, described.d * scale}, {}, {}};
    const std::vector<Vec3d> polygon = polygon_of(r.core, face.plane, size);
    if (polygon.empty()) continue;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if (!(length(b - a) > 0)) continue;
      const Vec3d out = normalize(cross(b - a, face.plane.normal));
      face.sides.push_back({out, dot(out, a)});
      const bool known = std::ranges::any_of(leaf.edges, [&](const RoundedLeaf::Edge& e) {
        return (e.a == a && e.b == b) || (e.a == b && e.b == a);
      });
      if (!known) leaf.edges.push_back({a, b});
    }
    face.moved = plane(face.plane.normal, face.plane.d + r.radius);
    leaf.faces.push_back(std::move(face));
  }
  return leaf;
}

}  // namespace

Box3d extent_of(const CsgLeaf& leaf) {
  const Affine3d& m = leaf.object_from_primitive;
  const Box3d none{Vec3d(kInfinity), Vec3d(-kInfinity)};
  if (!is_usable(m)) return none;
  const Mat3d rows = transpose(m.linear);
  Box3d box;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d row = axis == 0 ? rows.x : axis == 1 ? rows.y : rows.z;
    box.high[axis] = m.translation[axis] + std::visit(Support{row}, leaf.primitive);
    box.low[axis] = m.translation[axis] - std::visit(Support{-row}, leaf.primitive);
  }
  return box.is_empty() || !(box.low.x < kInfinity && box.high.x > -kInfinity) ? none : box;
}

Box3d bounds_of(const CsgLeaf& leaf) {
  Box3d box = extent_of(leaf);
  if (box.is_empty()) return box;
  const double reach = std::max({max_component(box.high), max_component(-box.low), 0.0});
  if (std::isfinite(reach)) {
    const Vec3d slack(1.5 * kMergedDeviation * reach);
    box = {box.low - slack, box.high + slack};
  }
  return box;
}

std::optional<PlacedLeaf> place_leaf(const CsgLeaf& leaf, SurfaceTable& surfaces) {
  const Box3d bounds = bounds_of(leaf);
  if (bounds.is_empty()) return std::nullopt;
  return PlacedLeaf{std::visit(Placer(leaf, bounds, surfaces), leaf.primitive), bounds,
                    leaf.material};
}

}  // namespace arris
