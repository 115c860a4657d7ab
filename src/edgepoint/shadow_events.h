// shadow_events.h — the planes along which the shadow of a mesh begins and ends
// What       find_shadow_events() lists the events of a light and a blocker: wedges that start at an edge of the
//            blocker (VE events, from a vertex of the light) or at a vertex of it (EV events, from an edge of the
//            light) and go on away from the light. Receivers show shadow edges where they meet one (shadow_edges.h).
// In / Out   light and events in the blocker's coordinates; transform() takes them elsewhere
// Guarantee  VE events: all edges that are silhouettes from a vertex of the light whose plane has the light's other
//            vertices on one side. Penumbral EV events: all vertices of edges that the light may see as silhouettes,
//            around which the blocker lies on one side of the plane through an edge of the light, and the light on
//            the other. Both as brute force over all edges and
//            vertices finds them; for convex blockers they are the outline of the shadow's hull
//            (tests/edgepoint/shadow_events_test.cpp). Vertices that lie in a plane are on neither side.
// Limits     events of three edges (EEE) are not looked for, as in the paper. Edges of a closed blocker that fills more
//            than half of the space around them cast no shadow while the light is outside, which is believed where the
//            light is outside the blocker's bounds.
// Cost       that of EdgeTree's query, and the edges around each vertex found
// Source     Bala, Walter, Greenberg 2003, section 6.3 and Appendix A. Where we differ: EV events are found around
//            every vertex of the edges that a point of the light may see as silhouette, not by walking from VE events
//            alone: a spike may have EV events and no VE event beside them. Whether an EV plane touches the blocker is
//            decided by sides of vertices, not by angles. Umbral EV events join two umbral VE events at a concave turn.
// Legend     e edge, q vertex of the blocker; i, j corners of the light
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/edge_tree.h"

namespace arris {

enum class ShadowKind : std::uint8_t { hard, penumbral, umbral };

// Point s of the event, 0 <= s <= 1: starts at origin(s) = origin[0] + s (origin[1] − origin[0]) and goes on away from
// the light's light(s), which lies between light[0] and light[1].
struct ShadowEvent {
  ShadowKind kind = ShadowKind::hard;
  std::array<Vec3d, 2> origin;            // EV: the vertex, twice
  std::array<HomogeneousPoint, 2> light;  // VE: the vertex, twice
  // Vertices at the two ends of origin; kNone where the edge was cut at the light's plane.
  std::array<std::uint32_t, 2> vertex{kNone, kNone};
  std::array<std::uint32_t, 2> faces{kNone, kNone};  // of the edge; VE only
  // From light(s) to the corner of the light that is farthest from the event's plane: 0 if the light is a point.
  Vec3d across;
  // Of a rounded blocker: so far from the beginning, along a ray and on both sides, surfaces show no edge where
  // roundings have taken them away (ShadowReceiver::voids), as the event begins in that void. In the world.
  double void_depth = 0;

  [[nodiscard]] bool is_at_vertex() const { return vertex[0] != kNone && vertex[0] == vertex[1]; }
};

// Emits to the side of its plane that `toward` points to.
struct ParallelogramLight {
  Vec3d corner, u, v;
  Vec3d toward;

  // Around it.
  [[nodiscard]] std::array<Vec3d, 4> corners() const {
    return {corner, corner + u, corner + u + v, corner + v};
  }
};

ParallelogramLight transform(const Affine3d& m, const ParallelogramLight& light);
ShadowEvent transform(const Affine3d& m, const ShadowEvent& event);

// Of a point light, or with w = 0 of a directional one: `light` is where it shines from.
std::vector<ShadowEvent> find_shadow_events(const EdgeTree& blocker, const HomogeneousPoint& light);
std::vector<ShadowEvent> find_shadow_events(const EdgeTree& blocker,
                                            const ParallelogramLight& light);

}  // namespace arris
