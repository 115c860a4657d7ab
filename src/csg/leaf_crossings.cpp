#include "csg/leaf_crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "csg/polynomial_roots.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A crossing counts for an edge of a region or polygon also this part of its length beyond its ends: neighbours then
// both count, and membership between the candidates decides.
constexpr double kBeyondEnd = 1e-9;

double plane_t(const CsgPlane& plane, const Ray& ray) {
  return (plane.d - dot(plane.normal, ray.origin)) / dot(plane.normal, ray.direction);
}

// Where a line is inside a quadric: between two t, or outside of them; infinite ends where there are none.
struct QuadricRange {
  bool outside = false;
  double t0 = kInfinity, t1 = -kInfinity;
};
constexpr QuadricRange kAll{false, -kInfinity, kInfinity};
constexpr QuadricRange kNowhere{};

// From the point nearest to center or axis: c·c + t² v·v = 1.
QuadricRange round_range(Vec3d origin, Vec3d direction, Vec3d weights) {
  const double vv = dot(direction * weights, direction);
  if (!(vv > 0)) return dot(origin * weights, origin) < 1 ? kAll : kNowhere;
  const double nearest = -dot(origin * weights, direction) / vv;
  const Vec3d c = origin + direction * nearest;
  const double cc = dot(c * weights, c);
  if (cc >= 1) return kNowhere;
  const double half = std::sqrt((1 - cc) / vv);
  return {false, nearest - half, nearest + half};
}

// x² + y² = z². The discriminant is Lagrange's identity for this form, in which nothing cancels.
QuadricRange cone_range(Vec3d origin, Vec3d v) {
  const double nearest = -dot(origin, v) / dot(v, v);
  const Vec3d c = origin + v * nearest;
  const double a = v.x * v.x + v.y * v.y - v.z * v.z;
  const double b = c.x * v.x + c.y * v.y - c.z * v.z;
  const double f = c.x * c.x + c.y * c.y - c.z * c.z;
  const double xz = c.x * v.z - c.z * v.x, yz = c.y * v.z - c.z * v.y, xy = c.x * v.y - c.y * v.x;
  const double discriminant = xz * xz + yz * yz - xy * xy;
  if (a == 0) {
    if (b == 0) return f < 0 ? kAll : kNowhere;
    const double t = nearest - f / (2 * b);
    return b > 0 ? QuadricRange{false, -kInfinity, t} : QuadricRange{false, t, kInfinity};
  }
  if (discriminant < 0 && a > 0) return kNowhere;
  const double root = square_root(discriminant);
  const double q = -(b + std::copysign(root, b));
  const double first = q / a, second = q != 0 ? f / q : first;
  return {a < 0, nearest + std::min(first, second), nearest + std::max(first, second)};
}

QuadricRange quadric_range(const CsgQuadric& quadric, const Ray& ray) {
  const Vec3d o = transform_point(quadric.unit_from_object, ray.origin);
  const Vec3d d = transform_vector(quadric.unit_from_object, ray.direction);
  return quadric.form == CsgQuadric::Form::cone ? cone_range(o, d)
                                                : round_range(o, d, weights_of(quadric.form));
}

struct Span {
  Crossing enter{-kInfinity, 0}, leave{kInfinity, 0};

  [[nodiscard]] bool is_empty() const { return !(enter.t < leave.t); }
  void clip(Crossing low, Crossing high) {
    if (low.t > enter.t) enter = low;
    if (high.t < leave.t) leave = high;
  }
  void clip(const SurfaceTable& surfaces, PlaneRef face, std::uint32_t id, const Ray& ray) {
    const CsgPlane& plane = surfaces.planes()[face.plane];
    const double slope = dot(plane.normal, ray.direction) * (face.flipped ? -1 : 1);
    if (slope == 0) {
      if (surfaces.height_over(face, ray.origin) > 0) leave.t = -kInfinity;
      return;
    }
    const Crossing at{plane_t(plane, ray), id};
    slope < 0 ? clip(at, {kInfinity, 0}) : clip({-kInfinity, 0}, at);
  }
};

}  // namespace

struct LeafCrossings::Finder {
  LeafCrossings& buffers;
  const PlacedLeaf& leaf;
  const SurfaceTable& surfaces;
  const Ray& ray;

  void emit(const Span& span) const {
    if (span.is_empty()) return;
    buffers.found_.push_back(span.enter);
    buffers.found_.push_back(span.leave);
  }

