// convex_pieces.h — the small solids of which the benchmark scenes are made
// Out        meshes in scene units, counter-clockwise from outside, faces cut in fans
#pragma once

#include <cstdint>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"

namespace arris::bench {

// Faces are loops of vertices, counter-clockwise from outside.
struct Piece {
  std::vector<Vec3d> vertices;
  std::vector<std::vector<std::uint32_t>> faces;
};

Piece make_box(Vec3d low, Vec3d high);
Piece make_tetrahedron(
    double half_edge);  // corners at alternate corners of a cube of this half edge
Piece make_dodecahedron(double circumradius);

enum class Bottom { closed, open };
// A regular prism along z; its first corner is on the x axis.
Piece make_prism(int sides, double radius, double low, double high, Bottom bottom = Bottom::closed);

double lowest_z(const Piece& piece, const Affine3d& placed);

// Adds the piece to a mesh.
void append(Mesh& mesh, const Piece& piece, const Affine3d& placed);

}  // namespace arris::bench
