// reach_planes.h — reachability of the 5 × 5 neighbourhood of every pixel
// In         the regions at the corners of all pixels
// Out        for each pixel the twelve offsets of kReachOffset, a plane each: 1.5 bytes a pixel and margins, at most 3
//            from 512 pixels a row on (the paper: 3)
// Cost       about 500 operations on vectors of words for each word of a row; rows are independent
// Source     reach_chain-inl.h
#pragma once

#include <array>
#include <cstddef>

#include "edgepoint/bit_plane.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/reach_offsets.h"

namespace arris {

// Of each pixel's corners, clockwise from the upper left: primary, and secondary.
struct CornerPlanes {
  std::array<BitPlane, 4> primary, secondary;

  CornerPlanes() = default;
  CornerPlanes(int width, int height) {
    primary.fill(BitPlane(width, height));
    secondary.fill(BitPlane(width, height));
  }
};

struct ReachPlanes {
  std::array<BitPlane, kReachOffsets> planes;

  ReachPlanes() = default;
  ReachPlanes(int width, int height) { planes.fill(BitPlane(width, height)); }

  // offset: a place in kReachOffset.
  [[nodiscard]] bool at(std::size_t offset, int x, int y) const { return planes[offset].at(x, y); }
};

// Fills the rows of a band. Corners must be known kRowMargin rows beyond it.
void find_reach(const CornerPlanes& corners, RowBand band, ReachPlanes& reach);

}  // namespace arris
