// polygon.h — polygons to triangles
// What       cuts ears off a polygon in the plane of its vector area; convex ones become a fan
// In / Out   corner positions in order; n - 2 triangles of corner numbers, of the same orientation
// Guarantee  every corner is used, so that neighbours that share an edge stay closed; a simple planar
//            polygon, convex or concave, is covered exactly (tests/geometry/polygon_test.cpp)
// Limits     a polygon that crosses itself, or folds over in its plane, gets some cover of all its
//            corners. A collinear corner makes a flat triangle only if the whole polygon is flat.
// Cost       linear if convex; else corners times concave corners as a rule. The sum over all polygons of
//            one triangulator is bounded by kMaxPolygonWork corner tests, some seconds.
// Source     D. Eberly, "Triangulation by Ear Clipping" (2002), §2
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/math.h"

namespace arris {

inline constexpr std::uint64_t kMaxPolygonWork = 1'000'000'000;

class PolygonTriangulator {
 public:
  explicit PolygonTriangulator(std::uint64_t max_work = kMaxPolygonWork) : max_work_(max_work) {}

  // Empty if the work of all calls passes the limit. Valid until the next call.
  // Precondition: at least 3 corners.
  std::span<const Triangle> triangulate(std::span<const Vec3f> corners);

 private:
  // How an ear must look; what is left without one is cut by the next rule.
  enum class Rule { proper, flat, any };

  void project(std::span<const Vec3f> corners);
  void link(std::size_t count);
  [[nodiscard]] bool is_convex() const;
  [[nodiscard]] double doubled_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  [[nodiscard]] double least_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  bool is_ear(std::uint32_t corner, Rule rule);
  bool clip_ears();

  std::vector<Vec2d> points_;  // projected so that the polygon turns counter-clockwise
  std::vector<std::uint32_t> previous_, next_;
  std::vector<std::uint32_t> reflex_;  // corners that could lie in an ear
  std::vector<std::uint8_t> clipped_;
  std::vector<Triangle> triangles_;
  std::uint64_t max_work_;
  std::uint64_t work_ = 0;
};

}  // namespace arris
