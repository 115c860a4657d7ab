#include "rounding/solid_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "edges/welded_mesh.h"

namespace arris {
namespace {

// Of some of the triangles.
std::vector<Box> boxes_of(const std::vector<SurfaceTriangle>& triangles,
                          std::span<const std::uint32_t> some, double reach) {
  std::vector<Box> boxes;
  boxes.reserve(some.size());
  for (const std::uint32_t i : some) {
    const auto& [p0, p1, p2, region, index] = triangles[i];
    append_triangle_boxes({p0, p1, p2}, reach, i, boxes);
  }
  return boxes;
}

std::vector<Box> boxes_of(const std::vector<SurfaceTriangle>& triangles, double reach) {
  std::vector<std::uint32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return boxes_of(triangles, all, reach);
}

// Relative to the radius: what is no nearer than this short of it only touches.
constexpr double kTouching = 1e-6;

// On which side of the line a→b the ray passes; the exact negative for b→a, so that no ray slips between triangles.
double side_of(Vec3d origin, Vec3d direction, Vec3d a, Vec3d b) {
  if (b.x < a.x || (b.x == a.x && (b.y < a.y || (b.y == a.y && b.z < a.z)))) {
    return -dot(direction, cross(b - origin, a - origin));
  }
  return dot(direction, cross(a - origin, b - origin));
}

// Of a line that crosses the triangle's plane outward.
bool is_outward_through(Vec3d origin, Vec3d direction, const SurfaceTriangle& t) {
  return side_of(origin, direction, t.p1, t.p2) >= 0 &&
         side_of(origin, direction, t.p2, t.p0) >= 0 && side_of(origin, direction, t.p0, t.p1) >= 0;
}

}  // namespace

bool is_beyond_reach(const std::array<Vec3d, 3>& corners, Vec3d normal, const SurfaceTriangle& t,
                     double reach) {
  const auto is_beyond = [](double h0, double h1, double h2, double limit) {
    return std::min({h0, h1, h2}) >= limit || std::max({h0, h1, h2}) <= -limit;
  };
  const auto over = [&](Vec3d p) { return dot(normal, p - corners[0]); };
  if (is_beyond(over(t.p0), over(t.p1), over(t.p2), reach)) return true;
  const Vec3d n = cross(t.p1 - t.p0, t.p2 - t.p0);
  const auto over_t = [&](Vec3d p) { return dot(n, p - t.p0); };
  return is_beyond(over_t(corners[0]), over_t(corners[1]), over_t(corners[2]), reach * length(n));
}

bool may_be_cut(const std::array<Vec3d, 3>& centers, Vec3d normal, const SurfaceTriangle& t,
                double radius) {
  const double reach = (1 - kTouching) * radius;
  if (is_beyond_reach(centers, normal, t, reach)) return false;
  // All of t lies behind the plane through its point that is nearest to a centre.
  const Vec3d middle = (centers[0] + centers[1] + centers[2]) / 3.0;
  const Vec3d foot = nearest_on_triangle(middle, t), away = middle - foot;
  const double limit = reach * length(away);
  return std::ranges::any_of(centers, [&](Vec3d c) { return dot(c - foot, away) < limit; });
}

SolidSurface::SolidSurface(const std::vector<SurfaceTriangle>& triangles, double reach)
    : tree_(boxes_of(triangles, reach)), reach_(reach) {
  triangles_.reserve(triangles.size());
  for (const std::uint32_t i : tree_.renumber()) triangles_.push_back(triangles[i]);
}

bool SolidSurface::is_near(Vec3d x, double distance, std::uint32_t but_region) const {
  return tree_.any_near(x - Vec3d(distance), x + Vec3d(distance), [&](std::uint32_t i) {
    return triangles_[i].region != but_region &&
           reaches_near(triangles_[i], x, distance, but_region);
  });
}

std::optional<SolidSurface::NearestPlace> SolidSurface::nearest(Vec3d x, double within) const {
  NearestPlace found{nullptr, {}, within};
  tree_.for_each_within(x, found.distance, [&](std::uint32_t i) {
    if (is_plainly_beyond(x, triangles_[i], found.distance)) return;
    const Vec3d place = nearest_on_triangle(x, triangles_[i]);
    const double distance = length(x - place);
    if (distance < found.distance) found = {&triangles_[i], place, distance};
  });
  if (found.triangle == nullptr) return std::nullopt;
  return found;
}

bool SolidSurface::is_one_near(std::span<const std::uint32_t> triangles, Vec3d x, double distance,
                               std::uint32_t but_region) const {
  return std::any_of(triangles.begin(), triangles.end(), [&](std::uint32_t i) {
    return reaches_near(triangles_[i], x, distance, but_region);
  });
}

bool SolidSurface::reaches_near(const SurfaceTriangle& t, Vec3d x, double distance,
                                std::uint32_t face) const {
  if (is_plainly_beyond(x, t, distance)) return false;
  const Vec3d foot = nearest_on_triangle(x, t);
  return length_squared(x - foot) < distance * distance && !is_joined(face, t.region) &&
         !is_on_joined(foot, kTouching * distance, face);
}

bool SolidSurface::is_on_joined(Vec3d x, double tolerance, std::uint32_t face) const {
  if (pairs_of(joined_, face).empty()) return false;
  return tree_.any_near(x - Vec3d(tolerance), x + Vec3d(tolerance), [&](std::uint32_t i) {
    const SurfaceTriangle& t = triangles_[i];
    return is_joined(face, t.region) && length(x - nearest_on_triangle(x, t)) < tolerance;
  });
}

void SolidSurface::set_walls(ThinWalls walls) {
  blades_ = std::move(walls.blades);
  needles_ = std::move(walls.needles);
  wall_tree_ = BoxTree(boxes_of(triangles_, walls.sides, reach_));
  rod_tree_ = BoxTree(boxes_of(triangles_, walls.rods, reach_));
}

bool SolidSurface::is_needle(std::span<const std::uint32_t> faces) const {
  const auto has = [&](std::uint32_t face, std::uint32_t corner) {
    return std::ranges::binary_search(needles_, std::pair(face, corner));
  };
  const auto face = [](const auto& needle) { return needle.first; };
  for (auto n = std::ranges::lower_bound(needles_, faces.front(), {}, face);
       n != needles_.end() && n->first == faces.front(); ++n) {
    if (std::all_of(faces.begin(), faces.end(),
                    [&](std::uint32_t f) { return has(f, n->second); })) {
      return true;
    }
  }
  return false;
}

SolidSurface::Exit SolidSurface::first_exit(Vec3d origin, Vec3d direction, double after,
                                            double before) const {
  Exit exit{before, kNone, {}};
  tree_.for_each_along(origin, direction, after, exit.t, [&](std::uint32_t i) {
    const SurfaceTriangle& t = triangles_[i];
    const Vec3d normal = cross(t.p1 - t.p0, t.p2 - t.p0);
    const double across = dot(normal, direction);
    if (!(across > 0)) return;
    // Beyond what was found.
    const double ahead = dot(normal, t.p0 - origin);
    if (!(ahead > after * across && ahead < exit.t * across)) return;
    if (!is_outward_through(origin, direction, t)) return;
    const double at = ahead / across;
    if (at > after && at < exit.t) exit = {at, t.region, normal};
  });
  if (exit.region == kNone) return {INFINITY, kNone, {}};
  exit.normal = normalize(exit.normal);
  return exit;
}

bool SolidSurface::is_entered(Vec3d origin, Vec3d direction, double after, double before) const {
  return tree_.any_along(origin, direction, after, before, [&](std::uint32_t i) {
    const SurfaceTriangle& t = triangles_[i];
    const Vec3d normal = cross(t.p1 - t.p0, t.p2 - t.p0);
    const double across = dot(normal, direction);
    const double ahead = dot(normal, t.p0 - origin);
    const bool is_within = across < 0 && ahead < after * across && ahead > before * across;
    return is_within && is_outward_through(origin, -direction, t);
  });
}

std::size_t SolidSurface::bytes() const {
  return triangles_.size() * sizeof(SurfaceTriangle) +
         (joined_.size() + blades_.size() + needles_.size()) * sizeof(FacePair) +
         wall_tree_.bytes() + rod_tree_.bytes() + firm_.size() * sizeof(std::uint32_t) +
         tree_.bytes();
}

}  // namespace arris
