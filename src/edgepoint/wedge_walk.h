// wedge_walk.h — where a mesh's triangles meet the wedge of an event
// What       takes a wedge down a receiver's face tree, nearest first
// In / Out   world coordinates; what is met has the number of its receiver
// Guarantee  neighbouring triangles meet the plane in points that are equal, bit for bit: segments leave no gaps. Boxes
//            are judged in float, with a margin of 16 units of 2⁻²⁴ for values that are scaled to at most 1.
// Source     Bala, Walter, Greenberg 2003, sections 6.4 and 6.5. Beyond it: the walk visits the nearer of two nodes
//            first and leaves out what lies behind what has been found along the whole event.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/face_tree.h"
#include "edgepoint/nearest_pieces.h"
#include "edgepoint/shadow_events.h"
#include "edgepoint/shadow_wedge.h"

namespace arris {

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
  std::uint32_t number = 0;  // the caller's
  const FaceTree* faces = nullptr;
  Affine3d world_from_object;
  // The same object as the blocker: faces beside the event's own edge are not met.
  bool is_blocker = false;
  const FaceVoids* voids = nullptr;  // none: sharp
};

class WedgeWalk {
 public:
  // Adds where the receiver meets the wedge. What roundings have taken away of it goes to `taken`: the surface is a
  // little behind, or the event passes. Whether anything was added.
  bool insert(const EventWedge& wedge, const ShadowEvent& event, const ShadowReceiver& receiver,
              NearestPieces& pieces, std::vector<EventSegment>& taken);

 private:
  struct Waiting {
    std::uint32_t first, faces;  // a node, if 0 faces
    float nearest_u;
  };
  void push_boxes(const FaceNode& node, const std::array<float, 4>& u, float farthest);

  std::vector<Waiting> stack_;
  std::vector<EventSegment> met_;
};

}  // namespace arris
