#include "edgepoint/reach_planes.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/reach_planes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"
#include "edgepoint/reach_chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// The corners of the pixels at an offset of kShift.
template <int kShift>
HWY_INLINE CornerRegions<WordVector> corner(const CornerPlanes& planes, std::size_t which, int y,
                                            int i) {
  return {shifted_words<kShift>(planes.primary[which].row(y), i),
          shifted_words<kShift>(planes.secondary[which].row(y), i)};
}

template <int kShift>
HWY_INLINE ReachMatrix<WordVector> right_of(const CornerPlanes& planes, int y, int i) {
  return reach_across(corner<kShift>(planes, 1, y, i), corner<kShift>(planes, 2, y, i),
                      corner<kShift + 1>(planes, 0, y, i), corner<kShift + 1>(planes, 3, y, i));
}
template <int kShift>
HWY_INLINE ReachMatrix<WordVector> below(const CornerPlanes& planes, int y, int i) {
  return reach_across(corner<kShift>(planes, 3, y, i), corner<kShift>(planes, 2, y, i),
                      corner<kShift>(planes, 0, y + 1, i), corner<kShift>(planes, 1, y + 1, i));
}

void find_reach_rows(const CornerPlanes& corners, RowBand band, ReachPlanes& reach) {
  const WordLanes d;
  const int words = corners.primary[0].words(), step = int(hn::Lanes(d));
  for (int y = band.first; y < band.last; ++y) {
    for (int i = 0; i < words; i += step) {
      // chain_reach() asks for constant offsets only; these become constants when it is inlined.
      const auto right = [&](int dx, int dy) HWY_ATTR {
        switch (dx) {
          case -2:
            return right_of<-2>(corners, y + dy, i);
          case -1:
            return right_of<-1>(corners, y + dy, i);
          case 0:
            return right_of<0>(corners, y + dy, i);
          default:
            return right_of<1>(corners, y + dy, i);
        }
      };
      const auto down = [&](int dx, int dy) HWY_ATTR {
        switch (dx) {
          case -2:
            return below<-2>(corners, y + dy, i);
          case -1:
            return below<-1>(corners, y + dy, i);
          case 0:
            return below<0>(corners, y + dy, i);
          case 1:
            return below<1>(corners, y + dy, i);
          default:
            return below<2>(corners, y + dy, i);
        }
      };
      const Reach<WordVector> found = chain_reach<WordVector>(right, down);
      for (std::size_t k = 0; k < kReachOffsets; ++k) {
        hn::StoreU(found[k].pp, d, reach.planes[k].row(y) + i);
      }
    }
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(find_reach_rows);

void find_reach(const CornerPlanes& corners, RowBand band, ReachPlanes& reach) {
  HWY_DYNAMIC_DISPATCH(find_reach_rows)(corners, band, reach);
}

}  // namespace arris
#endif
