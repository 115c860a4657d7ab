// shadow_edges.h — where shadow events meet receivers
// What       TracedEvents takes each event to the surfaces that it meets first, seen from the light: these are the
//            shadow's edges. What lies between the light and the event's beginning takes the event away. Receivers
//            are added as they become known; what was found on others stays, but for what they hide.
// In / Out   world coordinates. One TracedEvents for each light and blocker: keep it while neither they nor their
//            receivers move.
// Guarantee  along each event, each point is on the receiver nearest to the beginning; same edges in the same order
//            with any number of threads, and however receivers come, one by one or at once. For point and directional
//            lights visibility changes across every edge and nowhere else, on random scenes; for area lights every
//            place where the light begins to be hidden lies on a penumbral edge
//            (tests/edgepoint/shadow_edges_test.cpp).
// Limits     receivers that are not given neither show edges nor hide any: give all that may come first. Closed
//            receivers are met from their front only; open ones and such as have the light within their bounds from
//            both sides. A contact within float's rounding of the beginning ends an event there; it is an edge, too.
//            Pieces along a ray of the light have no extent along the event and are left out, and so is the line
//            where a solid enters a receiver. Where two blockers hide an area light together, neither's umbral edges
//            end what they hide.
//            Where roundings have taken a receiver away (ShadowReceiver::voids), an edge is shown on its sharp face and
//            on what lies behind: which of both has it is not decided.
// Cost       per event about that of one ray through the tree of each receiver that is added, parallel over events
// Source     Bala, Walter, Greenberg 2003, sections 6.4, 6.5
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "edgepoint/nearest_pieces.h"
#include "edgepoint/shadow_events.h"
#include "edgepoint/wedge_walk.h"

namespace arris {

struct ShadowEdge {
  Vec3f a, b;
  ShadowKind kind = ShadowKind::hard;
  std::uint32_t receiver = 0;
  // From the middle of the edge across the penumbra to its other side, in the receiver's plane; 0 if hard.
  Vec3f penumbra;
};

// A list of things for each event.
template <class T>
struct EventLists {
  std::vector<T> items;
  std::vector<std::uint32_t> ends;

  [[nodiscard]] std::span<const T> of(std::size_t event) const {
    if (event >= ends.size()) return {};
    const std::uint32_t first = event == 0 ? 0 : ends[event - 1];
    return std::span(items).subspan(first, ends[event] - first);
  }
  void push(std::span<const T> list) {
    items.insert(items.end(), list.begin(), list.end());
    ends.push_back(std::uint32_t(items.size()));
  }
  void append(const EventLists& more) {
    const auto before = std::uint32_t(items.size());
    items.insert(items.end(), more.items.begin(), more.items.end());
    for (const std::uint32_t end : more.ends) ends.push_back(before + end);
  }
};

struct FoundOnReceivers {
  EventLists<EventPiece>
      toward_light;                // of EV events: what is nearest to the light before the vertex
  EventLists<EventPiece> met;      // what is nearest beyond
  EventLists<EventSegment> taken;  // where roundings have taken receivers away
  EventLists<ShadowEdge> edges;    // what follows from all three
};

class TracedEvents {
 public:
  explicit TracedEvents(std::vector<ShadowEvent> events = {}) : events_(std::move(events)) {}

  // receivers: all so far, of which `added` are new; both sorted by number, each of its own.
  void add(std::span<const ShadowReceiver> receivers, std::span<const ShadowReceiver> added);
  // As if none had been added.
  void forget_receivers() { found_ = {}; }
  [[nodiscard]] const std::vector<ShadowEvent>& events() const { return events_; }
  [[nodiscard]] const std::vector<ShadowEdge>& edges() const { return found_.edges.items; }

 private:
  std::vector<ShadowEvent> events_;
  FoundOnReceivers found_;
};

// Events in the blocker's coordinates, taken to world coordinates.
std::vector<ShadowEvent> transform(const Affine3d& world_from_blocker,
                                   std::span<const ShadowEvent> events);

}  // namespace arris