  // Between the sorted candidates the line is inside or not: the middles tell. Beyond them it is outside.
  template <class Contains>
  void emit_between_candidates(const Contains& contains_at) const {
    std::vector<Crossing>& all = buffers.candidates_;
    std::ranges::stable_sort(all, {}, &Crossing::t);
    bool inside = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool last = i + 1 == all.size();
      if (!last && all[i + 1].t == all[i].t) continue;
      const bool next = !last && contains_at(all[i].t + (all[i + 1].t - all[i].t) / 2);
      if (next != inside) {
        // Of candidates at one t the first gives its face.
        std::size_t first = i;
        while (first > 0 && all[first - 1].t == all[i].t) --first;
        buffers.found_.push_back(all[first]);
      }
      inside = next;
    }
  }

  void operator()(const ConvexLeaf& convex) const {
    Span span;
    for (std::uint32_t i = 0; i < convex.planes.size(); ++i) {
      span.clip(surfaces, convex.planes[i], i, ray);
      if (span.is_empty()) return;
    }
    if (convex.quadric) {
      const auto face = std::uint32_t(convex.planes.size());
      const QuadricRange range = quadric_range(surfaces.quadrics()[*convex.quadric], ray);
      if (!range.outside) {
        span.clip({range.t0, face}, {range.t1, face});
      } else {
        // One of the cone's two halves is within the planes; the other touches them in the apex at most.
        Span low = span, high = span;
        low.clip({-kInfinity, 0}, {range.t0, face});
        high.clip({range.t1, face}, {kInfinity, 0});
        span = low.leave.t - low.enter.t > high.leave.t - high.enter.t ? low : high;
      }
    }
    emit(span);
  }

  void operator()(const TorusLeaf& torus) const;
  void operator()(const PrismLeaf& prism) const;
  void collect_walls(const PrismLeaf& prism, const Ray& own) const;
  void collect_curved_walls(const PrismLeaf& prism, const Ray& own) const;
  void operator()(const RevolutionLeaf& revolution) const;
  void operator()(const MeshLeaf& leaf_mesh) const;
  void operator()(const RoundedLeaf& rounded) const;
};

// From the point nearest to the center, in units of the torus: (t² + k)² = 4 R² ρ²(t).
void LeafCrossings::Finder::operator()(const TorusLeaf& torus) const {
  const double size = torus.ring_radius + torus.tube_radius;
  const Vec3d origin = transform_point(torus.primitive_from_object, ray.origin) * (1 / size);
  const Vec3d direction = transform_vector(torus.primitive_from_object, ray.direction) * (1 / size);
  const double speed = length(direction);
  const Vec3d d = direction * (1 / speed);
  const double nearest = -dot(origin, d);
  const Vec3d o = origin + d * nearest;
  const double oo = dot(o, o);
  if (oo >= 1) return;
  const double ring = torus.ring_radius / size, tube = torus.tube_radius / size;
  const double k = oo + ring * ring - tube * tube, r = 4 * ring * ring;
  const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y;
  const double reach = std::sqrt(1 - oo) * (1 + 1e-9);
  const Roots roots = find_roots({k * k - r * c, -2 * r * b, 2 * k - r * a, 0, 1}, -reach, reach);
  // The quartic squares thin tubes away: two of Newton's steps on the distance itself bring the digits back.
  const auto distance = [&](double t) {
    const Vec3d p = o + d * t;
    return std::hypot(std::hypot(p.x, p.y) - ring, p.z) - tube;
  };
  for (std::size_t i = 0; i < roots.count; ++i) {
    double t = roots.values[i];
    for (int step = 0; step < 2; ++step) {
      const Vec3d p = o + d * t;
      const double rho = std::hypot(p.x, p.y), off = std::hypot(rho - ring, p.z);
      if (!(rho > 0 && off > 0)) break;
      const double slope = ((rho - ring) * (p.x * d.x + p.y * d.y) / rho + p.z * d.z) / off;
      const double move = (off - tube) / slope;
      if (!(std::abs(move) < 1e-3 * tube)) break;
      t -= move;
    }
    buffers.candidates_.push_back({t, 0});
  }
  emit_between_candidates([&](double t) { return distance(t) < 0; });
  for (Crossing& crossing : buffers.found_) crossing.t = (crossing.t + nearest) / speed;
}

// In homogeneous coordinates (x, y, scale) the line in the plane of the region is origin × direction, and which
// side of it a vertex lies on is one number for both of its edges: no line passes between two walls.
void LeafCrossings::Finder::collect_walls(const PrismLeaf& prism, const Ray& own) const {
  const double growth = prism.growth().x;
  const Vec3d p{own.origin.x, own.origin.y, 1 + growth * (own.origin.z - prism.shape.z_low)};
  const Vec3d v{own.direction.x, own.direction.y, growth * own.direction.z};
  const Vec3d line = cross(p, v);
  const std::vector<RegionEdge>& edges = prism.region.edges();
  const auto is_left = [&](Vec2d at) { return line.x * at.x + line.y * at.y + line.z > 0; };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (is_left(edges[i].a) == is_left(edges[i].b)) continue;
    const double t = plane_t(surfaces.planes()[prism.walls[i].plane], ray);
    if (std::isfinite(t)) buffers.candidates_.push_back({t, std::uint32_t(i + 2)});
  }
}

