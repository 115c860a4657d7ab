#include "edgepoint/shadow_edges.h"

#include <algorithm>
#include <optional>

#include "base/parallel_for.h"
#include "edgepoint/shadow_wedge.h"

namespace arris {
namespace {

// Where the penumbra's other side is without end. Far beyond any picture, well within the range of float.
constexpr double kFarOut = 1e12;

struct Stretch {
  double s0, s1;
};

// Splits the part of [s0, s1] where nearness is above `limit` from the rest.
struct Parts {
  std::optional<Stretch> above, below;
};

Parts split_at(const EventPiece& p, double limit) {
  const double k0 = p.nearness(p.s0), k1 = p.nearness(p.s1);
  if (k0 > limit && k1 > limit) return {Stretch{p.s0, p.s1}, std::nullopt};
  if (k0 <= limit && k1 <= limit) return {std::nullopt, Stretch{p.s0, p.s1}};
  const double s = p.s0 + (p.s1 - p.s0) * ((limit - k0) / (k1 - k0));
  if (k0 > limit) return {Stretch{p.s0, s}, Stretch{s, p.s1}};
  return {Stretch{s, p.s1}, Stretch{p.s0, s}};
}

// Normal of a face in the world; of any length.
Vec3d face_normal(const ShadowReceiver& receiver, std::uint32_t face) {
  const EdgeMesh& mesh = receiver.faces->mesh();
  const Triangle& t = mesh.triangles[face];
  const auto at = [&](std::size_t k) { return Vec3d(mesh.vertices[t[k]]); };
  const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
  return transpose(inverse(receiver.world_from_object).linear) * normal;
}

// From `place`, where the event meets a face at s, to where the face's plane meets the ray through the same point of
// the blocker from the light's far side; without end where that ray runs along the plane or away from it.
Vec3d penumbra_at(const ShadowEvent& event, double s, Vec3d place, const ShadowReceiver& receiver,
                  std::uint32_t face) {
  const Vec3d from = event.origin[0] + (event.origin[1] - event.origin[0]) * s;
  const auto light_at = [&](std::size_t k) { return event.light[k].xyz / event.light[k].w; };
  const Vec3d light = light_at(0) + (light_at(1) - light_at(0)) * s + event.across;
  const Vec3d ray = from - light, normal = face_normal(receiver, face);
  const double fall = dot(normal, ray), height = dot(normal, place - from);
  if (height == 0) return {};
  const double t = height / fall;
  if (!(t > 0 && t < kFarOut)) return normalize(ray) * kFarOut;
  return from + ray * t - place;
}

// One event after another, with the memory of the one before.
class EventTracer {
 public:
  // Both sorted by their numbers; `added` are among `receivers`.
  EventTracer(std::span<const ShadowReceiver> receivers, std::span<const ShadowReceiver> added)
      : receivers_(receivers), added_(added) {}

  // What is known of one event.
  struct Known {
    std::span<const EventPiece> toward_light, met;
    std::span<const EventSegment> taken;
    std::span<const ShadowEdge> edges;
  };

  // Its edges with those on the added receivers: what is known of it then.
  Known trace(const ShadowEvent& event, const Known& known) {
    const std::optional<EventWedge> wedge = make_wedge(event);
    if (!wedge) return known;
    bool changed = false;
    hidden_.clear();
    if (event.is_at_vertex()) {
      const std::optional<EventWedge> to_light = make_wedge_to_light(event);
      if (!to_light) return known;
      toward_light_.assign(known.toward_light);
      // What is hidden stays so, and needs no more.
      if (is_all_hidden(*to_light)) return known;
      ignored_.clear();
      changed = insert_added(*to_light, event, toward_light_, ignored_);
      if (is_all_hidden(*to_light)) return {toward_light_.pieces(), {}, {}, {}};
    }
    met_.assign(known.met);
    taken_.assign(known.taken.begin(), known.taken.end());
    changed |= insert_added(*wedge, event, met_, taken_);
    if (!changed) return known;
    std::ranges::sort(taken_);
    edges_.clear();
    for (const EventPiece& p : met_.pieces()) {
      if (const auto shown = split_at(p, wedge->begin + wedge->contact).below) {
        add_shown(*wedge, event, p.of, *shown);
      }
    }
    for (const EventSegment& t : taken_) {
      if (const auto shown = split_at({t.s0, t.s1, t}, wedge->begin + wedge->contact).below) {
        add_unless_behind(*wedge, event, t, *shown);
      }
    }
    return {toward_light_of(event), met_.pieces(), taken_, edges_};
  }

