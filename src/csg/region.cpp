#include "csg/region.h"

#include <limits>

namespace arris {

Region::Region(const CsgRegion& region) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  low_ = {kInfinity, kInfinity};
  high_ = {-kInfinity, -kInfinity};
  for (const std::vector<Vec2d>& outline : region.outlines) {
    if (outline.size() < 3) continue;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      low_ = {std::min(low_.x, a.x), std::min(low_.y, a.y)};
      high_ = {std::max(high_.x, a.x), std::max(high_.y, a.y)};
      if (!(a == b)) edges_.push_back({a, b});
    }
  }
}

bool Region::contains(Vec2d p) const {
  int winding = 0;
  for (const auto& [a, b] : edges_) {
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    if (a.y <= p.y) {
      winding += side > 0 ? 1 : 0;
    } else {
      winding -= side < 0 ? 1 : 0;
    }
  }
  return winding != 0;
}

bool Region::misses(const RegionEdge& e, Interval x, Interval y) {
  const Interval side = (Interval(e.b.x) - Interval(e.a.x)) * (y - Interval(e.a.y)) -
                        (Interval(e.b.y) - Interval(e.a.y)) * (x - Interval(e.a.x));
  return side.lo > 0 || side.hi < 0;
}

}  // namespace arris
