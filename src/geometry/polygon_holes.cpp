#include "geometry/polygon_holes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

// Of the polygon's area: what rounding to float may cost.
constexpr double kAreaTolerance = 1e-4;

double doubled_area(Vec2d a, Vec2d b, Vec2d c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_in_triangle(Vec2d a, Vec2d b, Vec2d c, Vec2d p) {
  return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
}

}  // namespace

std::optional<std::span<const Triangle>> HolePolygonTriangulator::triangulate(
    std::span<const Vec3f> points, std::span<const std::vector<std::uint32_t>> loops,
    Vec3d normal) {
  project(points, loops, normal);
  if (outlines_ != 1) return std::nullopt;
  outline_ = loops[outer_];
  // From the right, so that each hole sees the outline or a hole joined before.
  std::ranges::sort(holes_, [](const Loop& a, const Loop& b) {
    return a.rightmost != b.rightmost ? a.rightmost > b.rightmost : a.index < b.index;
  });
  for (const Loop& hole : holes_) {
    if (!join(loops[hole.index])) return std::nullopt;
  }
  if (!cover(points, normal, area_)) return std::nullopt;
  return triangles_;
}

// Leaves out the normal's largest component; the sense of turns is kept.
void HolePolygonTriangulator::project(std::span<const Vec3f> points,
                                      std::span<const std::vector<std::uint32_t>> loops,
                                      Vec3d normal) {
  const double nx = std::abs(normal.x), ny = std::abs(normal.y), nz = std::abs(normal.z);
  const int axis = nx > ny && nx > nz ? 0 : ny > nz ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool mirrored = normal[axis] < 0;
  flat_.resize(std::max(flat_.size(), points.size()));
  holes_.clear();
  area_ = 0;
  outlines_ = 0;
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    double area = 0;
    double rightmost = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : loops[i]) {
      const double a = points[c][u], b = points[c][v];
      flat_[c] = mirrored ? Vec2d{b, a} : Vec2d{a, b};
      rightmost = std::max(rightmost, flat_[c].x);
    }
    for (std::size_t k = 1; k + 1 < loops[i].size(); ++k) {
      area += doubled_area(flat_[loops[i][0]], flat_[loops[i][k]], flat_[loops[i][k + 1]]) / 2;
    }
    area_ += area / std::abs(normal[axis]);
    if (area > 0) {
      outer_ = i;
      ++outlines_;
    } else {
      holes_.push_back({i, area, rightmost});
    }
  }
}

// The outline's corner that sees `from`, to its right: as Eberly has it, the end of the edge that the ray along +x
// meets first, or the corner nearest to the ray in direction within the triangle they span.
std::optional<std::size_t> HolePolygonTriangulator::visible_corner(Vec2d from) const {
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    const std::size_t j = (i + 1) % outline_.size();
    const Vec2d a = flat_[outline_[i]], b = flat_[outline_[j]];
    // The inside is to the left: only edges that go up bound it towards +x.
    if (!(a.y <= from.y && b.y >= from.y) || a.y == b.y) continue;
    const double x = a.x + (b.x - a.x) * (from.y - a.y) / (b.y - a.y);
    if (x < from.x || x >= nearest) continue;
    nearest = x;
    best = b.y == from.y ? j : a.y == from.y ? i : a.x > b.x ? i : j;
  }
  if (!best) return std::nullopt;
  const Vec2d met{nearest, from.y};
  const Vec2d corner = flat_[outline_[*best]];
  if (corner.y == from.y) return best;
  const bool above = corner.y > from.y;
  double least_slope = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> hidden;
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    const Vec2d p = flat_[outline_[i]];
    if (p.x <= from.x || p.x > std::max(met.x, corner.x) || p == corner) continue;
    const bool inside =
        above ? is_in_triangle(from, met, corner, p) : is_in_triangle(from, corner, met, p);
    if (!inside) continue;
    const double slope = std::abs(p.y - from.y) / (p.x - from.x);
    if (slope < least_slope) {
      least_slope = slope;
      hidden = i;
    }
  }
  return hidden ? hidden : best;
}

bool HolePolygonTriangulator::join(const std::vector<std::uint32_t>& hole) {
  const auto start = std::ranges::max_element(
      hole, [&](std::uint32_t a, std::uint32_t b) { return flat_[a].x < flat_[b].x; });
  std::optional<std::size_t> at = visible_corner(flat_[*start]);
  if (!at) return false;
  // A corner that bridges have doubled appears more than once: take the copy whose angle the bridge lies in.
  const Vec2d from = flat_[*start];
  const std::uint32_t wanted = outline_[*at];
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    if (outline_[i] != wanted) continue;
    const Vec2d p = flat_[outline_[(i + outline_.size() - 1) % outline_.size()]];
    const Vec2d q = flat_[wanted];
    const Vec2d n = flat_[outline_[(i + 1) % outline_.size()]];
    const bool left_of_in = doubled_area(p, q, from) > 0;
    const bool left_of_out = doubled_area(q, n, from) > 0;
    const bool convex = doubled_area(p, q, n) > 0;
    if (convex ? left_of_in && left_of_out : left_of_in || left_of_out) {
      at = i;
      break;
    }
  }
  std::vector<std::uint32_t> bridge;
  bridge.reserve(hole.size() + 2);
  bridge.insert(bridge.end(), start, hole.end());
  bridge.insert(bridge.end(), hole.begin(), start + 1);
  bridge.push_back(wanted);
  outline_.insert(outline_.begin() + std::ptrdiff_t(*at) + 1, bridge.begin(), bridge.end());
  return true;
}

bool HolePolygonTriangulator::cover(std::span<const Vec3f> points, Vec3d normal, double area) {
  triangles_.clear();
  if (outline_.size() < 3) return false;
  corners_.clear();
  for (const std::uint32_t c : outline_) corners_.push_back(points[c]);
  double sum = 0;
  for (const Triangle& t : ears_.triangulate(corners_)) {
    const Vec3d a(corners_[t[0]]), b(corners_[t[1]]), c(corners_[t[2]]);
    const double part = dot(cross(b - a, c - a), normal) / 2;
    if (part < -kAreaTolerance * area) return false;
    sum += std::abs(part);
    triangles_.push_back({outline_[t[0]], outline_[t[1]], outline_[t[2]]});
  }
  return !triangles_.empty() && std::abs(sum - area) <= kAreaTolerance * area;
}

}  // namespace arris
