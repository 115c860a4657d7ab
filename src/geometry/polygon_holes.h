// polygon_holes.h — polygons with holes to triangles
// What       joins each hole to the outline by a bridge, walked in both directions, and cuts ears off the result
//            (polygon.h)
// In / Out   loops of corner numbers into `points`: the outline counter-clockwise about `normal`, holes clockwise;
//            triangles of the same numbers, counter-clockwise
// Guarantee  every edge of every loop is walked once, so that neighbours stay closed; the triangles' areas add up
//            to the polygon's to within 1e-4 and none is turned over, else there is no result
//            (tests/geometry/polygon_holes_test.cpp)
// Limits     one outline at a time
// Cost       corners times holes for the bridges, besides the ears
// Source     D. Eberly, "Triangulation by Ear Clipping" (2002), §5
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/polygon.h"

namespace arris {

class HolePolygonTriangulator {
 public:
  // Valid until the next call. Nothing if the loops don't bound one polygon.
  std::optional<std::span<const Triangle>> triangulate(
      std::span<const Vec3f> points, std::span<const std::vector<std::uint32_t>> loops,
      Vec3d normal);

 private:
  struct Loop {
    std::uint32_t index;
    double area;       // signed
    double rightmost;  // x
  };

  void project(std::span<const Vec3f> points, std::span<const std::vector<std::uint32_t>> loops,
               Vec3d normal);
  bool join(const std::vector<std::uint32_t>& hole);
  [[nodiscard]] std::optional<std::size_t> visible_corner(Vec2d from) const;
  bool cover(std::span<const Vec3f> points, Vec3d normal, double area);

  PolygonTriangulator ears_;
  std::vector<Vec2d> flat_;             // per point used
  std::vector<std::uint32_t> outline_;  // grows by the holes
  std::vector<Loop> holes_;
  std::vector<Vec3f> corners_;
  std::vector<Triangle> triangles_;
  double area_ = 0;
  std::uint32_t outer_ = 0;
  std::uint32_t outlines_ = 0;
};

}  // namespace arris
