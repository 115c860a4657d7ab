// beam_shadow.h — which parts of what a beam sees are lit
// What       For a flat surface that a beam sees, the rays from a light to its points are a beam, too: linear in the
//            picture's x and y (beam_view.h). The same look from the light tells where that surface is the first that
//            the light meets; the signs it depends on go on below the surface's node.
// Guarantee  where a node's lit_known has a light's bit, its lit has it exactly where the light reaches the surface.
//            Lights behind a surface count as lit: they do nothing there (tests/beam/beam_shadow_test.cpp)
// Limits     curved surfaces stay unknown, and so do facets of meshes that have many: their shadows are for rays
// Cost       one look for each flat surface and light in a region; lists of what may cast shadows are made once for
//            each tile
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "beam/region_look.h"

namespace arris {

// What may stand between lights and the surfaces that one tile sees. For one thread.
class ShadowLists {
 public:
  explicit ShadowLists(const Rect& tile) : tile_(tile) {}

 private:
  friend class ShadowLooker;
  // light, solid, plane, leaf
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
  struct List {
    BeamView view;
    std::vector<BeamPart> parts;
  };
  Rect tile_;
  std::map<Key, List> lists_;
};

class ShadowLooker {
 public:
  static constexpr std::size_t kMostJointLights = 4;

  // Surfaces for which light does nothing.
  using Unlit = std::function<bool(const LookNode&)>;

  // `solids` and `lights` must outlive it.
  ShadowLooker(std::span<const BeamSolid> solids, const EyeRays& eye,
               std::span<const LightPlace> lights);

  // Few lights are looked at together: which of them reach a point is one question. The shadows of many would cut the
  // picture into too many pieces: how much each of them lights is asked for one by one.
  [[nodiscard]] bool is_joint() const { return lights_.size() <= kMostJointLights; }
  [[nodiscard]] std::uint32_t light_count() const { return std::uint32_t(lights_.size()); }

  // Adds signs and bits to the tree's flat surfaces, if lights are joint. False: a smaller rectangle may tell more.
  // Regions looked at are added to `regions`.
  bool add_shadows(LookTree& tree, const Rect& rect, ShadowLists& lists, std::uint64_t& regions,
                   const Unlit& unlit = {}) const;
  // Those of one light; its bit is the lowest.
  bool add_shadow(LookTree& tree, const Rect& rect, std::uint32_t light, ShadowLists& lists,
                  std::uint64_t& regions, const Unlit& unlit = {}) const;

 private:
  [[nodiscard]] std::vector<std::uint32_t> find_lit(const LookTree& tree, const Unlit& unlit) const;
  // Replaces `surfaces` by the ends below them.
  bool add_light(LookTree& tree, const Rect& rect, std::uint32_t light, std::uint32_t bit,
                 std::vector<std::uint32_t>& surfaces, ShadowLists& lists,
                 std::uint64_t& regions) const;
  [[nodiscard]] Sign side_of_light(LitPlane lit, std::uint32_t light) const;
  // Nothing: the light is behind the plane.
  [[nodiscard]] std::optional<LookTree> look_from_light(LitPlane lit, std::uint32_t leaf,
                                                        std::uint32_t light, const Rect& rect,
                                                        ShadowLists& lists) const;
  const ShadowLists::List& list_for(LitPlane lit, std::uint32_t leaf, std::uint32_t light,
                                    ShadowLists& lists) const;
  [[nodiscard]] Box3d box_of_target(std::uint32_t solid, std::uint32_t leaf,
                                    const Rect& tile) const;
  // What of a solid lies between the light and the box.
  [[nodiscard]] CsgExpression root_in_shaft(std::uint32_t solid, const Box3d& target,
                                            std::uint32_t light) const;

  std::span<const BeamSolid> solids_;
  EyeRays eye_;
  std::span<const LightPlace> lights_;
  double reach_ = 0;
};

}  // namespace arris
