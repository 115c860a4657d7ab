// pixel_surfaces.h — what a pixel shows, as its regions add to it
// What       One entry for each surface, or nothing, that is seen in the same mirrors and lit by the same lights;
//            bounds and estimates of the pixel's regions add up in it.
// Cost       entries are compared one by one while they are few, then found by a hash. For one thread
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "beam/beam_mirror.h"
#include "beam/region_look.h"
#include "beam/tree_area.h"

namespace arris {

// The part of a pixel's surface that a light reaches, in parts of the pixel.
struct LitShare {
  double lo = 0, hi = 0, estimate = 0;
  double open = 0;      // where it is not known, which the estimate leaves out
  double doubtful = 0;  // of that, where it was looked for
};

// What a pixel shows; nothing: what is behind all solids.
struct PixelSurface {
  std::optional<SeenSurface> seen;
  std::uint32_t lit = 0, lit_known = 0;  // by light; see beam_shadow.h
  std::vector<LitShare> lit_shares;  // by light, where lights are not looked at jointly; else empty
  double lo = 0, hi = 0, estimate = 0;  // parts of the pixel; estimates add up to 1
  Vec2d sample;                         // a point of the picture where it is seen, or may be
  double sample_weight = -1;            // the area that the sample stands for
  std::vector<AreaSample> samples;      // more of them, of curved surfaces
  std::uint32_t mirror_number = 0;      // LookNode::mirrors
  MirrorChain mirrors;                  // in which it is seen
  bool mirror_open = false;             // a mirror, and what is seen in it is not known
  bool light_open = false;              // flat, and whether a light reaches it is not known
};

class PixelSurfaces {
 public:
  // `mirrors` must outlive it. `light_count`: of the lights that are looked at one by one; 0: they are joint.
  PixelSurfaces(const MirrorLists& mirrors, std::size_t light_count)
      : mirrors_(mirrors), light_count_(light_count) {}

  void clear();
  // The entry of the surface, until another is asked for; a new one has nothing in it.
  PixelSurface& entry_of(const PixelSurface& surface);
  void add(const PixelSurface& surface);
  // What a ray says to take for what is not known.
  void add_estimate(const std::optional<SeenSurface>& seen, Vec2d sample, double estimate);
  // Bounds to [0, 1].
  void clamp_bounds();

  // In the order in which they were found.
  [[nodiscard]] const std::vector<PixelSurface>& entries() const { return entries_; }
  // The sum of hi - lo.
  [[nodiscard]] double open_area() const;
  // No bounds are wider than the tolerance, and no mirror or light is open in more than that.
  [[nodiscard]] bool is_certified(double tolerance) const;

 private:
  // Surfaces are the same by it; ~0 three times: nothing is seen.
  using Key = std::array<std::uint32_t, 6>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  static Key key_of(const PixelSurface& s);

  const MirrorLists& mirrors_;
  std::size_t light_count_;
  std::vector<PixelSurface> entries_;
  std::unordered_map<Key, std::uint32_t, KeyHash> index_;  // of entries_, where they are many
};

}  // namespace arris
