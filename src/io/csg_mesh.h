// csg_mesh.h — closed meshes of .csg files: swept outlines, polyhedra as they are written
// Guarantee  every edge is walked as often in one direction as in the other; no triangle has two equal corners
//            (tests/io/csg_reader_test.cpp)
// Errors     sweep_mesh(): ScadUnsupported for outlines without a triangulation
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "io/csg_shape.h"

namespace arris {

// Takes a point of an outline to its place on one section.
using MeshRing = std::function<Vec3d(Vec2d)>;
enum class RingEnds { closed_by_faces, joined };

// Sections that follow each other to the side from which the outlines run counter-clockwise. Quads are cut along their
// shorter diagonal.
CsgMesh sweep_mesh(const CsgRegion& region, const std::vector<MeshRing>& rings, RingEnds ends);

// A solid of any triangles that close it: points at one place become one, triangles are turned around where
// neighbours disagree. A polyhedron where it is convex. Else what is wrong with it.
struct ClosedSolid {
  CsgPrimitive primitive;
  bool turned = false;  // some triangles were
};
std::variant<ClosedSolid, std::string> close_solid(const std::vector<Vec3d>& points,
                                                   const std::vector<Triangle>& triangles);

}  // namespace arris
