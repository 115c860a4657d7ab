// bevel_mesh.h — rounded edges as triangles: what the exact rounding is compared with
// What       the mesh that a modeller's bevel makes: faces inset, each edge a strip of N quads across, each corner a
//            spherical patch of N² triangles. Built from the same network of arcs and nodes as the exact rounding,
//            so both mean the same surface.
// In / Out   subdivisions N ≥ 1: N = 1 is a chamfer. Normals are those of the rounded surface at the vertices;
//            faces are flat, or keep the source's normals if it has any. Materials and uv of a bevel are those of
//            the nearer of its faces; uv between a face's corners are interpolated linearly.
// Guarantee  of a closed solid the result is closed (two triangles at every edge, equal positions bit for bit) and
//            faces outward; a closed convex solid's vertices lie on the rounded surface, so that its volume tends to
//            the exact rounded one from below as N grows (tests/rounding/bevel_mesh_test.cpp)
// Limits     concave edges stay sharp. Where a rounding ends at an edge that stays sharp there is a flat wall. A
//            shell whose bevel would fold over, whose radius has eaten features while some edges stay sharp, or whose
//            rounded faces have several materials keeps its triangles: counted in `kept_solids`, said in `notes`.
// Cost       linear in the triangles made, beside what make_rounding() takes
// Source     the comparison of Courtin et al., Table 1 and Fig. 10
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arris/rounding.h"
#include "arris/scene.h"

namespace arris {

struct BevelMesh {
  Mesh mesh;
  std::uint64_t bevelled_solids = 0, kept_solids = 0;
  std::uint64_t rounded_edges = 0, rounded_corners = 0;
  std::vector<RoundingNote> notes;
};

// Errors as make_rounding(). Precondition: subdivisions ≥ 1.
BevelMesh make_bevel_mesh(const Mesh& mesh, const RoundingOptions& options, int subdivisions,
                          const std::string& name = "");

}  // namespace arris
