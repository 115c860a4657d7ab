#include "beam/outline_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace arris {
namespace {

using Polygon = std::vector<Vec2d>;

// Points nearer to a line than this part of the polygon's size are on it.
constexpr double kOnLine = 1e-12;

// Twice the area of the triangle, positive if it turns to the left.
double turn(Vec2d a, Vec2d b, Vec2d c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double twice_area(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += turn(p[0], p[i], p[(i + 1) % p.size()]);
  return sum;
}

double size_of(const Polygon& p) {
  const auto [left, right] = std::ranges::minmax(p, {}, &Vec2d::x);
  const auto [bottom, top] = std::ranges::minmax(p, {}, &Vec2d::y);
  return std::max(right.x - left.x, top.y - bottom.y);
}

Polygon without_repeats(const Polygon& p) {
  Polygon kept;
  for (const Vec2d& v : p) {
    if (kept.empty() || !(kept.back() == v)) kept.push_back(v);
  }
  while (kept.size() > 1 && kept.front() == kept.back()) kept.pop_back();
  return kept;
}

// Indices of the hull's vertices, counter-clockwise, without those on its sides: Andrew's chains.
std::vector<std::size_t> hull_of(const Polygon& p, double slack) {
  std::vector<std::size_t> order(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return p[a].x != p[b].x ? p[a].x < p[b].x : p[a].y != p[b].y ? p[a].y < p[b].y : a < b;
  });
  std::vector<std::size_t> hull;
  for (const bool lower : {true, false}) {
    const std::size_t base = hull.size();
    for (const std::size_t i : order) {
      while (hull.size() >= base + 2 &&
             turn(p[hull[hull.size() - 2]], p[hull.back()], p[i]) <= slack) {
        hull.pop_back();
      }
      hull.push_back(i);
    }
    hull.pop_back();
    if (lower) std::ranges::reverse(order);
  }
  return hull;
}

// Precondition: counter-clockwise. Nothing: it is no simple polygon.
std::optional<OutlinePart> part_of(const Polygon& p) {
  const double slack = kOnLine * size_of(p) * size_of(p);
  std::vector<std::size_t> hull = hull_of(p, slack);
  if (hull.size() < 3) return std::nullopt;
  OutlinePart part;
  for (const std::size_t i : hull) part.hull.push_back(p[i]);
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const std::size_t from = hull[k], to = hull[(k + 1) % hull.size()];
    const std::size_t steps = (to + p.size() - from) % p.size();
    const auto at = [&](std::size_t i) { return p[(from + i) % p.size()]; };
    bool on_side = true;
    for (std::size_t i = 1; i < steps; ++i) {
      on_side = on_side && std::abs(turn(at(0), at(steps), at(i))) <= slack;
    }
    if (on_side) continue;
    Polygon pocket;  // turned round, so that it is counter-clockwise, too
    for (std::size_t i = 0; i <= steps; ++i) pocket.push_back(at(steps - i));
    if (pocket.size() >= p.size()) return std::nullopt;
    std::optional<OutlinePart> below = part_of(pocket);
    if (!below) return std::nullopt;
    part.pockets.push_back(std::move(*below));
  }
  return part;
}

// More of its vertices and middles of edges are inside than outside; those on the outline itself count for neither.
bool holds(const Polygon& outer, const Polygon& inner) {
  int votes = 0;
  const auto vote = [&](Vec2d p) {
    bool inside = false;
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const Vec2d a = outer[i], b = outer[(i + 1) % outer.size()];
      if (p == a) return 0;
      if ((a.y <= p.y) != (b.y <= p.y)) inside ^= (turn(a, b, p) > 0) == (b.y > a.y);
    }
    return inside ? 1 : -1;
  };
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const Vec2d a = inner[i], b = inner[(i + 1) % inner.size()];
    votes += vote(a) + vote({a.x / 2 + b.x / 2, a.y / 2 + b.y / 2});
  }
  return votes > 0;
}

struct Edge {
  Vec2d a, b;
};

bool cross_each_other(const Edge& e, const Edge& f) {
  const double a = turn(e.a, e.b, f.a), b = turn(e.a, e.b, f.b);
  const double c = turn(f.a, f.b, e.a), d = turn(f.a, f.b, e.b);
  return ((a > 0 && b < 0) || (a < 0 && b > 0)) && ((c > 0 && d < 0) || (c < 0 && d > 0));
}

bool any_cross(const std::vector<Polygon>& outlines) {
  std::vector<Edge> edges;
  for (const Polygon& p : outlines) {
    for (std::size_t i = 0; i < p.size(); ++i) edges.push_back({p[i], p[(i + 1) % p.size()]});
  }
  if (edges.size() > kMostOutlineEdges) return true;
  const auto low = [](const Edge& e) { return std::min(e.a.x, e.b.x); };
  std::ranges::sort(edges, {}, low);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double right = std::max(edges[i].a.x, edges[i].b.x);
    for (std::size_t k = i + 1; k < edges.size() && low(edges[k]) <= right; ++k) {
      if (cross_each_other(edges[i], edges[k])) return true;
    }
  }
  return false;
}

// The smallest of the outlines that hold the hole.
std::optional<std::size_t> parent_of(const Polygon& hole, const std::vector<Polygon>& solids) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (!holds(solids[i], hole)) continue;
    if (!best || twice_area(solids[i]) < twice_area(solids[*best])) best = i;
  }
  return best;
}

}  // namespace

std::optional<std::vector<OutlinePart>> find_outline_parts(const CsgRegion& region) {
  std::vector<Polygon> all, solids, holes;
  for (const Polygon& outline : region.outlines) {
    Polygon p = without_repeats(outline);
    if (p.size() >= 3) all.push_back(std::move(p));
  }
  if (any_cross(all)) return std::nullopt;
  for (Polygon& p : all) {
    const double area = twice_area(p);
    if (area < 0) std::ranges::reverse(p);
    if (area != 0) (area > 0 ? solids : holes).push_back(std::move(p));
  }
  std::vector<OutlinePart> parts;
  for (const Polygon& p : solids) {
    std::optional<OutlinePart> part = part_of(p);
    if (!part) return std::nullopt;
    parts.push_back(std::move(*part));
  }
  for (const Polygon& hole : holes) {
    const std::optional<std::size_t> parent = parent_of(hole, solids);
    std::optional<OutlinePart> part = part_of(hole);
    if (!parent || !part) return std::nullopt;
    parts[*parent].pockets.push_back(std::move(*part));
  }
  return parts;
}

}  // namespace arris
