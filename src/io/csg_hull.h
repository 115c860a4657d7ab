// csg_hull.h — convex solids: hulls of points, of balls and of discs
// What       hull_of_points() a polyhedron; hull_of_balls() and hull_of_discs() exact round shapes, where they
//            can be put together from primitives: balls of one radius, two balls, any discs
// Guarantee  every point given lies in the hull to within 1e-12 of its size; faces that six-digit numbers bend by less
//            than 2e-6 of the size are one (tests/io/csg_hull_test.cpp)
// Limits     hulls without volume are nothing
// Source     Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls" (1996), as qhull
#pragma once

#include <optional>
#include <vector>

#include "io/csg_shape.h"

namespace arris {

struct Ball {
  Vec3d center;
  double radius = 0;
};
struct Disc2d {
  Vec2d center;
  double radius = 0;
  int facets = 0;
};

std::optional<CsgPolyhedron> hull_polyhedron(const std::vector<Vec3d>& points);
// A mesh beyond kMaxPolyhedronFaces faces.
std::optional<CsgPrimitive> hull_of_points(const std::vector<Vec3d>& points);
inline constexpr std::size_t kMaxPolyhedronFaces = 128;

// Counter-clockwise, without points on edges.
Outline hull_of_points(std::vector<Vec2d> points);

// Nothing if that takes more than the primitives.
std::optional<SolidShape> hull_of_balls(std::vector<Ball> balls, const LeafMaker& make_leaf);
// Nothing for too many discs.
std::optional<FlatShape> hull_of_discs(std::vector<Disc2d> discs);

}  // namespace arris