 private:
  bool insert_added(const EventWedge& wedge, const ShadowEvent& event, NearestPieces& pieces,
                    std::vector<EventSegment>& taken) {
    bool changed = false;
    for (const ShadowReceiver& r : added_) changed |= walk_.insert(wedge, event, r, pieces, taken);
    return changed;
  }
  [[nodiscard]] std::span<const EventPiece> toward_light_of(const ShadowEvent& event) const {
    if (!event.is_at_vertex()) return {};
    return toward_light_.pieces();
  }
  // Finds where something lies between the light's edge and the vertex.
  bool is_all_hidden(const EventWedge& to_light) {
    hidden_.clear();
    double covered = 0;
    for (const EventPiece& p : toward_light_.pieces()) {
      const auto hidden = split_at(p, to_light.begin + to_light.contact).above;
      if (!hidden) continue;
      hidden_.push_back(*hidden);
      covered += hidden->s1 - hidden->s0;
    }
    return covered >= 1 - kShortestPiece;
  }
  // Adds the stretch of a segment where a receiver is rounded away, but for what lies behind the nearest pieces. Where
  // the event passes through the void it goes on to those; which of both it does is left open.
  void add_unless_behind(const EventWedge& wedge, const ShadowEvent& event, const EventSegment& p,
                         Stretch shown) {
    for (const EventPiece& near : met_.pieces()) {
      const double s0 = std::max(near.s0, shown.s0), s1 = std::min(near.s1, shown.s1);
      if (s0 >= s1 || near.nearness((s0 + s1) / 2) <= p.nearness((s0 + s1) / 2)) continue;
      add_shown(wedge, event, p, {shown.s0, s0});
      shown.s0 = s1;
    }
    add_shown(wedge, event, p, shown);
  }
  // Adds what of the stretch is not hidden.
  void add_shown(const EventWedge& wedge, const ShadowEvent& event, const EventSegment& p,
                 Stretch shown) {
    for (const Stretch& h : hidden_) {
      if (h.s1 <= shown.s0 || h.s0 >= shown.s1) continue;
      add_edge(wedge, event, p, {shown.s0, h.s0});
      shown.s0 = h.s1;
    }
    add_edge(wedge, event, p, shown);
  }
  void add_edge(const EventWedge& wedge, const ShadowEvent& event, const EventSegment& p,
                Stretch shown) {
    if (!(shown.s1 - shown.s0 > kShortestPiece)) return;
    const auto at = [&](double s) {
      return Vec3f(wedge.point(s, std::min(p.nearness(s), wedge.begin)));
    };
    ShadowEdge edge{at(shown.s0), at(shown.s1), event.kind, p.receiver, {}};
    if (event.kind != ShadowKind::hard) {
      const double s = (shown.s0 + shown.s1) / 2;
      edge.penumbra = Vec3f(
          penumbra_at(event, s, (Vec3d(edge.a) + Vec3d(edge.b)) / 2, receiver(p.receiver), p.face));
    }
    edges_.push_back(edge);
  }
  [[nodiscard]] const ShadowReceiver& receiver(std::uint32_t number) const {
    return *std::ranges::lower_bound(receivers_, number, {}, &ShadowReceiver::number);
  }

  std::span<const ShadowReceiver> receivers_, added_;
  WedgeWalk walk_;
  NearestPieces toward_light_, met_;
  std::vector<EventSegment> taken_, ignored_;
  std::vector<Stretch> hidden_;  // sorted
  std::vector<ShadowEdge> edges_;
};

EventTracer::Known known_of(const FoundOnReceivers& found, std::size_t event) {
  return {found.toward_light.of(event), found.met.of(event), found.taken.of(event),
          found.edges.of(event)};
}

void push(FoundOnReceivers& found, const EventTracer::Known& known) {
  found.toward_light.push(known.toward_light);
  found.met.push(known.met);
  found.taken.push(known.taken);
  found.edges.push(known.edges);
}

void append(FoundOnReceivers& found, const FoundOnReceivers& more) {
  found.toward_light.append(more.toward_light);
  found.met.append(more.met);
  found.taken.append(more.taken);
  found.edges.append(more.edges);
}

}  // namespace

void TracedEvents::add(std::span<const ShadowReceiver> receivers,
                       std::span<const ShadowReceiver> added) {
  constexpr std::size_t kBlock = 128;
  const std::size_t blocks = (events_.size() + kBlock - 1) / kBlock;
  std::vector<FoundOnReceivers> found(blocks);
  parallel_for(blocks, {}, [&](std::size_t block) {
    EventTracer tracer(receivers, added);
    const std::size_t last = std::min(events_.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < last; ++i) {
      push(found[block], tracer.trace(events_[i], known_of(found_, i)));
    }
  });
  found_ = {};
  for (const FoundOnReceivers& f : found) append(found_, f);
}

std::vector<ShadowEvent> transform(const Affine3d& world_from_blocker,
                                   std::span<const ShadowEvent> events) {
  std::vector<ShadowEvent> out;
  out.reserve(events.size());
  for (const ShadowEvent& e : events) out.push_back(transform(world_from_blocker, e));
  return out;
}

}  // namespace arris
