#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace arris {
namespace {

// Corners that turn by less than this angle's sine count as collinear: coordinates are rounded to
// 24 bits, which turns edges of a thousandth of the polygon's size by up to 1e-4.
constexpr double kCollinearSine = 1e-5;

// Newell's vector area: twice the area times the normal, whatever the polygon's shape.
Vec3d vector_area(std::span<const Vec3f> corners) {
  const Vec3d origin(corners[0]);
  Vec3d sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += cross(Vec3d(corners[i]) - origin, Vec3d(corners[i + 1]) - origin);
  }
  return sum;
}

double squared_distance(Vec2d a, Vec2d b) {
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

}  // namespace

std::span<const Triangle> PolygonTriangulator::triangulate(std::span<const Vec3f> corners) {
  const auto count = std::uint32_t(corners.size());
  triangles_.clear();
  if (count == 3) {
    triangles_.push_back({0, 1, 2});
    return triangles_;
  }
  project(corners);
  link(corners.size());
  if (is_convex()) {
    for (std::uint32_t i = 1; i + 1 < count; ++i) triangles_.push_back({0, i, i + 1});
  } else if (!clip_ears()) {
    triangles_.clear();
  }
  return triangles_;
}

// Leaving out the largest component of the normal keeps the sense of every turn.
void PolygonTriangulator::project(std::span<const Vec3f> corners) {
  const Vec3d normal = vector_area(corners);
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool mirrored = normal[axis] < 0;
  points_.clear();
  for (const Vec3f& corner : corners) {
    const double a = corner[u], b = corner[v];
    points_.push_back(mirrored ? Vec2d{b, a} : Vec2d{a, b});
  }
}

void PolygonTriangulator::link(std::size_t count) {
  previous_.resize(count);
  next_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    previous_[i] = std::uint32_t((i + count - 1) % count);
    next_[i] = std::uint32_t((i + 1) % count);
  }
}

double PolygonTriangulator::doubled_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const Vec2d p = points_[a], q = points_[b], r = points_[c];
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

// Below this a corner b between a and c is collinear.
double PolygonTriangulator::least_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return kCollinearSine * std::sqrt(squared_distance(points_[a], points_[b]) *
                                    squared_distance(points_[b], points_[c]));
}

// Turns left everywhere, and once around: the edges' directions pass the x axis upward once.
bool PolygonTriangulator::is_convex() const {
  int turns = 0;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t a = previous_[i], c = next_[i];
    if (!(doubled_area(a, i, c) > least_area(a, i, c))) return false;
    const bool rises_before = points_[i].y > points_[a].y;
    const bool rises_after = points_[c].y > points_[i].y;
    if (!rises_before && rises_after) ++turns;
  }
  return turns == 1;
}

bool PolygonTriangulator::is_ear(std::uint32_t corner, Rule rule) {
  const std::uint32_t a = previous_[corner], c = next_[corner];
  const double area = doubled_area(a, corner, c);
  if (rule == Rule::any) return true;
  if (rule == Rule::proper && !(area > least_area(a, corner, c))) return false;
  if (rule == Rule::flat && !(area >= 0)) return false;
  const Vec2d p = points_[a], q = points_[corner], r = points_[c];
  work_ += reflex_.size();
  return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t other) {
    const Vec2d o = points_[other];
    // A bridge to a hole passes its corners twice: they do not hinder each other.
    if (clipped_[other] != 0 || o == p || o == q || o == r) return false;
    return doubled_area(a, corner, other) >= 0 && doubled_area(corner, c, other) >= 0 &&
           doubled_area(c, a, other) >= 0;
  });
}

bool PolygonTriangulator::clip_ears() {
  // 1. A corner inside an ear implies one that does not turn left inside it; corners only ever change
  //    from turning right to turning left.
  const auto count = std::uint32_t(points_.size());
  reflex_.clear();
  clipped_.assign(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = previous_[i], c = next_[i];
    if (!(doubled_area(a, i, c) > least_area(a, i, c))) reflex_.push_back(i);
  }
  // 2. Cut ears on the way round; a full round without one relaxes the rule until the next cut.
  Rule rule = Rule::proper;
  std::uint32_t corner = 0, left = count, misses = 0;
  while (left > 3) {
    if (++work_ > max_work_) return false;
    if (!is_ear(corner, rule)) {
      corner = next_[corner];
      if (++misses < left) continue;
      rule = rule == Rule::proper ? Rule::flat : Rule::any;
      misses = 0;
      continue;
    }
    const std::uint32_t a = previous_[corner], c = next_[corner];
    triangles_.push_back({a, corner, c});
    next_[a] = c;
    previous_[c] = a;
    clipped_[corner] = 1;
    --left;
    // Going on after the neighbour spreads the ears instead of making a fan of slivers.
    corner = next_[c];
    rule = Rule::proper;
    misses = 0;
  }
  triangles_.push_back({previous_[corner], corner, next_[corner]});
  return true;
}

}  // namespace arris
