#include "csg/surfaces.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace arris {
namespace {

// Normals fall into cells of this size; those that may be merged differ by far less.
constexpr double kNormalGrid = 1e-3;
// How much the numbers by which candidates are looked up may differ, relative to their size.
constexpr double kLookup = 8 * kMergedDeviation;

double largest_coordinate(const Box3d& box) {
  const auto of = [](Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  return std::max(of(box.low), of(box.high));
}

// How far a surface of a leaf may move. Leaves without bounds share only equal planes, but for rounding.
double slack_of(const Box3d& leaf, double d) {
  const double size = largest_coordinate(leaf);
  if (!std::isfinite(size)) return 1e-12 * std::max(1.0, std::abs(d));
  const Vec3d extent = leaf.high - leaf.low;
  const double thickness = std::min({extent.x, extent.y, extent.z});
  return std::min(kMergedDeviation * size, kMergedThickness * thickness);
}

// Of a plane from another within the box.
double deviation(const CsgPlane& a, const CsgPlane& b, const Box3d& leaf) {
  const Vec3d n = a.normal - b.normal;
  if (!std::isfinite(largest_coordinate(leaf))) {
    return std::abs(a.d - b.d) + max_component(max(n, -n)) * std::max(1.0, std::abs(a.d));
  }
  const Vec3d c = (leaf.low + leaf.high) * 0.5, h = (leaf.high - leaf.low) * 0.5;
  return std::abs(dot(n, c) - (a.d - b.d)) + std::abs(n.x) * h.x + std::abs(n.y) * h.y +
         std::abs(n.z) * h.z;
}

// A number that equal quadrics share: of their matrix and its linear part, where scale doesn't matter.
double key_of(const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const Mat3d weighted{w * m.linear.x, w * m.linear.y, w * m.linear.z};
  const Mat3d a = transpose(m.linear) * weighted;
  const Vec3d b = transpose(weighted) * m.translation;
  const double norm = std::sqrt(dot(a.x, a.x) + dot(a.y, a.y) + dot(a.z, a.z));
  return dot(b, Vec3d(0.31, 0.73, 0.61)) / norm;
}

// How far, in lengths of `a`'s unit space, b's surface is from a's where |z| ≤ z_reach there.
double deviation(const CsgQuadric& a, const CsgQuadric& b, double z_reach) {
  const Affine3d m = a.unit_from_object * inverse(b.unit_from_object);
  const Vec3d w = weights_of(a.form);
  const Mat3d weighted{w * m.linear.x, w * m.linear.y, w * m.linear.z};
  Mat3d q = transpose(m.linear) * weighted;
  Vec3d t = m.translation;
  if (a.form == CsgQuadric::Form::cone) {
    const double scale = std::cbrt(std::abs(determinant(q)));
    q = {q.x * (1 / scale), q.y * (1 / scale), q.z * (1 / scale)};
  } else if (a.form == CsgQuadric::Form::cylinder) {
    const double tilt = std::hypot(m.linear.z.x, m.linear.z.y) * z_reach / std::abs(m.linear.z.z);
    if (!(tilt < 1)) return tilt;
    q.x.z = q.y.z = q.z.x = q.z.y = tilt;
    t.z = 0;
  }
  double worst = std::max({std::abs(t.x), std::abs(t.y), std::abs(t.z)});
  const Mat3d want{{w.x, 0, 0}, {0, w.y, 0}, {0, 0, w.z}};
  for (const Vec3d v : {q.x - want.x, q.y - want.y, q.z - want.z}) {
    worst = std::max({worst, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  return std::isfinite(worst) ? worst : 1;
}

}  // namespace

PlaneRef SurfaceTable::add(const CsgPlane& plane, const Box3d& leaf) {
  const double slack = slack_of(leaf, plane.d);
  const double size = std::min(largest_coordinate(leaf), std::max(1.0, std::abs(plane.d)) * 1e6);
  const double lookup = slack + kLookup * size;
  const auto low_cell = [](double x) { return int(std::floor(x / kNormalGrid - 0.5)); };
  for (const bool flipped : {false, true}) {
    const CsgPlane seen = flipped ? CsgPlane{-plane.normal, -plane.d} : plane;
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = planes_by_normal_.find({low_cell(seen.normal.x) + (corner & 1),
                                              low_cell(seen.normal.y) + ((corner >> 1) & 1),
                                              low_cell(seen.normal.z) + (corner >> 2)});
      if (at == planes_by_normal_.end()) continue;
      auto candidate = at->second.lower_bound(seen.d - lookup);
      for (; candidate != at->second.end() && candidate->first <= seen.d + lookup; ++candidate) {
        const std::uint32_t i = candidate->second;
        if (deviation(planes_[i], seen, leaf) <= std::min(slack, plane_slack_[i])) {
          return {i, flipped};
        }
      }
    }
  }
  const auto cell = [](double x) { return int(std::floor(x / kNormalGrid)); };
  const std::uint32_t index = std::uint32_t(planes_.size());
  planes_.push_back(plane);
  plane_slack_.push_back(slack);
  planes_by_normal_[{cell(plane.normal.x), cell(plane.normal.y), cell(plane.normal.z)}].emplace(
      plane.d, index);
  return {index, false};
}

std::uint32_t SurfaceTable::add(const CsgQuadric& quadric, const Box3d& leaf) {
  const double size = largest_coordinate(leaf);
  const double key = key_of(quadric);
  // In unit space the radius is about 1.
  const Mat3d object_from_unit = inverse(quadric.unit_from_object.linear);
  const double radius = std::min(length(object_from_unit.x), length(object_from_unit.y));
  const double slack = std::min(kMergedDeviation * size / radius, kMergedThickness);
  const Interval z =
      map_cell(quadric.unit_from_object, make_cell(leaf)).center.z +
      Interval(-1, 1) * Interval(length(leaf.high - leaf.low) / length(object_from_unit.z));
  const double z_reach = absolute(z).hi;
  const double lookup = kLookup * size;
  auto candidate = quadrics_by_key_.lower_bound(key - lookup);
  for (; candidate != quadrics_by_key_.end() && candidate->first <= key + lookup; ++candidate) {
    const CsgQuadric& known = quadrics_[candidate->second];
    if (known.form == quadric.form &&
        deviation(known, quadric, z_reach) <= std::min(slack, quadric_slack_[candidate->second])) {
      return candidate->second;
    }
  }
  quadrics_.push_back(quadric);
  quadric_slack_.push_back(slack);
  const std::uint32_t index = std::uint32_t(quadrics_.size() - 1);
  quadrics_by_key_.emplace(key, index);
  return index;
}

double SurfaceTable::value_of(std::uint32_t quadric, Vec3d p) const {
  const CsgQuadric& q = quadrics_[quadric];
  const Vec3d u = transform_point(q.unit_from_object, p);
  return dot(u * u, weights_of(q.form)) - constant_of(q.form);
}

Interval SurfaceTable::value_of(std::uint32_t quadric, const SpaceCell& cell) const {
  const CsgQuadric& q = quadrics_[quadric];
  return quadratic_range(map_cell(q.unit_from_object, cell), weights_of(q.form)) -
         Interval(constant_of(q.form));
}

Vec3d SurfaceTable::gradient_of(std::uint32_t quadric, Vec3d p) const {
  const CsgQuadric& q = quadrics_[quadric];
  const Vec3d u = transform_point(q.unit_from_object, p);
  return transpose(q.unit_from_object.linear) * (u * weights_of(q.form));
}

}  // namespace arris
