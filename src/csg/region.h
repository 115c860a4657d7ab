// region.h — regions of the plane: is a point inside, does a rectangle lie inside
// What       edges of closed outlines; inside is where they wind round a number of times that isn't 0
// Guarantee  contains() counts each edge half-open: a point is never lost between two edges
// Cost       linear in the edges
#pragma once

#include <cstdint>
#include <vector>

#include "arris/csg.h"
#include "csg/cover.h"

namespace arris {

struct RegionEdge {
  Vec2d a, b;
};

class Region {
 public:
  Region() = default;
  // Edges without length and outlines of fewer than three points are left out.
  explicit Region(const CsgRegion& region);

  [[nodiscard]] const std::vector<RegionEdge>& edges() const { return edges_; }
  [[nodiscard]] Vec2d low() const { return low_; }
  [[nodiscard]] Vec2d high() const { return high_; }
  [[nodiscard]] bool contains(Vec2d p) const;
  // on: an edge may meet the rectangle.
  [[nodiscard]] Cover cover(Interval x, Interval y) const {
    return cover(x, y, [](std::size_t) { return true; });
  }
  // may_meet(edge) tells more about edges whose own box meets the rectangle.
  template <class MayMeet>
  [[nodiscard]] Cover cover(Interval x, Interval y, const MayMeet& may_meet) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const auto& [a, b] = edges_[i];
      if (std::max(a.x, b.x) < x.lo || std::min(a.x, b.x) > x.hi || std::max(a.y, b.y) < y.lo ||
          std::min(a.y, b.y) > y.hi || misses(edges_[i], x, y) || !may_meet(i)) {
        continue;
      }
      return Cover::on;
    }
    const Vec2d middle{x.lo / 2 + x.hi / 2, y.lo / 2 + y.hi / 2};
    return contains(middle) ? Cover::in : Cover::out;
  }

 private:
  // The edge's line passes the rectangle.
  [[nodiscard]] static bool misses(const RegionEdge& e, Interval x, Interval y);

  std::vector<RegionEdge> edges_;
  Vec2d low_, high_;
};

}  // namespace arris
