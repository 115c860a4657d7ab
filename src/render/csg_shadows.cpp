#include "render/csg_shadows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel_for.h"

namespace arris {
namespace {

// A step along an event, in parts of the solid's size.
constexpr double kStep = 1.0 / 64;
constexpr int kMostSteps = 128;
// Where one face follows another: halvings of a step.
constexpr int kHalvings = 8;
// Steps in which the place jumps by more than so many of their length show two surfaces.
constexpr double kJump = 8;
// What is nearer to the beginning than so many CellProbe::reach() is the blocker's own surface.
constexpr double kBeside = 100;

struct Place {
  double s = 0;
  std::optional<CsgSurfacePoint> met;
};

bool is_same_face(const Place& a, const Place& b) {
  return a.met && b.met && a.met->leaf == b.met->leaf && a.met->face == b.met->face;
}

struct SolidEdge {
  Vec3d a, b, penumbra;
  ShadowKind kind = ShadowKind::hard;
};

class EventOnSolid {
 public:
  // In the tree's space.
  EventOnSolid(const ShadowEvent& event, const CellProbe& probe, std::vector<SolidEdge>& out)
      : event_(event), probe_(probe), out_(out) {}

  void trace() {
    const double size = kStep * probe_.size();
    const double along = length(event_.origin[1] - event_.origin[0]);
    const int steps = std::clamp(int(std::ceil(along / size)), 2, kMostSteps);
    Place last = place(0);
    for (int i = 1; i <= steps; ++i) {
      const Place next = place(double(i) / steps);
      add_step(last, next);
      last = next;
    }
  }

 private:
  [[nodiscard]] Place place(double s) const {
    const Vec3d p = origin(s);
    const HomogeneousPoint& light = event_.light[0];
    const Vec3d d = normalize(light.w > 0 ? p - light.xyz / light.w : -light.xyz);
    return {s, probe_.first_met({p, d}, kBeside * probe_.reach())};
  }
  void add_step(Place a, Place b) {
    if (is_same_face(a, b)) return add(a, b);
    if (!a.met && !b.met) return;
    // The last places that are like the two ends.
    Place low = a, high = b;
    for (int i = 0; i < kHalvings; ++i) {
      const Place middle = place((low.s + high.s) / 2);
      const bool like_a = a.met ? is_same_face(a, middle) : !middle.met;
      (like_a ? low : high) = middle;
    }
    if (is_same_face(a, low)) add(a, low);
    if (is_same_face(high, b)) add(high, b);
  }
  void add(const Place& a, const Place& b) {
    const double way = (b.s - a.s) * length(event_.origin[1] - event_.origin[0]);
    const double jump = std::abs(b.met->t - a.met->t);
    if (a.s < b.s && jump <= kJump * std::max(way, kStep * probe_.size())) {
      out_.push_back({a.met->position, b.met->position, penumbra_between(a, b), event_.kind});
    }
  }
  // As wide, in parts of the light, as the solid is far from the blocker, in parts of the blocker's distance from it.
  [[nodiscard]] Vec3d penumbra_between(const Place& a, const Place& b) const {
    if (event_.kind == ShadowKind::hard) return {};
    const Vec3d light = event_.light[0].xyz / event_.light[0].w;
    const auto part = [&](const Place& p) { return p.met->t / length(origin(p.s) - light); };
    return -event_.across * ((part(a) + part(b)) / 2);
  }
  [[nodiscard]] Vec3d origin(double s) const {
    return event_.origin[0] + (event_.origin[1] - event_.origin[0]) * s;
  }

  const ShadowEvent& event_;
  const CellProbe& probe_;
  std::vector<SolidEdge>& out_;
};

}  // namespace

std::vector<SoftEdge> find_edges_on_solid(std::span<const ShadowEvent> events,
                                          const CsgEdges& solid, const Affine3d& world) {
  constexpr std::size_t kBlock = 32;
  const Affine3d object_from_world = inverse(world);
  const std::size_t blocks = (events.size() + kBlock - 1) / kBlock;
  std::vector<std::vector<SolidEdge>> found(blocks);
  parallel_for(blocks, {}, [&](std::size_t block) {
    const std::size_t first = block * kBlock;
    for (const ShadowEvent& event :
         events.subspan(first, std::min(kBlock, events.size() - first))) {
      if (event.is_at_vertex()) continue;
      const ShadowEvent own = transform(object_from_world, event);
      EventOnSolid(own, solid.probe(), found[block]).trace();
    }
  });
  std::vector<SoftEdge> edges;
  for (const std::vector<SolidEdge>& some : found) {
    for (const SolidEdge& s : some) {
      edges.push_back({{Vec3f(transform_point(world, s.a)), Vec3f(transform_point(world, s.b))},
                       Vec3f(transform_vector(world, s.penumbra)),
                       s.kind == ShadowKind::umbral});
    }
  }
  return edges;
}

}  // namespace arris
