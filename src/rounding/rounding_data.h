// rounding_data.h — what a Rounding keeps: bands, arcs and nodes
// What       The rounded surface beside the flat faces consists of cylinders around arcs (edges of the eroded
//            solid E) and spheres around nodes (its vertices); arcs and nodes link to each other (paper §3.1,
//            the adjacency graph). A band says where on a triangle one arc's rounding takes the face away.
// Units      positions are floats relative to the solid's centre, so that rounding errors scale with the solid
// Legend     r radius, n outward face normal, E = {x : n·x ≤ d − r for all faces}
// Source     Courtin et al. §3.1, Fig. 6 (detection cylinders); bands are their trace on a face: see bands.h
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "rounding/creased_solid.h"
#include "rounding/detection_tree.h"
#include "rounding/fillets.h"
#include "rounding/plain_crease.h"

namespace arris {

// On the triangle, at barycentric (u, v): depth = c0 + cu·u + cv·v > 0 where the arc's rounding has taken the
// face away. 16 bytes, so that the four bands of a box's triangle fit a cache line.
struct Band {
  float c0, cu, cv;
  std::uint32_t arc;  // kNone: of a creased or filled solid

  [[nodiscard]] float depth(float u, float v) const { return c0 + cu * u + cv * v; }
};

// The axis of a rounding cylinder.
struct ArcLine {
  Vec3f p0;
  Vec3f axis;  // unit, along n_a × n_b
  float length = 0;

  [[nodiscard]] Vec3d p1() const { return Vec3d(p0) + Vec3d(axis) * double(length); }
};

// An edge of E between two faces. A stub (node1 == kNone) only marks the direction in which an edge that stays
// sharp leaves node0.
struct Arc {
  ArcLine line;
  std::uint32_t face_a, face_b;
  std::uint32_t node0, node1;
  // Triangles of the two faces at the mesh edge, whose vertex normals shade the cylinder; kNone for arcs between
  // faces that are not neighbours in the mesh.
  std::uint32_t triangle_a = kNone, triangle_b = kNone;

  [[nodiscard]] bool is_stub() const { return node1 == kNone; }
};

// Where arcs end.
struct Node {
  enum class Kind : std::uint32_t {
    sphere,  // a corner: centre of a rounding sphere
    mitre,   // two cylinders meet in a plane: a chain of rounded edges bends at smooth edges
    cap,     // the rounding ends at a plane: its edge runs into a concave corner or fades out
  };
  Vec3f position;
  std::uint32_t first_link = 0;
  std::uint32_t link_count : 30 = 0;
  Kind kind : 2 = Kind::sphere;
};

struct Face {
  Vec3f normal;  // unit
  std::uint32_t solid;
  double d;  // of normal·x, relative to the solid's centre
};

struct Solid {
  Vec3d center;
  double size = 0;
  double radius = 0;  // of its arcs; of a creased solid's edges the largest
  std::uint32_t first_arc = 0, arc_count = 0;
  std::uint32_t first_node = 0, node_count = 0;
  std::uint32_t first_face = 0, face_count = 0;
  bool closed = false, convex = false;
  bool all_rounded = false;  // no edge between faces is left sharp or smooth
  bool turned = false;       // the mesh's own winding points inward
  bool exact = false;    // closed, convex, every edge rounded: the surface is that of opening(P)
  bool rewired = false;  // E lost features of P: the arc nearest to a point must be searched for
  std::uint32_t creased = kNone;  // index: rounded exactly though it isn't convex
  std::uint32_t filled = kNone;   // index: its concave edges have fillets
  bool hollow = false;            // part of the creased solid of the shell around it
};

// A solid's fillets, from the space outside it.
struct FilledSolid {
  CreasedSolid outside;
  Fillets fillets;

  FilledSolid(CreasedSolid made, std::span<const PlainCrease> plain)
      : outside(std::move(made)), fillets(outside, plain) {}
  FilledSolid(const FilledSolid&) = delete;
  FilledSolid& operator=(const FilledSolid&) = delete;
};

struct Rounding::Data {
  double radius = 0;
  std::vector<std::uint32_t> band_begin;  // per triangle, and one more
  std::vector<Band> bands;
  std::vector<std::uint32_t> face;  // per triangle; kNone if degenerate
  std::vector<Face> faces;
  std::vector<Arc> arcs;
  std::vector<Node> nodes;
  std::vector<std::uint32_t>
      links;  // arcs at each node; a cap's last link is its wall face or kNone
  std::vector<Solid> solids;
  std::unique_ptr<const DetectionTree> tree;  // with Detection::kd_tree
  std::vector<std::unique_ptr<const CreasedSolid>> creased;
  std::vector<std::unique_ptr<const FilledSolid>> filled;
  // Of creased and filled solids; plain_on: those of each triangle, from plain_begin on, which is empty without.
  std::vector<PlainCrease> plain;
  std::vector<std::uint32_t> plain_begin, plain_on;
  // Parts of all fillets, and whose they are.
  struct FilletPart {
    std::uint32_t solid, part;
  };
  std::vector<Rounding::FilletBox> fillet_boxes;
  std::vector<FilletPart> fillet_parts;
  RoundingReport report;
};

// Those whose void reaches into a triangle.
inline std::span<const std::uint32_t> plain_creases_on(const Rounding::Data& data,
                                                       std::uint32_t triangle) {
  if (data.plain_begin.empty()) return {};
  const std::uint32_t first = data.plain_begin[triangle];
  return std::span(data.plain_on).subspan(first, data.plain_begin[triangle + 1] - first);
}

// The test that every hit on a rounded mesh takes. Not kept by it means: resolve() decides.
inline bool is_kept_by_bands(const std::uint32_t* band_begin, const Band* bands,
                             std::uint32_t triangle, float u, float v) {
  const Band* const last = bands + band_begin[triangle + 1];
  for (const Band* b = bands + band_begin[triangle]; b != last; ++b) {
    if (b->depth(u, v) > 0) return false;
  }
  return true;
}

// Whether x, relative to its centre, lies in a convex solid with all its faces.
inline bool is_in_solid(const Rounding::Data& data, const Solid& solid, Vec3d x) {
  const Face* const last = data.faces.data() + solid.first_face + solid.face_count;
  for (const Face* f = data.faces.data() + solid.first_face; f != last; ++f) {
    if (dot(Vec3d(f->normal), x) > f->d) return false;
  }
  return true;
}

// Between faces of the given normals. The direction is theirs: that of p1 − p0 is noise where they are near.
inline ArcLine make_arc_line(Vec3d p0, Vec3d p1, Vec3d normal_a, Vec3d normal_b) {
  const Vec3d axis = normalize(cross(normal_a, normal_b));
  return {Vec3f(p0), Vec3f(axis), float(dot(p1 - p0, axis))};
}

}  // namespace arris
