// edge_mesh.h — what the edge finder needs of one mesh: its edges, and which of them a viewpoint sees as outline
// What       make_edge_mesh() lists each edge of a WeldedMesh once, with the faces on its two sides. is_silhouette()
//            and is_drawn() are the predicates: trees and brute force decide by them alone.
// In / Out   object coordinates; triangles outward, in the order of the WeldedMesh. Viewpoints are homogeneous: w = 1
//            at `xyz`, w = 0 at infinity in the direction `xyz` (where a directional light shines from). Whether a
//            face faces a viewpoint is invariant under affine maps, mirroring ones too: transform the viewpoint.
// Guarantee  each face faces a viewpoint or does not, whichever edge asks: around every vertex without open edges
//            the number of silhouettes is even, so outlines close (tests/edgepoint/edge_mesh_test.cpp). A viewpoint
//            in a face's plane sees its back.
// Limits     a triangle of no area, or thinner than float tells, is no face: its two short edges lie between the
//            faces beyond, its longest edge is left out. Half-edges without a twin count as open, non-manifold ones
//            as well. Edges between coplanar faces are silhouettes only by rounding, for viewpoints in that plane:
//            there they lie on the outline anyway.
// Cost       linear; const afterwards
// Source     Bala, Walter, Greenberg, "Combining Edges and Points for Interactive High-Quality Rendering", 2003,
//            sections 6.1 (equation 1, with one vertex for each face, as there) and 6.2
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "edges/welded_mesh.h"

namespace arris {

struct HomogeneousPoint {
  Vec3d xyz;
  double w = 1;  // >= 0
};

// Points with w = 0 are directions.
HomogeneousPoint transform(const Affine3d& m, const HomogeneousPoint& p);

struct MeshEdge {
  std::uint32_t v0 = 0, v1 = 0;                // as face0 runs along it
  std::uint32_t face0 = kNone, face1 = kNone;  // face1: kNone if open
};

struct EdgeMesh {
  static constexpr std::uint8_t kSharp = 1;  // drawn wherever one of its faces faces the viewpoint
  static constexpr std::uint8_t kConcave =
      2;  // the solid fills more than half of the space around it

  std::vector<Vec3f> vertices;
  std::vector<Triangle> triangles;
  std::vector<MeshEdge> edges;
  std::vector<std::uint8_t> flags;  // per edge
  // Edges around vertex v: edges_around[first_around[v]] up to first_around[v + 1].
  std::vector<std::uint32_t> first_around, edges_around;
  Vec3d bounds_min, bounds_max;
  bool closed = true;  // no open edges

  [[nodiscard]] bool is_open(std::uint32_t edge) const { return edges[edge].face1 == kNone; }
  [[nodiscard]] bool is_sharp(std::uint32_t edge) const { return (flags[edge] & kSharp) != 0; }
  // Seen as outline only from within the solid: the viewpoint is behind one of its two faces. Only decided where
  // it is beyond doubt; flat edges are not concave.
  [[nodiscard]] bool is_concave(std::uint32_t edge) const { return (flags[edge] & kConcave) != 0; }
  [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return std::span(edges_around)
        .subspan(first_around[vertex], first_around[vertex + 1] - first_around[vertex]);
  }
};

struct EdgeMeshOptions {
  double min_sharp_angle =
      radians(85);  // between the normals of the two faces; the paper's cut-off
  // Of a half-edge and its twin: whether to draw the edge always, as where materials differ or a texture has a seam.
  std::function<bool(std::uint32_t half_edge, std::uint32_t twin)> is_marked;
};

EdgeMesh make_edge_mesh(const WeldedMesh& mesh, const EdgeMeshOptions& options = {});

// Outward, of twice the triangle's area as length.
Vec3d face_normal(const EdgeMesh& mesh, std::uint32_t face);
bool is_front(const EdgeMesh& mesh, std::uint32_t face, const HomogeneousPoint& viewpoint);
// One of the edge's faces faces the viewpoint and the other does not (equation 1), or the edge is open.
bool is_silhouette(const EdgeMesh& mesh, std::uint32_t edge, const HomogeneousPoint& viewpoint);
// Silhouettes, and sharp edges that are not wholly turned away.
bool is_drawn(const EdgeMesh& mesh, std::uint32_t edge, const HomogeneousPoint& viewpoint);
// May be a silhouette from some point of the convex hull of the viewpoints: its faces do not both face all
// of them, nor both face none.
bool may_be_silhouette(const EdgeMesh& mesh, std::uint32_t edge,
                       std::span<const HomogeneousPoint> viewpoints);

}  // namespace arris
