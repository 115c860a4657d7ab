// cover.h — where a piece of space lies relative to a solid, and the pieces that can be asked about
// What       Cover is three-valued: `out` and `in` are certain, `on` is not decided. SpaceCell is an affine image of
//            a cube: axis-aligned boxes are such, and a beam renderer bounds pieces of its pyramids by slanted ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "arris/math.h"
#include "base/interval.h"

namespace arris {

enum class Cover : std::uint8_t { out, in, on };

constexpr Cover operator!(Cover c) {
  return c == Cover::on ? Cover::on : c == Cover::in ? Cover::out : Cover::in;
}
constexpr Cover operator&(Cover a, Cover b) {
  if (a == Cover::out || b == Cover::out) return Cover::out;
  return a == Cover::in && b == Cover::in ? Cover::in : Cover::on;
}
constexpr Cover operator|(Cover a, Cover b) {
  return !((!a) & (!b));
}

using Vec3i = Vec3<Interval>;

struct Box3d {
  Vec3d low, high;

  [[nodiscard]] bool is_empty() const {
    return !(low.x <= high.x && low.y <= high.y && low.z <= high.z);
  }
  friend Box3d hull(const Box3d& a, const Box3d& b) {
    return {min(a.low, b.low), max(a.high, b.high)};
  }
  friend Box3d intersection(const Box3d& a, const Box3d& b) {
    return {max(a.low, b.low), min(a.high, b.high)};
  }
};

// Each bit of the index chooses one end of an axis.
inline std::array<Vec3d, 8> corners_of(const Box3d& box) {
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {(i & 1U) != 0 ? box.high.x : box.low.x, (i & 2U) != 0 ? box.high.y : box.low.y,
                  (i & 4U) != 0 ? box.high.z : box.low.z};
  }
  return corners;
}

// All points center + Σ u_i · half[i] with |u_i| ≤ 1. Intervals, as a cell is mapped into frames of primitives.
struct SpaceCell {
  Vec3i center;
  Vec3i half[3];
};

inline Vec3i to_intervals(Vec3d v) {
  return {Interval(v.x), Interval(v.y), Interval(v.z)};
}

// Contains the box. Precondition: finite.
inline SpaceCell make_cell(const Box3d& box) {
  const auto half = [](double low, double high, double center) {
    return std::max(next_up(high - center), next_up(center - low));
  };
  const Vec3d c = box.low * 0.5 + box.high * 0.5;
  return {to_intervals(c),
          {{half(box.low.x, box.high.x, c.x), 0.0, 0.0},
           {0.0, half(box.low.y, box.high.y, c.y), 0.0},
           {0.0, 0.0, half(box.low.z, box.high.z, c.z)}}};
}
// From exact doubles.
inline SpaceCell make_cell(Vec3d center, const Mat3d& half) {
  return {to_intervals(center), {to_intervals(half.x), to_intervals(half.y), to_intervals(half.z)}};
}

inline Vec3i map_vector(const Mat3d& m, const Vec3i& v) {
  return to_intervals(m.x) * v.x + to_intervals(m.y) * v.y + to_intervals(m.z) * v.z;
}
inline SpaceCell map_cell(const Affine3d& m, const SpaceCell& cell) {
  return {map_vector(m.linear, cell.center) + to_intervals(m.translation),
          {map_vector(m.linear, cell.half[0]), map_vector(m.linear, cell.half[1]),
           map_vector(m.linear, cell.half[2])}};
}

// The values of normal·x over the cell: exact but for rounding.
inline Interval linear_range(const SpaceCell& cell, Vec3d normal) {
  const Vec3i n = to_intervals(normal);
  const Interval middle = dot(n, cell.center);
  const Interval reach = absolute(dot(n, cell.half[0])) + absolute(dot(n, cell.half[1])) +
                         absolute(dot(n, cell.half[2]));
  return {next_down(middle.lo - reach.hi), next_up(middle.hi + reach.hi)};
}

// Holds the cell.
inline Box3d box_of(const SpaceCell& cell) {
  const Interval x = linear_range(cell, {1, 0, 0}), y = linear_range(cell, {0, 1, 0}),
                 z = linear_range(cell, {0, 0, 1});
  return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
}

// The t in [0, end] at which a ray of these origins and directions may be in the box; nothing: none is, ever.
std::optional<Interval> depths_in(const Box3d& box, const Vec3i& origin, const Vec3i& direction,
                                  double end);

// The values of Σ weights_i x_i² over the cell. Exact but for rounding where the half axes are orthogonal under the
// weights (boxes under similarities; along the axis for cylinders), else too wide by the square of the cell's size.
Interval quadratic_range(const SpaceCell& cell, Vec3d weights);

// No point of the cell is farther from its center.
double radius_of(const SpaceCell& cell);

}  // namespace arris
