// point_cache.h — shaded points in space, of a bounded number
// What       What the shader has found, to be shown again from other places (the Render Cache). Points are kept in
//            blocks of those that arrived together: they were asked for tile by tile, so that a block covers a small
//            part of the picture and reprojecting it touches little memory. When all blocks are full, the one of
//            which least is seen makes room.
// Guarantee  the same calls leave the same points in the same places
// Cost       22 bytes a point
// Source     Walter, Drettakis, Parker, "Interactive Rendering using the Render Cache" (1999), and its successor
//            (2002); Bala, Walter, Greenberg (2003), §4.3. Theirs is one array in no order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "arris/math.h"

namespace arris {

// Of points that lie on no object.
inline constexpr std::uint32_t kFarObject = 0xffffffff;

// A point's number: its block's times kPointBlock, and its place there.
using PointNumber = std::uint32_t;
inline constexpr PointNumber kMostPoints = 1U << 28U;
inline constexpr PointNumber kNoPoint = ~PointNumber{0};

struct ShadedPoint {
  Vec3f position;  // in the world; of far points: the direction, unit
  Rgb radiance;
  std::uint32_t object = kFarObject;  // the shader's number; kFarObject: the ray left the scene
  PointNumber replaces = kNoPoint;    // the point that was seen where this was asked for
};

// Shared exponent, nine bits a channel: 0 to 65408, a step of 1/512 of the largest channel's power of two.
std::uint32_t pack_radiance(Rgb radiance);
Rgb unpack_radiance(std::uint32_t packed);

inline constexpr std::uint32_t kPointBlock = 256;

struct PointBlock {
  alignas(64) std::array<float, kPointBlock> x, y, z;
  alignas(64) std::array<std::uint32_t, kPointBlock> radiance;
  alignas(64) std::array<std::uint32_t, kPointBlock> object;
  alignas(64) std::array<std::uint16_t, kPointBlock> born;  // the frame's number, modulo 2^16
  std::uint32_t count = 0;
  std::uint32_t seen = kPointBlock;  // of its points, in the last frame
  std::uint32_t filled = 0;          // the frame in which the first point came
  bool is_far = false;
  Vec3f lower, upper;  // of the positions
};

class PointCache {
 public:
  // Of at least so many points; at most kMostPoints.
  explicit PointCache(std::size_t capacity);

  // Takes the points of one frame in, those that replace others into their places.
  void add(std::span<const ShadedPoint> points, std::uint32_t frame);
  // Moves the points of an object, and makes them old.
  void move(std::uint32_t object, const Affine3d& to_from, std::uint32_t frame);
  // Makes points old: those for which is_stale(position) holds, of blocks for which may_hold(lower, upper) does.
  template <class MayHold, class IsStale>
  void make_old(std::uint32_t frame, const MayHold& may_hold, const IsStale& is_stale);
  // Forgets all points.
  void clear();

  [[nodiscard]] std::span<const std::unique_ptr<PointBlock>> blocks() const { return blocks_; }
  [[nodiscard]] const PointBlock& block_of(PointNumber point) const {
    return *blocks_[point / kPointBlock];
  }
  [[nodiscard]] Rgb radiance_of(PointNumber point) const {
    return unpack_radiance(block_of(point).radiance[point % kPointBlock]);
  }
  // How many points of each block were seen.
  void set_seen(std::span<const std::uint32_t> seen);
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t bytes() const { return blocks_.size() * sizeof(PointBlock); }

 private:
  static void put(PointBlock& block, std::uint32_t place, const ShadedPoint& point,
                  std::uint32_t frame);
  PointBlock& room_for(bool far, std::uint32_t frame);

  std::size_t most_blocks_;
  std::vector<std::unique_ptr<PointBlock>> blocks_;
  std::array<std::size_t, 2> open_{};  // the block being filled: of near points, and of far ones
};

// The age of points that show what is no longer so; others never get as old.
inline constexpr std::uint16_t kStaleAge = 0x8000;

inline std::uint16_t age_of(const PointBlock& block, std::uint32_t place, std::uint32_t frame) {
  return std::uint16_t(frame - block.born[place]);
}

template <class MayHold, class IsStale>
void PointCache::make_old(std::uint32_t frame, const MayHold& may_hold, const IsStale& is_stale) {
  for (const std::unique_ptr<PointBlock>& block : blocks_) {
    if (block->is_far || block->count == 0 || !may_hold(block->lower, block->upper)) continue;
    for (std::uint32_t i = 0; i < block->count; ++i) {
      if (is_stale(Vec3f{block->x[i], block->y[i], block->z[i]})) {
        block->born[i] = std::uint16_t(frame - kStaleAge);
      }
    }
  }
}

}  // namespace arris
