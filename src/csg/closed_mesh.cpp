#include "csg/closed_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/hash.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d center_of(const Box3d& box) {
  return box.low * 0.5 + box.high * 0.5;
}

// `inverse` is 1 / direction; infinite where the line has no slope.
bool line_meets(const Box3d& box, Vec3d origin, Vec3d inverse) {
  double t0 = -kInfinity, t1 = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double low = box.low[k] - origin[k], high = box.high[k] - origin[k];
    if (std::isinf(inverse[k])) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low * inverse[k], b = high * inverse[k];
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 <= t1 * (t1 > 0 ? 1 + 1e-12 : 1 - 1e-12);
}

// The line in the sheared frame of the paper: along +z through the origin.
struct Shear {
  int x, y, z;
  Vec3d origin;
  double shear_x, shear_y, scale_z;

  Shear(Vec3d origin_, Vec3d d) : origin(origin_) {
    z = std::abs(d.x) > std::abs(d.y) ? (std::abs(d.x) > std::abs(d.z) ? 0 : 2)
                                      : (std::abs(d.y) > std::abs(d.z) ? 1 : 2);
    x = (z + 1) % 3;
    y = (x + 1) % 3;
    if (d[z] < 0) std::swap(x, y);
    shear_x = d[x] / d[z];
    shear_y = d[y] / d[z];
    scale_z = 1 / d[z];
  }
  [[nodiscard]] Vec3d apply(Vec3d v) const {
    const Vec3d p = v - origin;
    return {p[x] - shear_x * p[z], p[y] - shear_y * p[z], scale_z * p[z]};
  }
};

// Positive if the line passes the edge a→b on its left; never 0, and negative for b→a.
double edge_side(Vec3d a, Vec3d b, std::uint32_t index_a, std::uint32_t index_b) {
  const bool turned = index_a > index_b;
  const Vec3d& from = turned ? b : a;
  const Vec3d& to = turned ? a : b;
  const double side = from.x * to.y - from.y * to.x;
  const double decided = side == 0 ? std::numeric_limits<double>::min() : side;
  return turned ? -decided : decided;
}

}  // namespace

ClosedMesh::ClosedMesh(std::vector<Vec3d> vertices, const std::vector<Triangle>& triangles)
    : vertices_(std::move(vertices)) {
  std::vector<Box3d> boxes;
  Box3d all{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const Triangle& t : triangles) {
    if (std::max({t[0], t[1], t[2]}) >= vertices_.size()) continue;
    triangles_.push_back(t);
    const Vec3d a = vertices_[t[0]], b = vertices_[t[1]], c = vertices_[t[2]];
    boxes.push_back({min(a, min(b, c)), max(a, max(b, c))});
    all = hull(all, boxes.back());
  }
  if (triangles_.empty()) return;
  slack_ = 1e-12 * std::max(max_component(all.high), max_component(-all.low));
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  tree_ = PlaceTree(std::move(order), boxes, slack_);
  make_digest();
}

// Of numbers, not of bytes: -0 is 0.
void ClosedMesh::make_digest() {
  std::uint32_t low = 1, high = 2;
  const auto add = [&](std::uint32_t value) {
    low = hash_combine(low, value);
    high = hash_combine(high, value);
  };
  for (const Vec3d& p : vertices_) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto bits = std::bit_cast<std::uint64_t>(p[axis] + 0.0);
      add(std::uint32_t(bits));
      add(std::uint32_t(bits >> 32U));
    }
  }
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t vertex : t) add(vertex);
  }
  digest_ = (std::uint64_t{high} << 32U) | low;
}

Vec3d ClosedMesh::normal_of(std::uint32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return cross(vertices_[t[1]] - vertices_[t[0]], vertices_[t[2]] - vertices_[t[0]]);
}

void ClosedMesh::collect_crossings(const Ray& ray, std::vector<Crossing>& out) const {
  if (tree_.is_empty()) return;
  // From the point nearest to the mesh, where the numbers are small.
  const double skipped = dot(center_of(tree_.bounds()) - ray.origin, ray.direction) /
                         dot(ray.direction, ray.direction);
  const Vec3d origin = ray.origin + ray.direction * skipped;
  const Shear shear(origin, ray.direction);
  const Vec3d inverse = Vec3d(1) / ray.direction;
  const auto cross_triangle = [&](std::uint32_t i) {
    const Triangle& t = triangles_[i];
    const Vec3d a = shear.apply(vertices_[t[0]]), b = shear.apply(vertices_[t[1]]),
                c = shear.apply(vertices_[t[2]]);
    const double u = edge_side(b, c, t[1], t[2]), v = edge_side(c, a, t[2], t[0]),
                 w = edge_side(a, b, t[0], t[1]);
    if ((u > 0) != (v > 0) || (v > 0) != (w > 0)) return true;
    const double t_hit = (u * a.z + v * b.z + w * c.z) / (u + v + w);
    // Seen along the line, a face that turns counter-clockwise looks away: the line leaves there.
    out.push_back({skipped + t_hit, i, u > 0 ? -1 : 1});
    return true;
  };
  tree_.visit([&](const Box3d& box) { return line_meets(box, origin, inverse); }, cross_triangle);
}

bool ClosedMesh::contains(Vec3d p) const {
  // A direction that no modelled edge has.
  const Ray ray{p, {0.4213, 0.6317, 0.6509}};
  std::vector<Crossing> crossings;
  collect_crossings(ray, crossings);
  int winding = 0;
  for (const Crossing& c : crossings) winding += c.t < 0 ? c.winding : 0;
  return winding != 0;
}

Cover ClosedMesh::cover(const SpaceCell& cell) const {
  const auto range = [&](int axis) {
    Vec3d n;
    n[axis] = 1;
    return linear_range(cell, n);
  };
  const Interval x = range(0), y = range(1), z = range(2);
  const auto apart = [&](const Box3d& b) {
    return b.low.x > x.hi || b.high.x < x.lo || b.low.y > y.hi || b.high.y < y.lo ||
           b.low.z > z.hi || b.high.z < z.lo;
  };
  bool is_on = false;
  const auto may_be_apart = [&](std::uint32_t i) {
    const Triangle& t = triangles_[i];
    const Vec3d a = vertices_[t[0]], b = vertices_[t[1]], c = vertices_[t[2]];
    if (apart({min(a, min(b, c)), max(a, max(b, c))})) return true;
    const Vec3d n = normal_of(i);
    const Interval height = linear_range(cell, n) - dot(to_intervals(n), to_intervals(a));
    // The rounding of n itself moves the plane; triangles without area are seen by their box alone.
    const double slack = slack_ * std::sqrt(dot(n, n));
    is_on = height.lo <= slack && height.hi >= -slack;
    return !is_on;
  };
  tree_.visit([&](const Box3d& box) { return !apart(box); }, may_be_apart);
  if (is_on) return Cover::on;
  const Vec3d middle{x.lo / 2 + x.hi / 2, y.lo / 2 + y.hi / 2, z.lo / 2 + z.hi / 2};
  return contains(middle) ? Cover::in : Cover::out;
}

}  // namespace arris
