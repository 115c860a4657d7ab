// csg_even_odd.cpp — make_even_odd_region(): edges are cut where they meet, of coincident ones pairs cancel, and
// each of the rest has the inside on one side; walked with it at their left they close again
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "io/csg_region.h"

namespace arris {
namespace {

// Of the size: points nearer than this are one.
constexpr double kSamePoint = 1e-9;

using Index = std::uint32_t;

struct Edge {
  Index a = 0, b = 0;
};

// Points within a small distance of each other are one.
class PointSet {
 public:
  explicit PointSet(double tolerance) : tolerance_(tolerance) {}

  Index add(Vec2d p) {
    const std::int64_t x = cell(p.x), y = cell(p.y);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find(key(x + dx, y + dy));
        if (found == cells_.end()) continue;
        const Vec2d d = points_[found->second] - p;
        if (std::abs(d.x) <= tolerance_ && std::abs(d.y) <= tolerance_) return found->second;
      }
    }
    const auto index = Index(points_.size());
    points_.push_back(p);
    cells_.emplace(key(x, y), index);
    return index;
  }
  [[nodiscard]] Vec2d operator[](Index i) const { return points_[i]; }
  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  [[nodiscard]] std::int64_t cell(double x) const {
    return std::int64_t(std::floor(x / tolerance_));
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return std::uint64_t(x) * 0x9E3779B97F4A7C15U ^
           (std::uint64_t(y) + 0x7F4A7C15U) * 0xC2B2AE3D27D4EB4FU;
  }

  double tolerance_;
  std::vector<Vec2d> points_;
  std::unordered_map<std::uint64_t, Index> cells_;
};

// Edges by the strips of one axis that they reach into.
class Strips {
 public:
  Strips(const std::vector<Edge>& edges, const PointSet& points, double Vec2d::*axis, double low,
         double high)
      : axis_(axis), low_(low) {
    const double count = std::clamp(std::floor(2 * std::sqrt(double(edges.size()))), 1.0, 4096.0);
    strips_.resize(std::size_t(count));
    scale_ = high > low ? count / (high - low) : 0;
    for (Index i = 0; i < edges.size(); ++i) {
      const auto [first, last] =
          std::minmax({at(points[edges[i].a].*axis_), at(points[edges[i].b].*axis_)});
      for (std::size_t s = first; s <= last; ++s) strips_[s].push_back(i);
    }
  }
  [[nodiscard]] const std::vector<std::vector<Index>>& all() const { return strips_; }
  [[nodiscard]] const std::vector<Index>& of(Vec2d p) const { return strips_[at(p.*axis_)]; }

 private:
  [[nodiscard]] std::size_t at(double x) const {
    return std::size_t(std::clamp((x - low_) * scale_, 0.0, double(strips_.size() - 1)));
  }

  double Vec2d::*axis_;
  double low_, scale_ = 0;
  std::vector<std::vector<Index>> strips_;
};

class EvenOdd {
 public:
  explicit EvenOdd(const Bounds2d& bounds)
      : bounds_(bounds),
        tolerance_(kSamePoint *
                   std::max({bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y,
                             1e-3 * std::abs(bounds.high.x), 1e-3 * std::abs(bounds.high.y),
                             1e-3 * std::abs(bounds.low.x), 1e-3 * std::abs(bounds.low.y)})),
        points_(tolerance_) {}

  std::optional<CsgRegion> make(const std::vector<Outline>& outlines) {
    for (const Outline& outline : outlines) add(outline);
    if (!cut() || !orient()) return std::nullopt;
    return link();
  }

