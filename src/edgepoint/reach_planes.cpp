#include "edgepoint/reach_planes.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/reach_planes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/reach_chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Words = hn::ScalableTag<std::uint64_t>;
using Vector = hn::Vec<Words>;

// The words of a row from i on, as they are for the pixels kShift to the right (to the left if negative).
template <int kShift>
HWY_INLINE Vector shifted(const std::uint64_t* row, int i) {
  const Words d;
  const Vector here = hn::LoadU(d, row + i);
  if constexpr (kShift == 0) {
    return here;
  } else if constexpr (kShift > 0) {
    return hn::Or(hn::ShiftRight<kShift>(here),
                  hn::ShiftLeft<64 - kShift>(hn::LoadU(d, row + i + 1)));
  } else {
    return hn::Or(hn::ShiftLeft<-kShift>(here),
                  hn::ShiftRight<64 + kShift>(hn::LoadU(d, row + i - 1)));
  }
}

// The corners of the pixels at an offset of kShift.
template <int kShift>
HWY_INLINE CornerRegions<Vector> corner(const CornerPlanes& planes, std::size_t which, int y,
                                        int i) {
  return {shifted<kShift>(planes.primary[which].row(y), i),
          shifted<kShift>(planes.secondary[which].row(y), i)};
}

template <int kShift>
HWY_INLINE ReachMatrix<Vector> right_of(const CornerPlanes& planes, int y, int i) {
  return reach_across(corner<kShift>(planes, 1, y, i), corner<kShift>(planes, 2, y, i),
                      corner<kShift + 1>(planes, 0, y, i), corner<kShift + 1>(planes, 3, y, i));
}
template <int kShift>
HWY_INLINE ReachMatrix<Vector> below(const CornerPlanes& planes, int y, int i) {
  return reach_across(corner<kShift>(planes, 3, y, i), corner<kShift>(planes, 2, y, i),
                      corner<kShift>(planes, 0, y + 1, i), corner<kShift>(planes, 1, y + 1, i));
}

void find_reach_rows(const CornerPlanes& corners, RowBand band, ReachPlanes& reach) {
  const Words d;
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
      const Reach<Vector> found = chain_reach<Vector>(right, down);
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
