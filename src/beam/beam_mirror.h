// beam_mirror.h — what a beam sees in mirrors and through glass
// What       A flat mirror shows the scene as an eye behind it would see it, at the eye's mirrored place: the rays have
//            one apex again, so that the same look tells what is seen in it, and the signs it depends on go on below
//            the mirror's node. What a curved mirror shows, or clear glass, is looked at by a bundle of rays
//            (ray_bundle.h), and so is what is seen in turn in any mirror after it: level by level, in a tree of beams,
//            of which each hands what it may meet to its parts. Of glass it is what it lets through, or reflects
//            totally, that is looked at.
// Guarantee  as that of the look, for surfaces, not for their light. A flat mirror's eye is rounded
//            (tests/beam/beam_mirror_test.cpp)
// Limits     at most kMostMirrors in one another. Leaves that are seen as a whole stay open.
// Cost       flat: one look for each mirror in a region; views and lists are made once for each tile. Curved: parts of
//            a pixel and less, where bundles are close enough
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §3, whose
//            volumes bound what any surface reflects; P. Heckbert and P. Hanrahan, "Beam Tracing Polygonal Objects",
//            1984: flat mirrors are exact
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "beam/ray_bundle.h"
#include "beam/region_look.h"

namespace arris {

inline constexpr std::size_t kMostMirrors = 6;

// What a surface does to all rays that meet it.
struct Optics {
  enum class Kind : std::uint8_t { scatters, reflects, refracts };
  Kind kind = Kind::scatters;
  double relative_ior = 1;  // refracts: of the side where rays come from, to that of the other
};
using OpticsOf = std::function<Optics(const SeenSurface&)>;

// A surface on the way to what is seen, from the eye on.
struct MirrorLink {
  SeenSurface seen;
  bool refracted = false;  // else reflected
  double relative_ior = 1;
};
using MirrorChain = std::vector<MirrorLink>;

// What one tile sees in mirrors. For one thread.
class MirrorLists {
 public:
  explicit MirrorLists(const Rect& tile) : tile_(tile) {}

  // LookNode::mirrors, which is not 0.
  [[nodiscard]] const MirrorChain& chain(std::uint32_t mirrors) const {
    return lists_[mirrors - 1].chain;
  }

 private:
  friend class MirrorLooker;
  // Of flat mirrors only: the last one's eye, and what it may see of the tile.
  struct FlatView {
    EyeRays eye;
    BeamView view;
    std::vector<BeamPart> parts;
  };
  // What the rays of a part of the picture may meet.
  struct Level {
    Rect rect;
    std::vector<BeamPart> parts;
  };
  struct List {
    MirrorChain chain;
    std::optional<FlatView> flat;
    std::vector<Level> levels;  // each within the one before; of bundles
  };
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t,
                         BeamSurface::Root, bool, bool>;
  Rect tile_;
  std::vector<List> lists_;
  // Mirrors so far, solid, leaf, face, root, entering, refracted: the list's number + 1.
  std::map<Key, std::uint32_t> known_;
};

class MirrorLooker {
 public:
  // `solids` must outlive it. No function: there are no mirrors.
  MirrorLooker(std::span<const BeamSolid> solids, const EyeRays& eye, OpticsOf optics);

  // Does it reflect or refract all light?
  [[nodiscard]] bool is_mirror(const LookNode& node) const;
  // Replaces mirrors by what is seen in them. False: a smaller rectangle may tell more; mirrors that could not be
  // looked into stay. Regions looked at are added to `regions`.
  bool add_mirrors(LookTree& tree, const Rect& rect, MirrorLists& lists,
                   std::uint64_t& regions) const;

 private:
  // Nothing: some rays may do this, some that.
  [[nodiscard]] std::optional<MirrorLink> link_of(const LookNode& mirror, const Rect& rect,
                                                  const MirrorLists& lists) const;
  [[nodiscard]] std::uint32_t list_for(std::uint32_t mirrors, const MirrorLink& link,
                                       MirrorLists& lists) const;
  [[nodiscard]] MirrorLists::FlatView make_flat(const EyeRays& eye, const SeenSurface& mirror,
                                                const Rect& tile) const;
  // Nothing: no bundle holds the rays.
  [[nodiscard]] std::optional<LookTree> look_into(MirrorLists::List& list, const Rect& rect,
                                                  const Rect& tile) const;
  [[nodiscard]] std::optional<LookTree> look_by_bundle(MirrorLists::List& list, const Rect& rect,
                                                       const Rect& tile) const;
  [[nodiscard]] std::optional<RayBundle> bundle_of(const MirrorChain& chain,
                                                   const Rect& rect) const;
  // What of all solids the bundle's rays may meet.
  [[nodiscard]] std::vector<BeamPart> parts_near(const RayBundle& bundle) const;

  std::span<const BeamSolid> solids_;
  EyeRays eye_;
  OpticsOf optics_;
};

}  // namespace arris