 private:
  void add(const Outline& outline) {
    std::vector<Index> corners;
    for (const Vec2d& p : outline) corners.push_back(points_.add(p));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Edge edge{corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]};
      if (edge.a != edge.b) edges_.push_back(edge);
    }
  }

  // A point of one edge on the other's inside.
  bool touch(Index e, Index point) {
    const Edge edge = edges_[e];
    if (point == edge.a || point == edge.b) return false;
    const Vec2d a = points_[edge.a], along = points_[edge.b] - a, d = points_[point] - a;
    const double squared = along.x * along.x + along.y * along.y;
    const double s = (d.x * along.x + d.y * along.y) / squared;
    if (!(s > 0 && s < 1) || std::abs(cross(along, d)) > tolerance_ * std::sqrt(squared))
      return false;
    cuts_[e].emplace_back(s, point);
    return true;
  }

  void meet(Index e, Index f) {
    const Edge p = edges_[e], q = edges_[f];
    bool touched = touch(e, q.a);
    touched |= touch(e, q.b);
    touched |= touch(f, p.a);
    touched |= touch(f, p.b);
    if (touched || p.a == q.a || p.a == q.b || p.b == q.a || p.b == q.b) return;
    const Vec2d a = points_[p.a], u = points_[p.b] - a, c = points_[q.a], v = points_[q.b] - c;
    const double det = cross(u, v);
    if (det == 0) return;
    const double s = cross(c - a, v) / det, t = cross(c - a, u) / det;
    if (!(s > 0 && s < 1 && t > 0 && t < 1)) return;
    const Index point = points_.add(a + u * s);
    cuts_[e].emplace_back(s, point);
    cuts_[f].emplace_back(t, point);
  }

  bool cut() {
    cuts_.resize(edges_.size());
    const Strips strips(edges_, points_, &Vec2d::x, bounds_.low.x, bounds_.high.x);
    for (const std::vector<Index>& strip : strips.all()) {
      work_ += std::uint64_t(strip.size()) * strip.size();
      if (work_ > kMaxRegionWork) return false;
      for (std::size_t i = 0; i < strip.size(); ++i) {
        const auto [y_low, y_high] =
            std::minmax({points_[edges_[strip[i]].a].y, points_[edges_[strip[i]].b].y});
        for (std::size_t k = i + 1; k < strip.size(); ++k) {
          const auto [z_low, z_high] =
              std::minmax({points_[edges_[strip[k]].a].y, points_[edges_[strip[k]].b].y});
          if (z_low <= y_high + tolerance_ && y_low <= z_high + tolerance_)
            meet(strip[i], strip[k]);
        }
      }
    }
    // Edges of long outlines meet many others; of coincident pieces an even number is none.
    std::map<std::pair<Index, Index>, bool> is_odd;
    for (Index e = 0; e < edges_.size(); ++e) {
      std::sort(cuts_[e].begin(), cuts_[e].end());
      Index from = edges_[e].a;
      const auto piece = [&](Index to) {
        if (to != from) is_odd[std::minmax(from, to)] ^= true;
        from = to;
      };
      for (const auto& [s, point] : cuts_[e]) piece(point);
      piece(edges_[e].b);
    }
    edges_.clear();
    for (const auto& [ends, odd] : is_odd) {
      if (odd) edges_.push_back({ends.first, ends.second});
    }
    return true;
  }

  // From an edge's middle along the other axis: an odd number of edges is crossed if that side is inside.
  bool orient() {
    const Strips by_x(edges_, points_, &Vec2d::x, bounds_.low.x, bounds_.high.x);
    const Strips by_y(edges_, points_, &Vec2d::y, bounds_.low.y, bounds_.high.y);
    std::vector<Edge> oriented = edges_;
    for (Index e = 0; e < edges_.size(); ++e) {
      const Vec2d a = points_[edges_[e].a], b = points_[edges_[e].b], middle = (a + b) * 0.5;
      const bool upward = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
      double Vec2d::*const along = upward ? &Vec2d::x : &Vec2d::y;
      double Vec2d::*const ray = upward ? &Vec2d::y : &Vec2d::x;
      const std::vector<Index>& strip = (upward ? by_x : by_y).of(middle);
      if ((work_ += strip.size()) > kMaxRegionWork) return false;
      bool inside = false;
      for (const Index other : strip) {
        const Vec2d c = points_[edges_[other].a], d = points_[edges_[other].b];
        if (other == e || (c.*along <= middle.*along) == (d.*along <= middle.*along)) continue;
        const double s = (middle.*along - c.*along) / (d.*along - c.*along);
        inside ^= c.*ray + s * (d.*ray - c.*ray) > middle.*ray;
      }
      const bool forward = b.*along > a.*along;
      if (forward != (upward == inside)) std::swap(oriented[e].a, oriented[e].b);
    }
    edges_ = std::move(oriented);
    return true;
  }

  std::optional<CsgRegion> link() {
    std::vector<std::vector<Index>> leaving(points_.size());
    for (const Edge& edge : edges_) leaving[edge.a].push_back(edge.b);
    CsgRegion region;
    std::vector<Index> path;
    std::vector<Index> place(points_.size(), 0);  // in the path, from 1
    for (const Edge& edge : edges_) {
      if (leaving[edge.a].empty()) continue;
      path = {edge.a};
      place[edge.a] = 1;
      while (!path.empty()) {
        std::vector<Index>& next = leaving[path.back()];
        if (next.empty()) {
          // Where a loop was cut out of the path, its first point may be done.
          if (path.size() == 1) {
            place[path.back()] = 0;
            break;
          }
          return std::nullopt;
        }
        const Index to = next.back();
        next.pop_back();
        if (place[to] == 0) {
          path.push_back(to);
          place[to] = Index(path.size());
          continue;
        }
        Outline outline;
        for (std::size_t i = place[to] - 1; i < path.size(); ++i)
          outline.push_back(points_[path[i]]);
        while (path.size() > place[to]) {
          place[path.back()] = 0;
          path.pop_back();
        }
        if (outline.size() >= 3) region.outlines.push_back(std::move(outline));
      }
    }
    return region;
  }

  Bounds2d bounds_;
  double tolerance_;
  PointSet points_;
  std::vector<Edge> edges_;
  std::vector<std::vector<std::pair<double, Index>>> cuts_;
  std::uint64_t work_ = 0;
};

}  // namespace

std::optional<CsgRegion> make_even_odd_region(const std::vector<Outline>& outlines) {
  Bounds2d bounds;
  for (const Outline& outline : outlines) {
    for (const Vec2d& p : outline) bounds.add(p);
  }
  if (bounds.is_empty() || !(bounds.high.x > bounds.low.x) || !(bounds.high.y > bounds.low.y)) {
    return CsgRegion{};
  }
  if (outlines.size() == 1) {
    CsgRegion region{outlines};
    if (signed_area(outlines[0]) < 0) std::ranges::reverse(region.outlines[0]);
    if (is_convex(region)) {
      // Doubled points would make edges without a direction.
      Outline& o = region.outlines[0];
      o.erase(std::unique(o.begin(), o.end()), o.end());
      if (o.size() > 1 && o.front() == o.back()) o.pop_back();
      if (o.size() >= 3) return region;
    }
  }
  return EvenOdd(bounds).make(outlines);
}

}  // namespace arris
