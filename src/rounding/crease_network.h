// crease_network.h — arcs and nodes of one shell
// What       Chains of rounded edges become arcs, their ends nodes (see corner.h). For a closed convex shell
//            whose arcs all have positive length this is the edge graph of the erosion E; where arcs turn
//            over, the radius has eaten features and the caller makes E by half-space intersection
//            (eroded_polyhedron.h). On other shells short edges of a rim are skipped (crease_chains.cpp); what is
//            too short then, or would take away what is not its own (clearance.h), is left sharp and counted. A
//            corner that would gets caps in the spheres' place.
// In / Out   coordinates relative to the shell's centre
// Cost       linear in the shell's triangles, but for clearance.h
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
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

// A face without an edge of its own on an arc that rounds it: it touches a chain in a corner, or its edge is skipped.
struct BorderFace {
  std::uint32_t face, other;  // the arc's face on the edge's other side
  Vec3d v0, v1;               // where it touches the chain
  std::uint32_t arc;          // index
};

// Indices of arcs and nodes count from 0 within the shell; faces are regions of the mesh.
struct ShellNetwork {
  std::vector<NetworkArc> arcs;
  std::vector<NetworkNode> nodes;
  std::vector<BorderFace> border_faces;
  std::uint64_t rounded_edges = 0;    // chains of mesh edges
  std::uint64_t rounded_corners = 0;  // mesh corners that got spheres
  std::uint64_t shortened_edges = 0;  // left sharp: the radius needs more length than they have
  std::uint64_t narrow_edges = 0;  // left sharp: what would be taken away isn't free (clearance.h)
  std::vector<std::uint32_t> left_sharp;  // half-edges of the mesh of all these
  bool inverted = false;                  // some arc has vanished or turned over
  // The largest radius at which no arc has vanished yet, from the lengths of the arcs.
  double radius_limit = std::numeric_limits<double>::infinity();
};

// What becomes of edges of a chain, on shells that aren't convex, that are too short for the radius.
enum class ShortEdges { skip, leave_sharp };

class NetworkBuilder {
 public:
  // kinds: of every half-edge of the mesh.
  NetworkBuilder(const WeldedMesh& mesh, const FlatRegions& regions, std::vector<EdgeKind>& kinds,
                 double radius, ShortEdges short_edges);

  // convex: no concave edge anywhere in the shell. Then edges are never left sharp.
  ShellNetwork build(std::uint32_t shell, bool convex);

 private:
  // Marks in end_of_.
  static constexpr std::uint32_t kUnset = kNone;
  static constexpr std::uint32_t kThrough = kNone - 1;  // the chain goes straight on here
  static constexpr std::uint32_t kSkipped = kNone - 2;  // the edge is skipped

  struct End {
    std::uint32_t node;
    Vec3d point;         // end of the arc's axis
    Vec3d plane_point;   // of the plane in which the arc ends
    Vec3d plane_normal;  // unit, towards the arc
    // Half-edges of the other arc of a mitre, and of what is skipped between.
    std::vector<std::uint32_t> mitred{};
    std::uint32_t arc = kNone;  // index, once it is made
  };
  struct RingEdge {
    std::uint32_t half_edge;                // outgoing
    std::uint32_t face_before, face_after;  // counter-clockwise
    bool rounded;
  };

  // First half-edges of the arcs to be left sharp, and a half-edge of each corner not to get spheres.
  struct Refused {
    std::vector<std::uint32_t> shortened, narrow, corners;
    std::uint64_t no_longer_skipped = 0;  // edges that are to stay sharp now
    bool skips_changed = false;

    [[nodiscard]] bool any() const {
      return !shortened.empty() || !narrow.empty() || !corners.empty() || no_longer_skipped > 0 ||
             skips_changed;
    }
  };
  // An arc that has no length left.
  struct Vanished {
    std::uint32_t first, back;  // half-edges that leave its ends
    double limit;               // radius at which its length is 0
  };
  // A BorderFace of the arc that has this half-edge at one end.
  struct Border {
    std::uint32_t half_edge;
    BorderFace face;
  };

  ShellNetwork build_once(std::uint32_t shell, bool convex, Refused& refused);
  void leave_sharp(std::uint32_t first, std::vector<std::uint32_t>& left);
  void leave_all_sharp(std::uint32_t shell, std::vector<std::uint32_t>& left);
  void forget_ends(std::uint32_t shell);
  void check_cuts(Clearance& clearance, Refused& refused);
  void leave_without_spheres(const Cut& corner, Refused& refused);
  bool add_cut(const NetworkArc& arc, const End& end0, const End& end1);
  void add_corner_cut(const CornerErosion& erosion);
  [[nodiscard]] double cap_shift(const RingEdge& edge) const;
  void collect_ring(std::uint32_t half_edge);
  void make_corner();
  void make_cap(const RingEdge& edge);
  bool make_mitre(const RingEdge& a, const RingEdge& b,
                  const std::vector<std::uint32_t>& between = {});
  void make_corner_beyond();
  bool make_mitre_beyond(const RingEdge& edge, std::uint32_t skipped);
  std::optional<RingEdge> edge_beyond(std::uint32_t half_edge, std::vector<std::uint32_t>& passed);
  void skip_or_leave_sharp(Refused& refused);
  [[nodiscard]] bool can_skip(const Vanished& arc) const;
  void skip(std::uint32_t first);
  void leave_broken_runs_sharp(Refused& refused);
  [[nodiscard]] std::vector<std::uint32_t> pieces_of(std::uint32_t first) const;
  void add_border_faces(const RingEdge& a, const RingEdge& b);
  void add_border_faces_beyond(const RingEdge& a, const RingEdge& b,
                               std::span<const std::uint32_t> passed);
  void append_border_faces();
  void make_spheres();
  void make_arc(std::uint32_t first);
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
  ShortEdges short_edges_;
  std::vector<std::uint32_t> end_of_;  // per half-edge: index into ends_, or a mark
  std::vector<End> ends_;
  std::vector<RingEdge> ring_;
  bool ring_open_ = false;
  bool ring_irregular_ = false;
  Vec3d center_;
  double size_ = 0;
  bool convex_ = false;
  ShellNetwork out_;
  std::vector<Cut> cuts_;      // of what is made, on shells that aren't convex
  std::vector<bool> capped_;   // per half-edge: its corner gets no spheres
  std::vector<bool> skipped_;  // per half-edge
  std::vector<Border> borders_;
  std::vector<Vanished> vanished_;
  std::vector<std::uint32_t> no_longer_skipped_;
};

}  // namespace arris
