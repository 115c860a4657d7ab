// bevel_shell.h — the bevel of one shell: strips, corner patches, walls and inset faces
// What       Around each corner the arcs and nodes of the network say what takes the place of the mesh's vertex: a
//            *profile* of N+1 points across each rounded edge's end, and for each face there (a sector of the
//            corner) the path that its outline now takes. Strips join the two profiles of an arc; patches fill
//            what the profiles and paths of a corner leave open; faces are cut anew within their outlines.
// Limits     see bevel_mesh.h
// Legend     an *item* is an end of an arc, 2·arc + end, seen from its node: it leaves the node with face `after` on
//            its left and face `before` on its right (counter-clockwise order, seen from outside). A profile
//            runs from before to after. T: where the rounding touches a face; S: where a sharp edge now begins.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polygon_holes.h"
#include "rounding/rounding_parts.h"

namespace arris {

// Grows shell by shell. A vertex belongs to one face or one rounded part: where these meet at an angle there
// are two at the same position.
struct BevelSurface {
  std::vector<Vec3f> positions, normals;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face;  // per triangle: whose material and uv it takes
  std::vector<std::uint32_t> flat;  // per triangle: 1 on faces and walls, 0 on rounded parts
  std::vector<std::uint32_t> kept;  // triangles of the source that stay as they are
};

class ShellBevel {
 public:
  ShellBevel(const RoundingParts& parts, int subdivisions, BevelSurface& out);

  // False if the shell can't be bevelled: then its triangles are kept.
  bool append(std::uint32_t shell);
  void keep(std::uint32_t shell);

 private:
  using Item = std::uint32_t;
  struct Ring {
    std::uint32_t first = 0, count = 0;  // into ring_items_
  };
  struct RingEdge {
    std::uint32_t half_edge;  // outgoing
    Item item;                // kNone: stays sharp
    Vec3d direction;          // unit, away from the corner
  };
  struct Path {
    std::uint32_t first = 0, count = 0;  // into path_vertices_
  };

  // Network.
  [[nodiscard]] const NetworkArc& arc(Item item) const { return network_->arcs[item / 2]; }
  [[nodiscard]] std::uint32_t node_of(Item item) const;
  [[nodiscard]] std::uint32_t after(Item item) const;
  [[nodiscard]] std::uint32_t before(Item item) const;
  [[nodiscard]] Vec3d direction(Item item) const;
  [[nodiscard]] Vec3d axis_end(Item item) const;
  [[nodiscard]] Vec3d normal(std::uint32_t face) const {
    return parts_.regions.planes[face].normal;
  }
  [[nodiscard]] Vec3d local(std::uint32_t vertex) const;

  // Vertices.
  std::uint32_t add_vertex(Vec3d position, Vec3d normal);
  std::uint32_t copy_vertex(std::uint32_t vertex, Vec3d normal);
  std::uint32_t add_source_vertex(std::uint32_t vertex, std::uint32_t face);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t face,
                    bool flat);
  [[nodiscard]] std::uint32_t& profile(Item item, int k);
  [[nodiscard]] Vec3d profile_normal(Item item, int k) const;

  bool make();
  bool make_rings();
  void make_sphere(std::uint32_t node);
  void fill_patch(std::uint32_t node, const Ring& ring);
  void fill_triangle(Vec3d center, const std::array<std::uint32_t, 3>& faces);
  void make_strip(std::uint32_t arc_index);
  bool make_faces_of_erosion();

  // Corners of shells that are not exact (bevel_corners.cpp).
  void mark_chains(std::uint32_t shell);
  bool make_corners(std::uint32_t shell);
  void collect_ring(std::uint32_t half_edge);
  bool make_corner();
  bool make_sphere_paths();
  bool make_sphere_path(std::size_t sector);
  bool make_mitre(std::size_t at0, std::size_t at1);
  void make_mitre_paths(std::size_t from, std::size_t to, Vec3d position);
  bool make_caps();
  bool make_wall_cap(std::size_t at);
  bool make_border_cap(std::size_t at);
  [[nodiscard]] double retreat(std::size_t at) const;
  [[nodiscard]] double retreat_in_sector(std::size_t at, std::size_t other, std::uint32_t face,
                                         bool counter_clockwise) const;
  void set_profile(Item item, std::span<const Vec3d> points);
  void fill_wall(std::uint32_t tip, Item item, Vec3d wall_normal, bool at_stub);
  void begin_path() { path_start_ = std::uint32_t(path_vertices_.size()); }
  void end_path(std::uint32_t half_edge);
  bool make_faces(std::uint32_t shell);
  bool make_face(std::uint32_t face);
  void trace_loop(std::uint32_t half_edge, std::uint32_t face);

  const RoundingParts& parts_;
  const WeldedMesh& mesh_;
  const double radius_;
  const int n_;
  BevelSurface& out_;

  // Of the shell under way.
  const ShellNetwork* network_ = nullptr;
  Vec3d center_;
  double size_ = 0;
  std::vector<std::uint32_t> profiles_;  // per item: N+1 vertices
  std::vector<Ring> rings_;              // per node
  std::vector<Item> ring_items_;         // counter-clockwise
  std::vector<std::uint32_t> touch_;     // beside ring_items_: T on face after(item)
  std::vector<std::uint32_t> place_;     // per item: index in ring_items_
  std::vector<std::uint32_t>
      stub_tip_;  // per item of a stub: S on face after(item), then on before

  // Per half-edge of the mesh; a half-edge belongs to one shell.
  std::vector<Item> item_of_;
  std::vector<std::uint8_t> in_chain_, visited_;
  std::vector<Path> path_of_;  // of the sector whose first edge it is
  std::vector<std::uint32_t> path_vertices_;
  std::uint32_t path_start_ = 0;

  // Scratch.
  std::vector<RingEdge> edges_;  // of one corner
  bool ring_open_ = false;
  std::uint32_t corner_vertex_ = 0;
  std::vector<std::uint32_t> side_ab_, side_bc_, side_ac_, row_, next_row_;
  std::vector<Vec3d> points_;
  std::vector<std::vector<std::uint32_t>> loops_;  // corners: indices into face_vertices_
  std::vector<std::uint32_t> face_vertices_;
  std::vector<Vec3f> face_points_;
  std::size_t loop_count_ = 0;
  std::vector<std::vector<std::uint32_t>> borders_;  // per face of the shell: border half-edges
  HolePolygonTriangulator triangulator_;
};

// k / n of the way on the great circle from a to b, both unit.
Vec3d turn_between(Vec3d a, Vec3d b, int k, int n);

}  // namespace arris
