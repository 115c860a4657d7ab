// shapes.h — meshes of simple solids
// What       one function per shape, centred at the origin, axes along +Z
// Guarantee  closed (the plane aside), triangles counter-clockwise seen from outside
//            (tests/geometry/shapes_test.cpp: each edge has two triangles, the volume is positive
//            and right). Vertices are shared, except where a curved side meets a flat cap.
// Limits     preconditions: lengths > 0 and finite, counts within the constants below
// Cost       linear in the triangles
#pragma once

#include "arris/scene.h"

namespace arris {

inline constexpr int kMaxShapeSegments = 512;
inline constexpr int kMaxIcosphereSubdivisions = 6;

Mesh make_box_mesh(Vec3d size);
// A square of two triangles facing +Z; not closed.
Mesh make_plane_mesh(Vec2d size);
// Latitudes and longitudes: `segments` around (3 or more), half as many from pole to pole. Smooth.
Mesh make_sphere_mesh(double radius, int segments);
// An icosahedron whose triangles are divided into 4 again and again. Flat.
Mesh make_icosphere_mesh(double radius, int subdivisions);

struct ConeShape {
  double bottom_radius = 1, top_radius = 0;  // one may be 0
  double height = 1;
  int segments = 64;
};
// A cylinder, if both radii are equal. The side is smooth, the caps flat.
Mesh make_cone_mesh(const ConeShape& shape);
// The same with flat sides: prisms and pyramids.
Mesh make_prism_mesh(const ConeShape& shape);

// Radius: of the corners.
Mesh make_tetrahedron_mesh(double radius);
Mesh make_octahedron_mesh(double radius);
Mesh make_dodecahedron_mesh(double radius);
Mesh make_icosahedron_mesh(double radius);

}  // namespace arris
