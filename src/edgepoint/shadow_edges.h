// shadow_edges.h — where shadow events meet receivers
// What       find_shadow_edges() takes each event to the surfaces that it meets first, seen from the light: these are
//            the shadow's edges. What lies between the light and the event's beginning takes the event away.
// In / Out   world coordinates. `receiver`: index into the receivers given. One list of (light, blocker, receivers) at
//            a time: keep what comes out while none of them moves.
// Guarantee  along each event, each point is on the receiver nearest to the beginning; same edges in the same order
//            with any number of threads. For point and directional lights visibility changes across every edge and
//            nowhere else, on random scenes; for area lights every place where the light begins to be hidden lies on a
//            penumbral edge (tests/edgepoint/shadow_edges_test.cpp).
// Limits     receivers that are not given neither show edges nor hide any: give all that may come first. Closed
//            receivers are met from their front only; open ones and such as have the light within their bounds from
//            both sides. A contact within float's rounding of the beginning ends an event there; it is an edge, too.
//            Pieces along a ray of the light have no extent along the event and are left out, and so is the line
//            where a solid enters a receiver. Where two blockers hide an area light together, neither's umbral edges
//            end what they hide.
//            Where roundings have taken a receiver away (ShadowReceiver::voids), an edge is shown on its sharp face and
//            on what lies behind: which of both has it is not decided.
// Cost       per event about that of one ray through each receiver's tree, parallel over events
// Source     Bala, Walter, Greenberg 2003, sections 6.4, 6.5
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/shadow_events.h"
#include "edgepoint/shadow_wedge.h"

namespace arris {

struct ShadowEdge {
  Vec3f a, b;
  ShadowKind kind = ShadowKind::hard;
  std::uint32_t receiver = 0;
  // From the middle of the edge across the penumbra to its other side, in the receiver's plane; 0 if hard.
  Vec3f penumbra;
};

std::vector<ShadowEdge> find_shadow_edges(std::span<const ShadowEvent> events,
                                          std::span<const ShadowReceiver> receivers);

// Events in the blocker's coordinates, taken to world coordinates.
std::vector<ShadowEvent> transform(const Affine3d& world_from_blocker,
                                   std::span<const ShadowEvent> events);

}  // namespace arris
