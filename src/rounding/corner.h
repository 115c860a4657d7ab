// corner.h — what becomes of one corner when its planes move in
// What       erode_corner(): the polyhedral cone of a convex vertex, each plane moved in, has in general m−2
//            vertices joined by m−3 short edges (m faces). make_mitre_plane(): where two cylinders of one radius
//            meet in a plane.
// Source     Courtin et al. §3, Fig. 4 and 5, put one sphere where all axes of a corner cross. With more than three
//            faces they cross in one point only if all planes touch a common ball; else there are several spheres
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edges/flat_regions.h"

namespace arris {

struct CornerErosion {
  struct ShortArc {
    std::uint32_t node0, node1;    // from node0 to node1 along n_a × n_b
    std::uint32_t face_a, face_b;  // indices into the ring of planes
  };
  std::vector<Vec3d> nodes;
  std::vector<std::uint32_t> node_of_edge;  // edge i lies between planes i−1 and i
  std::vector<ShortArc> short_arcs;
};

// planes: already moved in, in counter-clockwise order around the vertex, seen from outside; at least three.
// Nodes nearer than 1e-7 of `size` become one. Nothing if the planes don't form a convex cone.
std::optional<CornerErosion> erode_corner(std::span<const Plane> planes, double size);

struct AxisLine {
  Vec3d point;
  Vec3d direction;  // unit, away from the corner
};

struct Mitre {
  Vec3d center;        // on the plane; its normal is along direction_a − direction_b
  Vec3d end_a, end_b;  // where the axes meet the plane
};

// Nothing if the axes leave the corner in (nearly) the same direction.
std::optional<Mitre> make_mitre_plane(const AxisLine& a, const AxisLine& b);

// The point nearest to `near` on the line where both planes, moved in by `radius`, meet.
Vec3d nearest_on_offset_line(const Plane& a, const Plane& b, double radius, Vec3d near);

}  // namespace arris
