// csg_region.h — closed outlines in the plane
// What       make_even_odd_region(): outlines that cross, touch or hold each other, as OpenSCAD takes them (a point is
//            inside if a ray from it crosses an odd number of edges), to outlines that wind once round the inside and
//            never round the outside, and don't cross
// Guarantee  both agree except within 1e-9 of the size of an edge (tests/io/csg_region_test.cpp)
// Cost       edges times their neighbours in strips; bounded by kMaxRegionWork
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arris/csg.h"

namespace arris {

inline constexpr std::uint64_t kMaxRegionWork = 100'000'000;

using Outline = std::vector<Vec2d>;

struct Bounds2d {
  Vec2d low{1e300, 1e300}, high{-1e300, -1e300};
  void add(Vec2d p);
  void add(const Bounds2d& b);
  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x); }
};

constexpr double cross(Vec2d a, Vec2d b) {
  return a.x * b.y - a.y * b.x;
}
constexpr Vec2d operator+(Vec2d a, Vec2d b) {
  return {a.x + b.x, a.y + b.y};
}
constexpr Vec2d operator-(Vec2d a, Vec2d b) {
  return {a.x - b.x, a.y - b.y};
}
constexpr Vec2d operator*(Vec2d a, double s) {
  return {a.x * s, a.y * s};
}

// Nothing if the work would pass the limit. Points are finite.
std::optional<CsgRegion> make_even_odd_region(const std::vector<Outline>& outlines);

double signed_area(const Outline& outline);
Bounds2d bounds_of(const CsgRegion& region);
bool is_inside(const CsgRegion& region, Vec2d p);
// One outline, counter-clockwise, that turns left only and once.
bool is_convex(const CsgRegion& region);
// What is at x ≥ 0.
CsgRegion clip_to_right(const CsgRegion& region);
// Numbers count the points of all outlines in order. Nothing if the outlines cross.
std::optional<std::vector<Triangle>> triangulate(const CsgRegion& region);

}  // namespace arris
