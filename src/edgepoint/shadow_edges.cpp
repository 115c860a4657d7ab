#include "edgepoint/shadow_edges.h"

#include <algorithm>
#include <optional>

#include "base/parallel_for.h"

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
  if (p.k0 > limit && p.k1 > limit) return {Stretch{p.s0, p.s1}, std::nullopt};
  if (p.k0 <= limit && p.k1 <= limit) return {std::nullopt, Stretch{p.s0, p.s1}};
  const double s = p.s0 + (p.s1 - p.s0) * ((limit - p.k0) / (p.k1 - p.k0));
  if (p.k0 > limit) return {Stretch{p.s0, s}, Stretch{s, p.s1}};
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
  EventTracer(std::span<const ShadowReceiver> receivers, std::vector<ShadowEdge>& out)
      : receivers_(receivers), out_(out) {}

  void trace(const ShadowEvent& event) {
    const std::optional<EventWedge> wedge = make_wedge(event);
    if (!wedge) return;
    hidden_.clear();
    if (event.is_at_vertex() && !find_hidden(event)) return;
    find_nearest(*wedge, event);
    for (const EventPiece& p : pieces_.pieces()) {
      if (const auto shown = split_at(p, wedge->begin + wedge->contact).below) {
        add_shown(*wedge, event, p, *shown);
      }
    }
    for (const EventPiece& p : walk_.taken()) {
      if (const auto shown = split_at(p, wedge->begin + wedge->contact).below) {
        add_unless_behind(*wedge, event, p, *shown);
      }
    }
  }

 private:
  void find_nearest(const EventWedge& wedge, const ShadowEvent& event) {
    pieces_.clear();
    walk_.taken().clear();
    for (std::uint32_t i = 0; i < receivers_.size(); ++i) {
      walk_.insert(wedge, event, receivers_[i], i, pieces_);
    }
  }
  // Where something lies between the light's edge and the vertex; whether anything is left.
  bool find_hidden(const ShadowEvent& event) {
    const std::optional<EventWedge> wedge = make_wedge_to_light(event);
    if (!wedge) return false;
    find_nearest(*wedge, event);
    double covered = 0;
    for (const EventPiece& p : pieces_.pieces()) {
      const auto hidden = split_at(p, wedge->begin + wedge->contact).above;
      if (!hidden) continue;
      hidden_.push_back(*hidden);
      covered += hidden->s1 - hidden->s0;
    }
    return covered < 1 - kShortestPiece;
  }
  // Adds the stretch of a piece where a receiver is rounded away, but for what lies behind the nearest pieces. Where
  // the event passes through the void it goes on to those; which of both it does is left open.
  void add_unless_behind(const EventWedge& wedge, const ShadowEvent& event, const EventPiece& p,
                         Stretch shown) {
    for (const EventPiece& near : pieces_.pieces()) {
      const double s0 = std::max(near.s0, shown.s0), s1 = std::min(near.s1, shown.s1);
      if (s0 >= s1 || near.nearness((s0 + s1) / 2) <= p.nearness((s0 + s1) / 2)) continue;
      add_shown(wedge, event, p, {shown.s0, s0});
      shown.s0 = s1;
    }
    add_shown(wedge, event, p, shown);
  }
  // Adds what of the stretch is not hidden.
  void add_shown(const EventWedge& wedge, const ShadowEvent& event, const EventPiece& p,
                 Stretch shown) {
    for (const Stretch& h : hidden_) {
      if (h.s1 <= shown.s0 || h.s0 >= shown.s1) continue;
      add_edge(wedge, event, p, {shown.s0, h.s0});
      shown.s0 = h.s1;
    }
    add_edge(wedge, event, p, shown);
  }
  void add_edge(const EventWedge& wedge, const ShadowEvent& event, const EventPiece& p,
                Stretch shown) {
    if (!(shown.s1 - shown.s0 > kShortestPiece)) return;
    const auto at = [&](double s) {
      return Vec3f(wedge.point(s, std::min(p.nearness(s), wedge.begin)));
    };
    ShadowEdge edge{at(shown.s0), at(shown.s1), event.kind, p.receiver, {}};
    if (event.kind != ShadowKind::hard) {
      const double s = (shown.s0 + shown.s1) / 2;
      edge.penumbra = Vec3f(penumbra_at(event, s, (Vec3d(edge.a) + Vec3d(edge.b)) / 2,
                                        receivers_[p.receiver], p.face));
    }
    out_.push_back(edge);
  }

  std::span<const ShadowReceiver> receivers_;
  std::vector<ShadowEdge>& out_;
  WedgeWalk walk_;
  NearestPieces pieces_;
  std::vector<Stretch> hidden_;  // sorted
};

}  // namespace

std::vector<ShadowEdge> find_shadow_edges(std::span<const ShadowEvent> events,
                                          std::span<const ShadowReceiver> receivers) {
  constexpr std::size_t kBlock = 128;
  const std::size_t blocks = (events.size() + kBlock - 1) / kBlock;
  std::vector<std::vector<ShadowEdge>> found(blocks);
  parallel_for(blocks, {}, [&](std::size_t block) {
    EventTracer tracer(receivers, found[block]);
    const std::size_t first = block * kBlock;
    for (const ShadowEvent& event :
         events.subspan(first, std::min(kBlock, events.size() - first))) {
      tracer.trace(event);
    }
  });
  std::size_t count = 0;
  for (const std::vector<ShadowEdge>& f : found) count += f.size();
  std::vector<ShadowEdge> all;
  all.reserve(count);
  for (const std::vector<ShadowEdge>& f : found) all.insert(all.end(), f.begin(), f.end());
  return all;
}

std::vector<ShadowEvent> transform(const Affine3d& world_from_blocker,
                                   std::span<const ShadowEvent> events) {
  std::vector<ShadowEvent> out;
  out.reserve(events.size());
  for (const ShadowEvent& e : events) out.push_back(transform(world_from_blocker, e));
  return out;
}

}  // namespace arris
