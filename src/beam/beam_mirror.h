// beam_mirror.h — what a beam sees in flat mirrors
// What       A flat mirror shows the scene as an eye behind it would see it, at the eye's mirrored place: the rays have
//            one apex again, so that the same look tells what is seen in it, and the signs it depends on go on below
//            the mirror's node. Mirrors in mirrors follow level by level.
// Guarantee  as that of the look, for surfaces, not for their light. The mirrored eye is rounded
//            (tests/beam/beam_mirror_test.cpp)
// Limits     at most kMostMirrors in one another. Curved mirrors have no single apex: they are for rays.
// Cost       one look for each mirror in a region; views and lists are made once for each tile
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §3, whose
//            volumes bound what any surface reflects; P. Heckbert and P. Hanrahan, "Beam Tracing Polygonal Objects",
//            1984: flat mirrors are exact
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "beam/region_look.h"

namespace arris {

inline constexpr std::size_t kMostMirrors = 4;

using MirrorChain = std::vector<SeenSurface>;  // from the eye on

// What one tile sees in mirrors. For one thread.
class MirrorLists {
 public:
  explicit MirrorLists(const Rect& tile) : tile_(tile) {}

  // LookNode::mirrors, which is not 0.
  [[nodiscard]] const MirrorChain& chain(std::uint32_t mirrors) const {
    return lists_[mirrors - 1].chain;
  }
  [[nodiscard]] const BeamView& view(std::uint32_t mirrors) const {
    return lists_[mirrors - 1].view;
  }
  [[nodiscard]] const EyeRays& eye(std::uint32_t mirrors) const { return lists_[mirrors - 1].eye; }

 private:
  friend class MirrorLooker;
  struct List {
    MirrorChain chain;
    EyeRays eye;
    BeamView view;
    std::vector<BeamPart> parts;
  };
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
  Rect tile_;
  std::vector<List> lists_;
  std::map<Key, std::uint32_t> known_;  // mirrors so far, solid, leaf, face: the list's number + 1
};

// Is all that this surface does to be a mirror?
using IsMirror = std::function<bool(const SeenSurface&)>;

class MirrorLooker {
 public:
  // `solids` must outlive it. No function: there are no mirrors.
  MirrorLooker(std::span<const BeamSolid> solids, const EyeRays& eye, IsMirror is_mirror);

  [[nodiscard]] bool is_mirror(const LookNode& node) const;
  // Replaces flat mirrors by what is seen in them. False: a smaller rectangle may tell more; mirrors that could not be
  // looked into stay. Regions looked at are added to `regions`.
  bool add_mirrors(LookTree& tree, const Rect& rect, MirrorLists& lists,
                   std::uint64_t& regions) const;

 private:
  [[nodiscard]] std::uint32_t list_for(const LookNode& mirror, MirrorLists& lists) const;

  std::span<const BeamSolid> solids_;
  EyeRays eye_;
  IsMirror is_mirror_;
};

}  // namespace arris
