// solid_surface.h — one solid's triangles in a tree: what lies near a point, and where a ray leaves
// In / Out   coordinates relative to the solid's centre
// Cost       building n log n; a search visits the triangles near alone
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arris/math.h"
#include "rounding/box_tree.h"

namespace arris {

struct SurfaceTriangle {
  Vec3d p0, p1, p2;         // counter-clockwise from outside
  std::uint32_t region;     // flat region of the mesh
  std::uint32_t index = 0;  // of the mesh
};

inline Vec3d normal_of(const SurfaceTriangle& t) {
  return normalize(cross(t.p1 - t.p0, t.p2 - t.p0));
}
// C. Ericson, "Real-Time Collision Detection" (2005), §5.1.5.
inline Vec3d nearest_on_triangle(Vec3d x, const SurfaceTriangle& t) {
  const Vec3d ab = t.p1 - t.p0, ac = t.p2 - t.p0, ax = x - t.p0;
  const double d1 = dot(ab, ax), d2 = dot(ac, ax);
  if (d1 <= 0 && d2 <= 0) return t.p0;
  const Vec3d bx = x - t.p1;
  const double d3 = dot(ab, bx), d4 = dot(ac, bx);
  if (d3 >= 0 && d4 <= d3) return t.p1;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.p0 + ab * (d1 / (d1 - d3));
  const Vec3d cx = x - t.p2;
  const double d5 = dot(ab, cx), d6 = dot(ac, cx);
  if (d6 >= 0 && d5 <= d6) return t.p2;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.p0 + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return t.p1 + (t.p2 - t.p1) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const double sum = va + vb + vc;
  return t.p0 + ab * (vb / sum) + ac * (vc / sum);
}

// Whether its box reaches into another one.
inline bool reaches_into(const SurfaceTriangle& t, Vec3d low, Vec3d high) {
  const Vec3d t_low = min(t.p0, min(t.p1, t.p2)), t_high = max(t.p0, max(t.p1, t.p2));
  for (int axis = 0; axis < 3; ++axis) {
    if (t_low[axis] > high[axis] || t_high[axis] < low[axis]) return false;
  }
  return true;
}
// Whether the triangle's plane is farther away.
inline bool is_plainly_beyond(Vec3d x, const SurfaceTriangle& t, double distance) {
  constexpr double kSurely = 1 + 1e-9;  // whatever rounding does
  const Vec3d normal = cross(t.p1 - t.p0, t.p2 - t.p0);
  const double above = dot(normal, x - t.p0);
  return above * above > distance * distance * length_squared(normal) * kSurely;
}
// Whether it is seen at once that a triangle, of the given normal, is `reach` or more from another one.
bool is_beyond_reach(const std::array<Vec3d, 3>& corners, Vec3d normal, const SurfaceTriangle& t,
                     double reach);
// Whether a triangle may be nearer than r to the centres of balls that touch one; these are its corners, moved inwards
// along its normal.
bool may_be_cut(const std::array<Vec3d, 3>& centers, Vec3d normal, const SurfaceTriangle& t,
                double radius);

using FacePair = std::pair<std::uint32_t, std::uint32_t>;  // regions

// Of sorted pairs, those whose first is the face.
inline std::span<const FacePair> pairs_of(std::span<const FacePair> sorted, std::uint32_t face) {
  return {std::ranges::lower_bound(sorted, face, {}, &FacePair::first),
          std::ranges::upper_bound(sorted, face, {}, &FacePair::first)};
}

// What has less than two radii of material between its sides.
struct ThinWalls {
  std::vector<std::uint32_t> sides, rods;  // triangles, by their place in the surface; sorted
  // Faces that meet in an edge as sharp as that, or whose surfaces do: balls may roll out of there. Each pair in both
  // orders; sorted.
  std::vector<FacePair> blades;
  // Of corners as sharp as that, all of whose faces are sides: these, and a number for each corner; sorted.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> needles;
};

class SolidSurface {
 public:
  // In any order, triangles() has another. reach: how far searches look about.
  SolidSurface(const std::vector<SurfaceTriangle>& triangles, double reach);

  // joined: see smooth_reach.h
  void set_joined(std::vector<FacePair> joined) { joined_ = std::move(joined); }
  void set_walls(ThinWalls walls);
  [[nodiscard]] bool has_walls() const { return !wall_tree_.is_empty() || !rod_tree_.is_empty(); }
  // firm: regions that stay whatever balls do; sorted.
  void set_firm(std::vector<std::uint32_t> firm) { firm_ = std::move(firm); }
  // Whether what touches a face may cut into another one.
  [[nodiscard]] bool is_joined(std::uint32_t face, std::uint32_t other) const {
    return !joined_.empty() && std::ranges::binary_search(joined_, FacePair(face, other));
  }
  [[nodiscard]] bool is_curved() const { return !joined_.empty(); }
  [[nodiscard]] bool is_blade(std::uint32_t face, std::uint32_t other) const {
    return std::ranges::binary_search(blades_, FacePair(face, other));
  }
  // Whether the faces meet in one corner as sharp as a blade.
  [[nodiscard]] bool is_needle(std::span<const std::uint32_t> faces) const;
  [[nodiscard]] bool is_firm(std::uint32_t region) const {
    return std::ranges::binary_search(firm_, region);
  }
  [[nodiscard]] bool has_firm() const { return !firm_.empty(); }

