// eroded_polyhedron.h — the erosion of a convex solid by half-space intersection
// What       vertices and edges of E = {x : n_k·x ≤ d_k − r}, whatever r has eaten of P. As convex hull of the dual
//            points n_k / (d_k − r − n_k·c) about an interior point c (qhull).
// In / Out   planes in the shell's coordinates; faces of the arcs are first_face + index of the plane
// Limits     r must be below the inradius by more than 1e-9 of the size
#pragma once

#include <span>

#include "rounding/crease_network.h"

namespace arris {

// smooth_group: per plane, the surface it belongs to: edges within one group stay sharp.
ShellNetwork make_eroded_polyhedron(std::span<const Plane> planes,
                                    std::span<const std::uint32_t> smooth_group,
                                    std::uint32_t first_face, double radius, Vec3d interior,
                                    double size);

}  // namespace arris
