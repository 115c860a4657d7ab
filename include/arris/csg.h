// csg.h — solids made of simpler ones by union, intersection and difference
// What       a tree as a reader describes it: leaves are closed solids with a material, placed by an affine map; inner
//            nodes are set operations on any number of children. The surfaces are exact: nothing is cut into triangles.
// Units      the object's own; angles in radians
// Source     operations and intervals: Roth, "Ray Casting for Modeling Solids" (1982)
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "arris/ids.h"
#include "arris/math.h"

namespace arris {

// Closed outlines in the plane, without their first point repeated. A point is inside if the outlines wind
// round it a number of times that isn't 0.
struct CsgRegion {
  std::vector<std::vector<Vec2d>> outlines;
};

struct CsgSphere {
  double radius = 1;  // about the origin
};
struct CsgBox {
  Vec3d low, high;
};
// About the z axis from z_low to z_high. Equal radii: a cylinder; one of them 0: a cone.
struct CsgCone {
  double z_low = 0, z_high = 1;
  double radius_low = 1, radius_high = 1;
};
// About the z axis; the tube may be wider than the ring (a spindle, without the hollow inside).
struct CsgTorus {
  double ring_radius = 1, tube_radius = 0.25;
};
// normal·x ≤ d; normal unit
struct CsgHalfSpace {
  Vec3d normal{0, 0, 1};
  double d = 0;
};
// The points inside all planes; bounded. Given by the hull of its vertices, which readers make (qhull).
struct CsgPolyhedron {
  std::vector<CsgHalfSpace> faces;
  std::vector<Vec3d> vertices;
};
// A closed mesh, any shape; triangles counter-clockwise seen from outside. Inside: winding number not 0.
struct CsgMesh {
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;
};
// A region of the xy plane swept from z_low to z_high while its coordinates are scaled from 1 to scale_high.
struct CsgPrism {
  CsgRegion region;
  double z_low = 0, z_high = 1;
  Vec2d scale_high{1, 1};
};
// A region of the half plane x ≥ 0 turned about its y axis, which becomes z: its edges sweep cones and flat rings.
struct CsgRevolution {
  CsgRegion region;
};
// All points within `radius` of a convex polyhedron: minkowski(){ hull; sphere } of OpenSCAD.
struct CsgRounded {
  CsgPolyhedron core;
  double radius = 0;
};

using CsgPrimitive = std::variant<CsgSphere, CsgBox, CsgCone, CsgTorus, CsgHalfSpace, CsgPolyhedron,
                                  CsgMesh, CsgPrism, CsgRevolution, CsgRounded>;

enum class CsgOperation : std::uint8_t {
  unite,
  intersect,
  subtract,  // the first child without the others
};

struct CsgNode {
  // The leaf's primitive, an index of CsgTree::leaves; kInner: an operation on the children.
  static constexpr std::uint32_t kInner = ~std::uint32_t{0};
  std::uint32_t leaf = kInner;
  CsgOperation operation = CsgOperation::unite;
  std::vector<std::uint32_t> children;  // each below its parent: a greater index
};

struct CsgLeaf {
  CsgPrimitive primitive;
  Affine3d object_from_primitive;
  MaterialId material;
};

// nodes[0] is the root. No children: the empty set, which is also what subtract and intersect make of one as
// their first or any child.
struct CsgTree {
  std::string name;
  std::vector<CsgNode> nodes;
  std::vector<CsgLeaf> leaves;
};

}  // namespace arris