  // Whether a triangle of another region, one that isn't joined to it, is nearer to x than `distance`; where it borders
  // on one that is joined, that is the nearer.
  [[nodiscard]] bool is_near(Vec3d x, double distance, std::uint32_t but_region) const;
  // The same of these alone, by their place in triangles(); none is of that region.
  [[nodiscard]] bool is_one_near(std::span<const std::uint32_t> triangles, Vec3d x, double distance,
                                 std::uint32_t but_region) const;
  // The nearest place of the surface within a distance.
  struct NearestPlace {
    const SurfaceTriangle* triangle;
    Vec3d place;
    double distance;
  };
  [[nodiscard]] std::optional<NearestPlace> nearest(Vec3d x, double within) const;
  // Whether a firm triangle reaches into a box.
  [[nodiscard]] bool has_firm_near(Vec3d low, Vec3d high) const {
    return has_firm() && tree_.any_near(low, high, [&](std::uint32_t i) {
      return is_firm(triangles_[i].region);
    });
  }

  // The t > after at which the ray first leaves through a triangle, with its region and unit normal; infinity if it
  // doesn't before `before`. A ray through an edge meets both triangles.
  struct Exit {
    double t;
    std::uint32_t region;
    Vec3d normal;
  };
  [[nodiscard]] Exit first_exit(Vec3d origin, Vec3d direction, double after,
                                double before = INFINITY) const;
  // Whether a ray enters through a triangle within ]after, before[.
  [[nodiscard]] bool is_entered(Vec3d origin, Vec3d direction, double after, double before) const;

  // Visits every triangle whose box reaches into this one, and some beside it; some more than once.
  template <class Visit>
  void for_each_near(Vec3d low, Vec3d high, Visit&& visit) const {
    tree_.for_each_near(low, high, [&](std::uint32_t i) { visit(triangles_[i]); });
  }
  // The same for the sides of thin walls alone, and for those of rods.
  template <class Visit>
  void for_each_wall_near(Vec3d low, Vec3d high, Visit&& visit) const {
    wall_tree_.for_each_near(low, high, [&](std::uint32_t i) { visit(triangles_[i]); });
  }
  template <class Visit>
  void for_each_rod_near(Vec3d low, Vec3d high, Visit&& visit) const {
    rod_tree_.for_each_near(low, high, [&](std::uint32_t i) { visit(triangles_[i]); });
  }
  // Visits those of other regions, if they are asked for, into which a ball may cut that touches a triangle, of the
  // given normal; some more than once.
  template <class IsAsked, class Visit>
  void for_each_cut(std::uint32_t triangle, Vec3d normal, double radius, IsAsked&& is_asked,
                    Visit&& visit) const;
  [[nodiscard]] const std::vector<SurfaceTriangle>& triangles() const { return triangles_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  // Whether a place of a triangle that is nearer to x than `distance` cuts into what touches a face.
  [[nodiscard]] bool reaches_near(const SurfaceTriangle& t, Vec3d x, double distance,
                                  std::uint32_t face) const;
  // Whether a place is on a face that is joined to another one.
  [[nodiscard]] bool is_on_joined(Vec3d x, double tolerance, std::uint32_t face) const;

  std::vector<SurfaceTriangle> triangles_;
  std::vector<FacePair> joined_, blades_, needles_;  // sorted
  std::vector<std::uint32_t> firm_;
  BoxTree tree_, wall_tree_{{}}, rod_tree_{{}};
  double reach_;
};

template <class IsAsked, class Visit>
void SolidSurface::for_each_cut(std::uint32_t triangle, Vec3d normal, double radius,
                                IsAsked&& is_asked, Visit&& visit) const {
  const SurfaceTriangle& own = triangles_[triangle];
  const Vec3d down = normal * radius, reach(radius);
  const std::array<Vec3d, 3> centers{own.p0 - down, own.p1 - down, own.p2 - down};
  const Vec3d low = min(centers[0], min(centers[1], centers[2])) - reach;
  const Vec3d high = max(centers[0], max(centers[1], centers[2])) + reach;
  for_each_near(low, high, [&](const SurfaceTriangle& t) {
    if (t.region == own.region || !is_asked(t.region)) return;
    if (may_be_cut(centers, normal, t, radius)) visit(t);
  });
}

}  // namespace arris