// n·(x / scale_x, y / scale_y) = c times both scales: a quadratic in t.
void LeafCrossings::Finder::collect_curved_walls(const PrismLeaf& prism, const Ray& own) const {
  const Vec2d growth = prism.growth();
  const double above = own.origin.z - prism.shape.z_low;
  const Vec2d s0{1 + growth.x * above, 1 + growth.y * above};
  const Vec2d s1{growth.x * own.direction.z, growth.y * own.direction.z};
  const Vec3d o = own.origin, d = own.direction;
  const std::vector<RegionEdge>& edges = prism.region.edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [a, b] = edges[i];
    const Vec2d n{b.y - a.y, a.x - b.x};
    const double k = n.x * a.x + n.y * a.y;
    const double c0 = n.x * o.x * s0.y + n.y * o.y * s0.x - k * s0.x * s0.y;
    const double c1 = n.x * (o.x * s1.y + d.x * s0.y) + n.y * (o.y * s1.x + d.y * s0.x) -
                      k * (s0.x * s1.y + s1.x * s0.y);
    const double c2 = n.x * d.x * s1.y + n.y * d.y * s1.x - k * s1.x * s1.y;
    const double q = -(c1 + std::copysign(square_root(c1 * c1 - 4 * c0 * c2), c1)) / 2;
    for (const double t : {c0 / q, q / c2}) {
      const double sx = s0.x + s1.x * t, sy = s0.y + s1.y * t;
      const Vec2d at{(o.x + d.x * t) / sx - a.x, (o.y + d.y * t) / sy - a.y};
      const Vec2d along{b.x - a.x, b.y - a.y};
      const double u = (at.x * along.x + at.y * along.y) / (along.x * along.x + along.y * along.y);
      if (u >= -kBeyondEnd && u <= 1 + kBeyondEnd) {
        buffers.candidates_.push_back({t, std::uint32_t(i + 2)});
      }
    }
  }
}

void LeafCrossings::Finder::operator()(const PrismLeaf& prism) const {
  Span slab;
  slab.clip(surfaces, prism.low, 0, ray);
  slab.clip(surfaces, prism.high, 1, ray);
  if (slab.is_empty()) return;
  const Ray own{transform_point(prism.primitive_from_object, ray.origin),
                transform_vector(prism.primitive_from_object, ray.direction)};
  prism.walls.empty() ? collect_curved_walls(prism, own) : collect_walls(prism, own);
  std::vector<Crossing>& all = buffers.candidates_;
  std::erase_if(all,
                [&](const Crossing& c) { return !(c.t > slab.enter.t && c.t < slab.leave.t); });
  if (std::isfinite(slab.enter.t)) all.push_back(slab.enter);
  if (std::isfinite(slab.leave.t)) all.push_back(slab.leave);
  const Vec2d growth = prism.growth();
  emit_between_candidates([&](double t) {
    const Vec3d q = own.origin + own.direction * t;
    const double above = q.z - prism.shape.z_low;
    return prism.region.contains({q.x / (1 + growth.x * above), q.y / (1 + growth.y * above)});
  });
}

void LeafCrossings::Finder::operator()(const RevolutionLeaf& revolution) const {
  const Ray own{transform_point(revolution.primitive_from_object, ray.origin),
                transform_vector(revolution.primitive_from_object, ray.direction)};
  const std::vector<RegionEdge>& edges = revolution.region.edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec2d a = edges[i].a, b = edges[i].b;
    const auto add = [&](double t) {
      if (!std::isfinite(t)) return;
      const Vec3d q = own.origin + own.direction * t;
      const Vec2d at{std::hypot(q.x, q.y) - a.x, q.z - a.y}, along{b.x - a.x, b.y - a.y};
      const double squared = along.x * along.x + along.y * along.y;
      const double u = (at.x * along.x + at.y * along.y) / squared;
      // The other half of the double cone is as far off the edge's line as the line is off the axis.
      const double off = std::abs(at.x * along.y - at.y * along.x) / std::sqrt(squared);
      const double reach = std::abs(a.x) + std::abs(b.x) + std::sqrt(squared);
      if (u >= -kBeyondEnd && u <= 1 + kBeyondEnd && off < 1e-3 * reach) {
        buffers.candidates_.push_back({t, std::uint32_t(i)});
      }
    };
    if (const auto* ring = std::get_if<RevolutionLeaf::Ring>(&revolution.swept[i])) {
      add(plane_t(surfaces.planes()[ring->plane.plane], ray));
    } else if (const auto* band = std::get_if<RevolutionLeaf::Band>(&revolution.swept[i])) {
      const QuadricRange range = quadric_range(surfaces.quadrics()[band->quadric], ray);
      add(range.t0);
      add(range.t1);
    }
  }
  emit_between_candidates([&](double t) {
    const Vec3d q = own.origin + own.direction * t;
    return revolution.region.contains({std::hypot(q.x, q.y), q.z});
  });
}

