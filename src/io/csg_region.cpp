#include "io/csg_region.h"

#include <algorithm>
#include <cmath>

#include "geometry/polygon_holes.h"

namespace arris {

void Bounds2d::add(Vec2d p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y)};
}

void Bounds2d::add(const Bounds2d& b) {
  if (b.is_empty()) return;
  add(b.low);
  add(b.high);
}

double signed_area(const Outline& outline) {
  double doubled = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t next = i + 1 < outline.size() ? i + 1 : 0;
    doubled += cross(outline[i] - outline[0], outline[next] - outline[0]);
  }
  return doubled / 2;
}

Bounds2d bounds_of(const CsgRegion& region) {
  Bounds2d bounds;
  for (const Outline& outline : region.outlines) {
    for (const Vec2d& p : outline) bounds.add(p);
  }
  return bounds;
}

bool is_inside(const CsgRegion& region, Vec2d p) {
  int winding = 0;
  for (const Outline& outline : region.outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[i + 1 < outline.size() ? i + 1 : 0];
      const double side = cross(b - a, p - a);
      if (a.y <= p.y && b.y > p.y && side > 0) ++winding;
      if (a.y > p.y && b.y <= p.y && side < 0) --winding;
    }
  }
  return winding != 0;
}

bool is_convex(const CsgRegion& region) {
  if (region.outlines.size() != 1) return false;
  const Outline& o = region.outlines[0];
  double turn = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2d a = o[i], b = o[(i + 1) % o.size()], c = o[(i + 2) % o.size()];
    const double side = cross(b - a, c - b);
    if (side < 0) return false;
    turn += std::atan2(side, (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y));
  }
  return o.size() >= 3 && std::abs(turn - 2 * kPi) < 1 && signed_area(o) > 0;
}

// Sutherland and Hodgman: edges along the axis may double back, and wind round nothing.
CsgRegion clip_to_right(const CsgRegion& region) {
  CsgRegion right;
  for (const Outline& outline : region.outlines) {
    Outline clipped;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[i + 1 < outline.size() ? i + 1 : 0];
      if (a.x >= 0) clipped.push_back(a);
      if ((a.x < 0) != (b.x < 0)) {
        clipped.push_back({0, a.y + (b.y - a.y) * (a.x / (a.x - b.x))});
      }
    }
    const bool has_area =
        std::any_of(clipped.begin(), clipped.end(), [](Vec2d p) { return p.x > 0; });
    if (clipped.size() >= 3 && has_area) right.outlines.push_back(std::move(clipped));
  }
  return right;
}

namespace {

// Each hole to the smallest outline around one of its points.
std::optional<std::vector<std::vector<std::size_t>>> group_holes(const CsgRegion& region) {
  std::vector<std::size_t> outer;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < region.outlines.size(); ++i) {
    if (signed_area(region.outlines[i]) <= 0) continue;
    outer.push_back(i);
    groups.push_back({i});
  }
  for (std::size_t i = 0; i < region.outlines.size(); ++i) {
    const Outline& hole = region.outlines[i];
    if (signed_area(hole) > 0) continue;
    const Vec2d middle = (hole[0] + hole[1]) * 0.5;
    std::optional<std::size_t> best;
    for (std::size_t g = 0; g < outer.size(); ++g) {
      if (!is_inside({{region.outlines[outer[g]]}}, middle)) continue;
      if (!best ||
          signed_area(region.outlines[outer[g]]) < signed_area(region.outlines[outer[*best]])) {
        best = g;
      }
    }
    if (!best) return std::nullopt;
    groups[*best].push_back(i);
  }
  return groups;
}

}  // namespace

std::optional<std::vector<Triangle>> triangulate(const CsgRegion& region) {
  const auto groups = group_holes(region);
  if (!groups) return std::nullopt;
  const Bounds2d bounds = bounds_of(region);
  const Vec2d middle = (bounds.low + bounds.high) * 0.5;
  const double size = std::max(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y);
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> first;
  for (const Outline& outline : region.outlines) {
    first.push_back(std::uint32_t(points.size()));
    for (const Vec2d& p : outline) {
      points.emplace_back(float((p.x - middle.x) / size), float((p.y - middle.y) / size), 0.0F);
    }
  }
  std::vector<Triangle> triangles;
  HolePolygonTriangulator triangulator;
  for (const std::vector<std::size_t>& group : *groups) {
    std::vector<std::vector<std::uint32_t>> loops;
    for (const std::size_t outline : group) {
      std::vector<std::uint32_t>& loop = loops.emplace_back();
      for (std::uint32_t k = 0; k < region.outlines[outline].size(); ++k) {
        loop.push_back(first[outline] + k);
      }
    }
    const auto part = triangulator.triangulate(points, loops, {0, 0, 1});
    if (!part) return std::nullopt;
    triangles.insert(triangles.end(), part->begin(), part->end());
  }
  return triangles;
}

}  // namespace arris
