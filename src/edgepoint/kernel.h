// kernel.h — how much a sample counts at a distance
// Source     Bala, Walter, Greenberg (2003), §5.3, Fig. 6: any filter that is sharply peaked in the centre does,
//            over the 5 × 5 neighbourhood; theirs is a picture only, so these are our own
#pragma once

#include <array>
#include <cstddef>

namespace arris {

// By |dx| and |dy|: about 2^(-2 d²) with a tail that lets a lone sample reach the corners.
inline constexpr std::array<std::array<float, 3>, 3> kKernel{
    {{1.0F, 0.25F, 0.02F}, {0.25F, 0.08F, 0.012F}, {0.02F, 0.012F, 0.004F}}};

constexpr float kernel_weight(int dx, int dy) {
  return kKernel[std::size_t(dy < 0 ? -dy : dy)][std::size_t(dx < 0 ? -dx : dx)];
}

}  // namespace arris
