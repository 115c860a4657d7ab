// corner_lights.h — which lights reach what a uniform region shows, by the paper's rule
// What       For a region that is uniform for the eye, each light's pyramid (light_pyramid.h) has a list of what may
//            stand in it. The light is (§2.2)
//            lit       the list is empty; or the four shadow rays find nothing, and meet the list alike
//            shadowed  they find the same surface first, and meet the list alike
//            open      else: the region's parts test it again, with what is left of the list.
//            Lights behind a surface count as lit: they do nothing there.
// Guarantee  none: see docs/beam.md for where the rule fails
// Limits     surfaces of leaves that are not convex have no pyramids; of more than 32 lights, the first
// Cost       a list for each surface and light of a tile, a part of it for each region. Not for several threads.
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §2.2
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "beam/light_pyramid.h"
#include "beam/ray_sight.h"
#include "beam/uniform_rule.h"

namespace arris {

// Bits by light, as in PixelSurface.
struct RegionLights {
  struct Open {
    std::uint32_t light = 0;
    std::shared_ptr<const std::vector<BeamPart>> list;
    std::optional<std::array<bool, 4>> reaches;  // each corner, by a ray of its own
  };
  std::uint32_t lit = 0, known = 0;
  std::vector<Open> open;

  void decide(std::uint32_t light, bool is_lit) {
    known |= 1U << light;
    if (is_lit) lit |= 1U << light;
  }
};

// Of one tile.
class CornerLights {
 public:
  // `tile`: the eye's rays through its corners. `solids` and `lights` must outlive it.
  CornerLights(std::span<const BeamSolid> solids, std::span<const LightPlace> lights,
               const std::array<Ray, 4>& tile);

  // All lights are open.
  [[nodiscard]] RegionLights start(const HitPatch& patch);
  // Tests the lights that are open in a region on a patch that is the region's, or of it.
  [[nodiscard]] RegionLights settle(const RegionLights& above, const HitPatch& patch);

  [[nodiscard]] std::uint64_t beams() const { return beams_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  using List = std::shared_ptr<const std::vector<BeamPart>>;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

  [[nodiscard]] List make_list(std::uint32_t light, const HitPatch& patch) const;
  void settle_light(const RegionLights::Open& above, const HitPatch& patch, RegionLights& out);

  std::span<const BeamSolid> solids_;
  std::span<const LightPlace> lights_;
  std::array<Ray, 4> tile_;
  UniformRule rule_;
  std::map<Key, List> lists_;  // by light and surface
  std::uint64_t beams_ = 0, rays_ = 0;
};

}  // namespace arris
