// shadow_finder.h — shadow edges of a scene, found for what is seen and kept while nothing moves
// What       The shader tells which object stands between a point that it shades and a light: a triple of light,
//            blocker and receiver. For each pair of light and blocker the finder keeps the events, and what of them is
//            on which receiver, clipped against each other: a new receiver adds its edges and hides others. What a move
//            changes is found again.
// Guarantee  the same triples give the same edges in the same order, however they come, once update() has returned
//            true, at any number of threads (tests/render/shadow_finder_test.cpp); before point-like
//            lights visibility changes only along found edges (tests/render/rounded_shadow_test.cpp)
// Limits     solids of solids cast shadows before point-like lights only (and see csg_shadows.h). Lights are the
//            scene's own and the sun, not what emits by material. Where receivers are rounded, edges lie on their sharp
//            faces, and may go on to what is beyond. Shadows of area lights begin at sharp edges, also where the
//            blocker is rounded. The work of one update is bounded: what does not fit waits for the next.
// Source     Bala, Walter, Greenberg (2003), §6.3 to §6.5
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "edgepoint/edge_raster.h"
#include "edgepoint/shadow_edges.h"
#include "render/edge_objects.h"
#include "render/prepared_scene.h"

namespace arris {

// Lights by number: the scene's own in their order, then the suns of its environment.
struct ShadowTriple {
  std::uint32_t light = 0, blocker = 0, receiver = 0;

  friend auto operator<=>(const ShadowTriple&, const ShadowTriple&) = default;
};

using ShadowLight = std::variant<HomogeneousPoint, ParallelogramLight>;
std::vector<ShadowLight> shadow_lights(const PreparedScene& prepared);

class ShadowFinder {
 public:
  void add(std::span<const ShadowTriple> triples);
  // What has moved since the last update.
  void object_moved(std::uint32_t object);
  void light_moved(std::uint32_t light);
  void all_changed();

  // Finds what is missing, up to about so many events; false if some of it waits.
  bool update(const PreparedScene& scene, const EdgeObjects& objects, std::size_t most_events);
  // To be kept: the next update leaves them alone.
  [[nodiscard]] std::shared_ptr<const std::vector<SoftEdge>> edges() const { return edges_; }

 private:
  struct Pair {
    std::set<std::uint32_t> receivers, added;  // that are known; of these, those that wait
    TracedEvents traced;                       // in the world
    std::map<std::uint32_t, std::vector<SoftEdge>> on_solids;  // by receiver
    bool events_known = false;
    bool receivers_known = false;  // but for those added: else all are found anew

    [[nodiscard]] bool is_known() const { return events_known && receivers_known && added.empty(); }
  };
  using Key = std::pair<std::uint32_t, std::uint32_t>;  // light, blocker

  // False if the pair can have no events.
  static bool find_events(const PreparedScene& scene, const EdgeObjects& objects,
                          const ShadowLight& light, std::uint32_t blocker, Pair& pair);
  static void find_edges(const PreparedScene& scene, const EdgeObjects& objects,
                         std::uint32_t blocker, Pair& pair);
  void gather_edges();

  std::map<Key, Pair> pairs_;
  Key next_{};  // where the next update begins, so that each comes in turn
  std::shared_ptr<const std::vector<SoftEdge>> edges_ =
      std::make_shared<const std::vector<SoftEdge>>();
};

// Between two scenes of the same objects.
struct LightChanges {
  // Of the light that changes most, also of such as cast no shadow edges: 0 to 1, what
  // part of it changes, or how far it moves in quarters of the distance from the camera to what it looks at.
  double amount = 0;
  bool renumbered = false;  // they are of another number
  std::vector<std::uint32_t> moved;
};
LightChanges find_changed_lights(const Scene& before, const Scene& after);

}  // namespace arris