void LeafCrossings::Finder::operator()(const MeshLeaf& leaf_mesh) const {
  std::vector<ClosedMesh::Crossing>& all = buffers.mesh_;
  all = buffers.cross_mesh(leaf_mesh.mesh, ray);
  for (ClosedMesh::Crossing& c : all) {
    const double t = plane_t(surfaces.planes()[leaf_mesh.planes[c.triangle].plane], ray);
    // Equal planes at one t; slivers whose plane means little keep their own.
    if (std::abs(t - c.t) * length(ray.direction) <=
        4 * kMergedDeviation * length(leaf.bounds.high - leaf.bounds.low)) {
      c.t = t;
    }
  }
  std::ranges::sort(all, [](const ClosedMesh::Crossing& a, const ClosedMesh::Crossing& b) {
    return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
  });
  int winding = 0;
  for (std::size_t i = 0; i < all.size();) {
    const int before = winding;
    const std::size_t first = i;
    for (; i < all.size() && all[i].t == all[first].t; ++i) winding += all[i].winding;
    if ((before != 0) != (winding != 0)) {
      buffers.found_.push_back({all[first].t, all[first].triangle});
    }
  }
  if (buffers.found_.size() % 2 != 0) buffers.found_.pop_back();
}

// Convex: the first and the last crossing with any of its pieces' surfaces.
void LeafCrossings::Finder::operator()(const RoundedLeaf& rounded) const {
  const Ray own{transform_point(rounded.primitive_from_object, ray.origin),
                transform_vector(rounded.primitive_from_object, ray.direction)};
  Crossing first{kInfinity, 0}, last{-kInfinity, 0};
  const auto add = [&](double t, std::size_t face) {
    if (t < first.t) first = {t, std::uint32_t(face)};
    if (t > last.t) last = {t, std::uint32_t(face)};
  };
  for (std::size_t i = 0; i < rounded.faces.size(); ++i) {
    const RoundedLeaf::Face& face = rounded.faces[i];
    const double t = plane_t(surfaces.planes()[face.moved.plane], ray);
    if (!std::isfinite(t)) continue;
    const Vec3d p = own.origin + own.direction * t;
    const bool over = std::ranges::all_of(face.sides, [&](const CsgHalfSpace& side) {
      return dot(side.normal, p) <= side.d + kBeyondEnd * rounded.radius;
    });
    if (over) add(t, i);
  }
  for (std::size_t i = 0; i < rounded.edges.size() && rounded.radius > 0; ++i) {
    const auto& [a, b] = rounded.edges[i];
    const Vec3d along = normalize(b - a);
    const double end = dot(b - a, along), scale = 1 / rounded.radius;
    const Vec3d from = own.origin - a;
    const Vec3d o = (from - along * dot(from, along)) * scale;
    const Vec3d d = (own.direction - along * dot(own.direction, along)) * scale;
    const QuadricRange range = round_range(o, d, Vec3d(1));
    for (const double t : {range.t0, range.t1}) {
      const double u = dot(from + own.direction * t, along);
      if (std::isfinite(t) && u >= 0 && u <= end) add(t, rounded.faces.size() + i);
    }
  }
  for (std::size_t i = 0; i < rounded.vertices.size() && rounded.radius > 0; ++i) {
    const double scale = 1 / rounded.radius;
    const QuadricRange range =
        round_range((own.origin - rounded.vertices[i]) * scale, own.direction * scale, Vec3d(1));
    if (range.t0 < range.t1) {
      add(range.t0, rounded.faces.size() + rounded.edges.size() + i);
      add(range.t1, rounded.faces.size() + rounded.edges.size() + i);
    }
  }
  emit({first, last});
}

const std::vector<ClosedMesh::Crossing>& LeafCrossings::cross_mesh(const ClosedMesh& mesh,
                                                                   const Ray& ray) {
  MeshMemo& memo = memos_[mesh.digest() % memos_.size()];
  if (memo.mesh != mesh.digest() || memo.ray.origin != ray.origin ||
      memo.ray.direction != ray.direction) {
    memo.crossings.clear();
    mesh.collect_crossings(ray, memo.crossings);
    memo.mesh = mesh.digest();
    memo.ray = ray;
  }
  return memo.crossings;
}

const std::vector<Crossing>& LeafCrossings::find(const PlacedLeaf& leaf,
                                                 const SurfaceTable& surfaces, const Ray& ray) {
  candidates_.clear();
  found_.clear();
  std::visit(Finder{*this, leaf, surfaces, ray}, leaf.shape);
  return found_;
}

}  // namespace arris
