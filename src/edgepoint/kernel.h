// kernel.h — how much a sample counts at a distance
// What       A Gaussian of standard deviation 1 pixel.
// Source     Bala, Walter, Greenberg (2003), §5.3, Fig. 6, over the 5 × 5 neighbourhood. Theirs is a picture only, and
//            sharply peaked in the centre so that little is smeared over edges. Edges stop ours, and between them the
//            wider kernel errs less (docs/edge-point.md).
#pragma once

#include <array>
#include <cstddef>

namespace arris {

// By |dx| and |dy|.
inline constexpr std::array<std::array<float, 3>, 3> kKernel{
    {{1.0F, 0.6065F, 0.1353F}, {0.6065F, 0.3679F, 0.0821F}, {0.1353F, 0.0821F, 0.0183F}}};

constexpr float kernel_weight(int dx, int dy) {
  return kKernel[std::size_t(dy < 0 ? -dy : dy)][std::size_t(dx < 0 ? -dx : dx)];
}

}  // namespace arris
