// point_cache.h — shaded points in space, of a bounded number
// What       What the shader has found, to be shown again from other places (the Render Cache). Points are kept in
//            blocks of those that arrived together: they were asked for tile by tile, so that a block covers a small
//            part of the picture and reprojecting it touches little memory. When all blocks are full, the one of
//            which least is seen makes room.
// Guarantee  the same calls leave the same points in the same places
// Cost       24 bytes a point
// Source     Walter, Drettakis, Parker, "Interactive Rendering using the Render Cache" (1999), and its successor
//            (2002); Bala, Walter, Greenberg (2003), §4.3. Theirs is one array in no order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "edgepoint/packed_normal.h"

namespace arris {

// Of points that lie on no object.
inline constexpr std::uint32_t kFarObject = 0xffffff;

// A point's number: its block's times kPointBlock, and its place there.
using PointNumber = std::uint32_t;
inline constexpr PointNumber kMostPoints = 1U << 28U;
inline constexpr PointNumber kNoPoint = ~PointNumber{0};

struct ShadedPoint {
  Vec3f position;  // in the world; of far points: the direction, unit
  Rgb radiance;
  float painted = 0;  // the part of it, 0 to 1, that goes with the base colour (tint_image.h)
  Vec3f normal;       // of the surface, on the side that was seen; 0: of all sides
  std::uint32_t object =
      kFarObject;  // the shader's number, at most kFarObject, which says that: the ray left the scene
  PointNumber replaces = kNoPoint;  // the point that was seen where this was asked for
};

// Shared exponent, nine bits a channel: 0 to 65408, a step of 1/512 of the largest channel's power of two, or of 2⁻¹⁵;
// all of it times 2^−stops, so that the range is what an exposure of so many stops shows. |stops| ≤ 64.
std::uint32_t pack_radiance(Rgb radiance, int stops = 0);
inline constexpr int kRadianceBits = 9, kRadianceBias = 15;
// Bits of a float's exponent: of 2^(− bias − bits − stops).
inline std::uint32_t radiance_exponent(int stops) {
  return std::uint32_t(127 - kRadianceBias - kRadianceBits - stops);
}
inline Rgb unpack_radiance(std::uint32_t packed, int stops = 0) {
  const float scale = std::bit_cast<float>(((packed >> 27U) + radiance_exponent(stops)) << 23U);
  return Rgb{float(packed & 511U), float(packed >> 9U & 511U), float(packed >> 18U & 511U)} * scale;
}

// Ages are counted in so many frames.
inline constexpr std::uint32_t kFramesOfAge = 16;

// What a pixel takes of its point: together, as they are read in no order.
struct PointLook {
  std::uint32_t packed_radiance = 0;
  // How much it shows what is no longer so: what its pixel wants, 256 times.
  std::uint16_t stale = 0;
  std::uint8_t born = 0;          // the frame's number / kFramesOfAge, modulo 2^8
  std::uint8_t upper_object = 0;  // of the number's 24 bits
};

// Of points, by their numbers.
class PointObjects {
 public:
  PointObjects() = default;
  PointObjects(std::span<const std::uint16_t> lower, std::span<const PointLook> looks)
      : lower_(lower), looks_(looks) {}

  [[nodiscard]] bool empty() const { return lower_.empty(); }
  [[nodiscard]] std::uint32_t operator[](PointNumber number) const {
    return lower_[number] | std::uint32_t(looks_[number].upper_object) << 16U;
  }

 private:
  std::span<const std::uint16_t> lower_;
  std::span<const PointLook> looks_;
};

inline constexpr std::uint32_t kPointBlock = 256;

// What is known of kPointBlock consecutive points.
struct PointBlock {
  std::uint32_t count = 0;           // of its points; the first of its places
  std::uint32_t seen = kPointBlock;  // of its points, in the last frame
  std::uint32_t filled = 0;          // the frame in which the first point came
  bool is_far = false;
  Vec3f lower, upper;  // of the positions
};

// What a change adds to what points' pixels want, 0 to 255, and what it makes of it at most. Changes add up, so that of
// points that are all wrong those come first that have been so for longer.
struct Staleness {
  float add = 0, most = 0;
};
// Of what has moved, or is shaded otherwise at once; little less than where nothing is known.
inline constexpr Staleness kMovedStale{160, 224};

class PointCache {
 public:
  // Of at least so many points; at most kMostPoints. stops: pack_radiance()'s. keeps_painted: a byte more a point, for
  // ShadedPoint::painted.
  explicit PointCache(std::size_t capacity, int stops = 0, bool keeps_painted = false);

  // Takes the points of one frame in, those that replace others into their places.
  void add(std::span<const ShadedPoint> points, std::uint32_t frame);
  // Moves the points of objects, and makes them kMovedStale. to_from: by object; those without value stay. Points that
  // turn are shown from all sides from then on: small turns would be lost in their normals.
  void move(std::span<const std::optional<Affine3d>> to_from);
  // Makes points stale: those for which is_stale(position) holds, of blocks for which may_hold(lower, upper) does.
  template <class MayHold, class IsStale>
  void make_stale(Staleness staleness, const MayHold& may_hold, const IsStale& is_stale);
  // All of them.
  void make_stale(Staleness staleness);

  [[nodiscard]] std::span<const PointBlock> blocks() const { return blocks_; }
  // By point number, for all blocks.
  [[nodiscard]] const float* x() const { return x_.data(); }
  [[nodiscard]] const float* y() const { return y_.data(); }
  [[nodiscard]] const float* z() const { return z_.data(); }
  [[nodiscard]] const PackedNormal* normals() const { return normal_.data(); }
  [[nodiscard]] std::span<const PointLook> looks() const { return looks_; }
  // In 255ths; empty unless asked for.
  [[nodiscard]] std::span<const std::uint8_t> painted() const { return painted_; }
  [[nodiscard]] int stops() const { return stops_; }
  [[nodiscard]] PointObjects objects() const { return {lower_object_, looks_}; }

  // How many points of each block were seen.
  void set_seen(std::span<const std::uint32_t> seen);
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  void put(PointBlock& block, PointNumber number, const ShadedPoint& point, std::uint32_t frame);
  std::size_t room_for(bool far, std::uint32_t frame);
  static void make_stale(Staleness staleness, PointLook& look) {
    const auto most = std::uint32_t(256 * staleness.most);
    const std::uint32_t more = look.stale + std::uint32_t(256 * staleness.add);
    look.stale = std::uint16_t(std::max<std::uint32_t>(look.stale, std::min(more, most)));
  }
  [[nodiscard]] Vec3f position(PointNumber number) const {
    return {x_[number], y_[number], z_[number]};
  }

  std::size_t most_blocks_;
  int stops_;
  std::vector<PointBlock> blocks_;
  std::vector<float> x_, y_, z_;
  std::vector<PackedNormal> normal_;
  std::vector<std::uint8_t> painted_;
  std::vector<PointLook> looks_;
  std::vector<std::uint16_t> lower_object_;
  std::array<std::size_t, 2> open_{};  // the block being filled: of near points, and of far ones
};

template <class MayHold, class IsStale>
void PointCache::make_stale(Staleness staleness, const MayHold& may_hold, const IsStale& is_stale) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const PointBlock& block = blocks_[b];
    if (block.is_far || block.count == 0 || !may_hold(block.lower, block.upper)) continue;
    const auto first = PointNumber(b * kPointBlock);
    for (PointNumber i = first; i < first + block.count; ++i) {
      if (is_stale(position(i))) make_stale(staleness, looks_[i]);
    }
  }
}

}  // namespace arris
