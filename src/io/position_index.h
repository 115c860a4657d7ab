// position_index.h — corners with equal positions share one vertex
// What       gives each distinct position a number, in the order of their first appearance
// Guarantee  deterministic; -0 equals 0. Positions made to collide in the hash cost bounded time:
// past
//            kMaxProbes they are kept apart, which preparation's welding mends
// Cost       constant per position; 12 bytes per distinct position and 8 to 16 of table
#pragma once

#include <cstdint>
#include <vector>

#include "arris/math.h"

namespace arris {

class PositionIndex {
 public:
  // `expected`: how many positions will be added at most; an upper bound, no more memory than
  // needed is taken at once.
  explicit PositionIndex(std::size_t expected = 0);

  // The number of this position, which is finite.
  std::uint32_t add(Vec3f position);
  // Brings the table's place for a position that will be added soon into the cache.
  void prefetch(Vec3f position) const;

  std::vector<Vec3f> take_positions() { return std::move(positions_); }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t(0);
  static constexpr std::size_t kMaxProbes = 64;

  void grow();
  [[nodiscard]] std::size_t slot_of(Vec3f position) const;

  std::vector<Vec3f> positions_;
  std::vector<std::uint32_t> slots_;  // power of two, at most half full
  int shift_ = 0;                     // 64 - log2(slots_.size())
};

}  // namespace arris
