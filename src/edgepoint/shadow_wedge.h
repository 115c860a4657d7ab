// shadow_wedge.h — an event as a plane with two coordinates, and where a mesh's triangles meet it
// What       EventWedge: s along the event, and nearness to the light, in which segments of the plane are straight.
//            WedgeWalk takes it down a receiver's face tree, nearest first.
// In / Out   world coordinates; pieces carry the number of their receiver
// Guarantee  neighbouring triangles meet the plane in points that are equal, bit for bit: pieces leave no gaps. Boxes
//            are judged in float, with a margin of 16 units of 2⁻²⁴ for values that are scaled to at most 1.
// Source     Bala, Walter, Greenberg 2003, sections 6.4 and 6.5. Beyond it: the walk visits the nearer of two nodes
//            first and leaves out what lies behind what has been found along the whole event.
// Derivation With the apex A, the rays r0 and r1 and N = r0 × r1, a point of the plane is A + a r0 + b r1 with
//            a = (r1 × N)·(p − A) / N², b = (N × r0)·(p − A) / N². It lies on the ray r0 + s (r1 − r0), s = b / (a +
//            b), u = a + b times as far as the ray's vector. A line of the plane, x a + y b = 1, is x (1 − s) + y s = 1
//            / u: linear in s and the nearness 1 / u. With parallel rays d from o0 + s (o1 − o0) it is linear in s and
//            u as it is; the nearness is then −u.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edgepoint/face_tree.h"
#include "edgepoint/nearest_pieces.h"
#include "edgepoint/shadow_events.h"

namespace arris {

// direction·p + offset.
struct LinearForm {
  Vec3d direction;
  double offset = 0;

  [[nodiscard]] double at(Vec3d p) const { return dot(direction, p) + offset; }
};

struct EventWedge {
  LinearForm plane;  // zero on it
  LinearForm a, b;   // both at least 0 within
  LinearForm u;      // distance from the apex, or from the origin if parallel
  bool parallel = false;
  Vec3d apex;              // or o0
  std::array<Vec3d, 2> r;  // or o1 − o0 and d
  double begin = 0;        // nearness where the event begins
  double contact = 0;      // nearer by no more than this is a contact with the beginning
  double last_u = 0;       // what is farther does not count

  [[nodiscard]] double nearness(double u_at) const { return parallel ? -u_at : 1 / u_at; }
  [[nodiscard]] Vec3d point(double s, double k) const {
    return parallel ? apex + r[0] * s - r[1] * k : apex + (r[0] + (r[1] - r[0]) * s) * (1 / k);
  }
};

// From the light through the beginning and on; for EV events: from the vertex on. None if it has no width.
std::optional<EventWedge> make_wedge(const ShadowEvent& event);
// Of an EV event, from the vertex to the light's edge.
std::optional<EventWedge> make_wedge_to_light(const ShadowEvent& event);

// Where roundings have taken a mesh's faces away: at barycentric (u, v) of a face where c0 + cu u + cv v > 0 for one of
// its bands.
struct FaceVoids {
  struct Band {
    double c0 = 0, cu = 0, cv = 0;
  };
  std::vector<std::uint32_t> first;  // of each face, and one more
  std::vector<Band> bands;

  [[nodiscard]] std::span<const Band> of(std::uint32_t face) const {
    if (face + 1 >= first.size()) return {};
    return std::span(bands).subspan(first[face], first[face + 1] - first[face]);
  }
};

struct ShadowReceiver {
  const FaceTree* faces = nullptr;
  Affine3d world_from_object;
  bool is_blocker =
      false;  // the same object as the blocker: faces beside the event's own edge are not met
  const FaceVoids* voids = nullptr;  // none: sharp
};

class WedgeWalk {
 public:
  // What of the receiver meets the wedge, as pieces with the number `index`.
  void insert(const EventWedge& wedge, const ShadowEvent& event, const ShadowReceiver& receiver,
              std::uint32_t index, NearestPieces& pieces);
  // Pieces where roundings have taken the receiver away: the surface is a little behind, or the event passes.
  [[nodiscard]] std::vector<EventPiece>& taken() { return taken_; }

 private:
  struct Waiting {
    std::uint32_t first, faces;  // a node, if 0 faces
    float nearest_u;
  };
  void push_boxes(const FaceNode& node, const std::array<float, 4>& u, float farthest);

  std::vector<Waiting> stack_;
  std::vector<EventPiece> met_, taken_;
  std::uint32_t next_item_ = 0;
};

}  // namespace arris
