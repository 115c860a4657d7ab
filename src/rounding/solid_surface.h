// solid_surface.h — one solid's triangles in a tree: what lies near a point, and where a ray leaves
// In / Out   coordinates relative to the solid's centre
// Cost       building n log n; a search visits the triangles near alone
#pragma once

#include <cstdint>
#include <vector>

#include "arris/math.h"
#include "rounding/box_tree.h"

namespace arris {

struct SurfaceTriangle {
  Vec3d p0, p1, p2;      // counter-clockwise from outside
  std::uint32_t region;  // flat region of the mesh
};

Vec3d nearest_on_triangle(Vec3d x, const SurfaceTriangle& t);

class SolidSurface {
 public:
  explicit SolidSurface(std::vector<SurfaceTriangle> triangles);

  // Whether a triangle of another region is nearer to x than `distance`.
  [[nodiscard]] bool is_near(Vec3d x, double distance, std::uint32_t but_region) const;

  // The t > after at which the ray first leaves through a triangle, and its region; infinity if it doesn't. A ray
  // through an edge meets both triangles.
  struct Exit {
    double t;
    std::uint32_t region;
  };
  [[nodiscard]] Exit first_exit(Vec3d origin, Vec3d direction, double after) const;

  // Visits every triangle whose box reaches into this one, and some beside it.
  template <class Visit>
  void for_each_near(Vec3d low, Vec3d high, Visit&& visit) const {
    tree_.for_each_near(low, high, [&](std::uint32_t i) { visit(triangles_[i]); });
  }
  [[nodiscard]] const std::vector<SurfaceTriangle>& triangles() const { return triangles_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<SurfaceTriangle> triangles_;
  BoxTree tree_;
};

}  // namespace arris
