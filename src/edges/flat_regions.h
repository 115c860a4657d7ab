// flat_regions.h — coplanar triangles as faces, and what kind of edge lies between them
// What       groups the triangles of each shell into flat regions (the faces of the polyhedron) with their
//            planes, and classes the edges between regions
// In / Out   planes are outward, in coordinates relative to the shell's centre: normal·(x − center) = d
// Cost       linear, but for sorting the triangles by how well they define a plane
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/inspect.h"
#include "edges/welded_mesh.h"

namespace arris {

struct Plane {
  Vec3d normal;  // unit, outward
  double d = 0;  // normal·x = d on the plane
};

struct FlatRegions {
  std::vector<std::uint32_t> region;  // per triangle; kNone for degenerate triangles
  std::vector<Plane> planes;          // per region
  std::vector<std::uint32_t> shell;   // per region
};

// Two planes nearer than this, relative to the shell's size, are one: about sixteen times the rounding error
// of a float coordinate.
inline constexpr double kPlaneTolerance = 1e-6;

FlatRegions make_flat_regions(const WeldedMesh& mesh);

enum class EdgeKind : std::uint8_t { flat, smooth, convex, concave, boundary, nonmanifold };

// Turn between the two planes at half-edge h: 0 for flat, positive where the edge is convex, negative where
// it is concave. Precondition: the half-edge has a twin.
double turn_at(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t h);
// Sharp is what turns by min_angle or more or, if the mesh knows its sharp edges, these.
EdgeKind classify_edge(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t h,
                       double min_angle);

// Turns shells that are inside out so that their normals point outwards: closed ones by their volume
// (but for cavities: within another shell of the mesh), open ones if no edge is convex and some are concave
// (a room seen from inside). Regions must be made again for what it returns as turned.
std::vector<std::uint32_t> turn_inverted_shells(WeldedMesh& mesh, const FlatRegions& regions,
                                                double min_angle);
// A closed shell of negative volume that turn_inverted_shells() left: a hollow in another solid.
bool is_cavity(const Shell& shell);
// Whether a shell's bounds have the inner one's within: it may be a hollow of this solid.
bool can_hold(const Shell& outer, const Shell& inner);
// The smallest that can hold a hollow; kNone if there is none, or it is no hollow.
std::uint32_t shell_around(std::span<const Shell> shells, std::uint32_t hollow);

}  // namespace arris
