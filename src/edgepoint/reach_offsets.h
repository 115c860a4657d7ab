// reach_offsets.h — the neighbours whose reachability is kept
// Source     Bala, Walter, Greenberg (2003), §5.2: the masks have 24 bits; as reachability is symmetric, half of them
//            tell all
#pragma once

#include <array>
#include <cstddef>

namespace arris {

struct ReachOffset {
  int dx, dy;
};
inline constexpr std::size_t kReachOffsets = 12;
inline constexpr std::array<ReachOffset, kReachOffsets> kReachOffset{{{1, 0},
                                                                      {2, 0},
                                                                      {-2, 1},
                                                                      {-1, 1},
                                                                      {0, 1},
                                                                      {1, 1},
                                                                      {2, 1},
                                                                      {-2, 2},
                                                                      {-1, 2},
                                                                      {0, 2},
                                                                      {1, 2},
                                                                      {2, 2}}};

}  // namespace arris
