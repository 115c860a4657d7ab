// crease_network.h — arcs and nodes of one shell
// What       Chains of rounded edges become arcs, their ends nodes (see corner.h). For a closed convex shell
//            whose arcs all have positive length this is the edge graph of the erosion E; where arcs turn
//            over, the radius has eaten features and the caller makes E by half-space intersection
//            (eroded_polyhedron.h). On other shells such edges are left sharp and counted, and so are those that
//            would take away what is not theirs (clearance.h); a corner that would gets caps in the sphere's place.
// In / Out   coordinates relative to the shell's centre
// Cost       linear in the shell's triangles, but for clearance.h
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/clearance.h"
#include "rounding/corner.h"
#include "rounding/rounding_data.h"

namespace arris {

// An arc with the ends of its chain of mesh edges, from which its bands take their extent.
struct NetworkArc {
  Arc arc;
  Vec3d v0, v1;
  // The mesh's half-edges that leave v0 and v1 along the chain; kNone for an arc within a corner. A stub has
  // the first alone.
  std::uint32_t half_edge0 = kNone, half_edge1 = kNone;
};

struct NetworkNode {
  Vec3d position;
  Node::Kind kind = Node::Kind::sphere;
  std::uint32_t wall = kNone;  // face in which a cap lies
};

// Indices of arcs and nodes count from 0 within the shell; faces are regions of the mesh.
struct ShellNetwork {
  std::vector<NetworkArc> arcs;
  std::vector<NetworkNode> nodes;
  std::uint64_t rounded_edges = 0;    // chains of mesh edges
  std::uint64_t rounded_corners = 0;  // mesh corners that got spheres
  std::uint64_t shortened_edges = 0;  // left sharp: the radius needs more length than they have
  std::uint64_t narrow_edges = 0;  // left sharp: what would be taken away isn't free (clearance.h)
  bool inverted = false;           // some arc has vanished or turned over
  // The largest radius at which no arc has vanished yet, from the lengths of the arcs.
  double radius_limit = std::numeric_limits<double>::infinity();
};

class NetworkBuilder {
 public:
  // kinds: of every half-edge of the mesh.
  NetworkBuilder(const WeldedMesh& mesh, const FlatRegions& regions, std::vector<EdgeKind>& kinds,
                 double radius);

  // convex: no concave edge anywhere in the shell. Then edges are never left sharp.
  ShellNetwork build(std::uint32_t shell, bool convex);

 private:
  struct End {
    std::uint32_t node;
    Vec3d point;                   // end of the arc's axis
    Vec3d plane_point;             // of the plane in which the arc ends
    Vec3d plane_normal;            // unit, towards the arc
    std::uint32_t mitred = kNone;  // half-edge of the other arc of a mitre
  };
  struct RingEdge {
    std::uint32_t half_edge;                // outgoing
    std::uint32_t face_before, face_after;  // counter-clockwise
    bool rounded;
  };

  // First half-edges of the arcs to be left sharp, and a half-edge of each corner not to get spheres.
  struct Refused {
    std::vector<std::uint32_t> shortened, narrow, corners;

    [[nodiscard]] bool any() const {
      return !shortened.empty() || !narrow.empty() || !corners.empty();
    }
  };

  ShellNetwork build_once(std::uint32_t shell, bool convex, Refused& refused);
  void leave_sharp(std::uint32_t first);
  void leave_all_sharp(std::uint32_t shell);
  void forget_ends(std::uint32_t shell);
  void check_cuts(Clearance& clearance, Refused& refused);
  void leave_without_spheres(const Cut& corner, Refused& refused);
  bool add_cut(const NetworkArc& arc, const End& end0, const End& end1);
  void add_corner_cut(const CornerErosion& erosion);
  [[nodiscard]] double cap_shift(const RingEdge& edge) const;
  void collect_ring(std::uint32_t half_edge);
  void make_corner();
  void make_cap(const RingEdge& edge);
  bool make_mitre(const RingEdge& a, const RingEdge& b);
  void make_spheres();
  void split_spheres(std::uint32_t i, std::uint32_t j, std::uint32_t node, Vec3d travel);
  void link_edge_to(std::uint32_t ring_edge, std::uint32_t node);
  bool make_arc(std::uint32_t first);
  std::uint32_t add_node(const NetworkNode& node);
  std::uint32_t set_end(std::uint32_t half_edge, const End& end);
  [[nodiscard]] Vec3d local(std::uint32_t vertex) const;
  [[nodiscard]] ArcLine arc_line(Vec3d p0, Vec3d p1, std::uint32_t face_a,
                                 std::uint32_t face_b) const;
  [[nodiscard]] Vec3d axis_point(std::uint32_t face_a, std::uint32_t face_b, Vec3d near) const;
  [[nodiscard]] Vec3d outgoing_direction(const RingEdge& edge) const;

  const WeldedMesh& mesh_;
  const FlatRegions& regions_;
  std::vector<EdgeKind>& kinds_;
  double radius_;
  std::vector<std::uint32_t> end_of_;  // per half-edge: index into ends_, or a mark
  std::vector<End> ends_;
  std::vector<RingEdge> ring_;
  bool ring_open_ = false;
  bool ring_irregular_ = false;
  Vec3d center_;
  double size_ = 0;
  bool convex_ = false;
  ShellNetwork out_;
  std::vector<Cut> cuts_;     // of what is made, on shells that aren't convex
  std::vector<bool> capped_;  // per half-edge: its corner gets no spheres
};

}  // namespace arris
