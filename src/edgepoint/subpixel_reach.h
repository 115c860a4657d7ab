// subpixel_reach.h — which subpixels count for the regions of the subpixels of complex pixels
// What       pixels' halves as pixels of planes of their own: of eight rows, which is four of pixels, what lies at the
//            corners of subpixels and whose colours are known; from which reachability and the taps of each subpixel
//            follow as for whole pixels, many at once
// Legend     row: of subpixels, two for each row of pixels; may be −2
// Cost       as reach_planes.h, where complex pixels are near
// Source     reach_chain-inl.h; Bala, Walter, Greenberg (2003), §5.4
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "edgepoint/bit_plane.h"
#include "edgepoint/reach_offsets.h"
#include "edgepoint/reach_planes.h"

namespace arris {

// Rows are the same modulo this.
inline constexpr int kSubpixelRows = 8;
constexpr int subpixel_ring(int row) {
  return row & (kSubpixelRows - 1);
}
// Of a row of pixels: two whole words of subpixels for each word of pixels.
constexpr int subpixel_width(int width_px) {
  return (width_px + 63) / 64 * 128;
}

struct SubpixelPlanes {
  CornerPlanes corners;
  BitPlane known;  // whose primary region's colour is known

  explicit SubpixelPlanes(int width_px)
      : corners(subpixel_width(width_px), kSubpixelRows),
        known(subpixel_width(width_px), kSubpixelRows) {}
};

// From each subpixel to that at each offset, from primary (p) or secondary (s) region to either.
struct SubpixelReach {
  struct Planes {
    BitPlane pp, ps, sp;
  };
  std::array<Planes, kReachOffsets> offsets;

  explicit SubpixelReach(int width_px) {
    const BitPlane plane(subpixel_width(width_px), kSubpixelRows);
    offsets.fill({plane, plane, plane});
  }
};

// A subpixel itself, then each offset of kReachOffset and its opposite.
inline constexpr std::size_t kSubpixelTaps = 1 + 2 * kReachOffsets;
constexpr ReachOffset subpixel_tap(std::size_t tap) {
  if (tap == 0) return {0, 0};
  const auto [dx, dy] = kReachOffset[(tap - 1) / 2];
  return tap % 2 == 1 ? ReachOffset{dx, dy} : ReachOffset{-dx, -dy};
}

// Of a row, for which corners must be known two rows further down. wanted: of pixels, a bit each; near others
// reachability is anything.
void find_subpixel_reach(const SubpixelPlanes& planes, int row,
                         std::span<const std::uint64_t> wanted, SubpixelReach& reach);

// Bit k: the subpixel of subpixel_tap(k) is known and its primary region is reached from the subpixel's primary or
// secondary one.
struct SubpixelTaps {
  std::span<std::uint32_t> primary, secondary;
};
// Of the subpixels of a row that are wanted. Reachability must be known of it and two rows up, a pixel around.
void find_subpixel_taps(const SubpixelPlanes& planes, const SubpixelReach& reach, int row,
                        std::span<const std::uint64_t> wanted, SubpixelTaps taps);

}  // namespace arris
