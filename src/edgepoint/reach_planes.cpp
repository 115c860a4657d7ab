#include "edgepoint/reach_planes.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/reach_planes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/reach_words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void find_reach_rows(const CornerPlanes& corners, RowBand band, ReachPlanes& reach) {
  const WordLanes d;
  const int words = corners.primary[0].words(), step = int(hn::Lanes(d));
  const auto row_of = [](const BitPlane& plane, int y) HWY_ATTR { return plane.row(y); };
  for (int y = band.first; y < band.last; ++y) {
    for (int i = 0; i < words; i += step) {
      const Reach<WordVector> found = reach_of_words(corners, row_of, y, i);
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
