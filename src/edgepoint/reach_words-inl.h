// reach_words-inl.h — reachability of a vector of words of pixels, of the planes of their corners
// In         row_of(plane, y): where row y of a plane lies
//
// Included once for each kind of processor that the including file is compiled for (Highway's convention for -inl.h).
#if defined(ARRIS_EDGEPOINT_REACH_WORDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ARRIS_EDGEPOINT_REACH_WORDS_INL_H
#undef ARRIS_EDGEPOINT_REACH_WORDS_INL_H
#else
#define ARRIS_EDGEPOINT_REACH_WORDS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "edgepoint/bit_lanes-inl.h"
#include "edgepoint/reach_chain-inl.h"
#include "edgepoint/reach_planes.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {

// The corners of the pixels at an offset of kShift.
template <int kShift, class RowOf>
HWY_INLINE CornerRegions<WordVector> corner(const CornerPlanes& planes, const RowOf& row_of,
                                            std::size_t which, int y, int i) {
  return {shifted_words<kShift>(row_of(planes.primary[which], y), i),
          shifted_words<kShift>(row_of(planes.secondary[which], y), i)};
}

template <int kShift, class RowOf>
HWY_INLINE ReachMatrix<WordVector> right_of(const CornerPlanes& planes, const RowOf& row_of, int y,
                                            int i) {
  return reach_across(
      corner<kShift>(planes, row_of, 1, y, i), corner<kShift>(planes, row_of, 2, y, i),
      corner<kShift + 1>(planes, row_of, 0, y, i), corner<kShift + 1>(planes, row_of, 3, y, i));
}
template <int kShift, class RowOf>
HWY_INLINE ReachMatrix<WordVector> below(const CornerPlanes& planes, const RowOf& row_of, int y,
                                         int i) {
  return reach_across(
      corner<kShift>(planes, row_of, 3, y, i), corner<kShift>(planes, row_of, 2, y, i),
      corner<kShift>(planes, row_of, 0, y + 1, i), corner<kShift>(planes, row_of, 1, y + 1, i));
}

// Of the words of row y from i on.
template <class RowOf>
HWY_INLINE Reach<WordVector> reach_of_words(const CornerPlanes& corners, const RowOf& row_of, int y,
                                            int i) {
  // chain_reach() asks for constant offsets only; these become constants when it is inlined.
  const auto right = [&](int dx, int dy) HWY_ATTR {
    switch (dx) {
      case -2:
        return right_of<-2>(corners, row_of, y + dy, i);
      case -1:
        return right_of<-1>(corners, row_of, y + dy, i);
      case 0:
        return right_of<0>(corners, row_of, y + dy, i);
      default:
        return right_of<1>(corners, row_of, y + dy, i);
    }
  };
  const auto down = [&](int dx, int dy) HWY_ATTR {
    switch (dx) {
      case -2:
        return below<-2>(corners, row_of, y + dy, i);
      case -1:
        return below<-1>(corners, row_of, y + dy, i);
      case 0:
        return below<0>(corners, row_of, y + dy, i);
      case 1:
        return below<1>(corners, row_of, y + dy, i);
      default:
        return below<2>(corners, row_of, y + dy, i);
    }
  };
  return chain_reach<WordVector>(right, down);
}

}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
