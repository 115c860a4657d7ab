// reach_chain-inl.h — which pixels of a neighbourhood can be reached without crossing an edge
// What       Reachability of two pixels is a boolean matrix of two by two: from the primary or secondary region of
//            the one to the primary or secondary region of the other. Neighbours share a side; *chaining* two steps
//            is the product of their matrices, *combining* two ways is the sum. Each of the four bits is kept as a
//            plane of bits, so that one product is 8 ANDs and 4 ORs for all the pixels of a word or vector at once.
// Guarantee  the same matrices as the paper's tables give pixel by pixel (tests/edgepoint/reach_test.cpp)
// Limits     ways go away from the pixel in both directions, as in Fig. 6, so that reachability is symmetric: the
//            twelve offsets below and right of a pixel tell all 24
// Source     Bala, Walter, Greenberg (2003), §5.2. The paper has a table of 256 entries for neighbours and another
//            for chaining, and goes pixel by pixel.
// Legend     p primary, s secondary; ps: from the first pixel's primary to the second's secondary region
//
// Included once for each kind of processor that the including file is compiled for (Highway's convention for -inl.h).
#if defined(ARRIS_EDGEPOINT_REACH_CHAIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ARRIS_EDGEPOINT_REACH_CHAIN_INL_H
#undef ARRIS_EDGEPOINT_REACH_CHAIN_INL_H
#else
#define ARRIS_EDGEPOINT_REACH_CHAIN_INL_H
#endif

#include <hwy/highway.h>

#include <array>

#include "edgepoint/reach_offsets.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {

// V: a word, or a vector of words.
template <class V>
struct ReachMatrix {
  V pp, ps, sp, ss;
};

template <class V>
HWY_INLINE ReachMatrix<V> operator*(const ReachMatrix<V>& a, const ReachMatrix<V>& b) {
  return {(a.pp & b.pp) | (a.ps & b.sp), (a.pp & b.ps) | (a.ps & b.ss),
          (a.sp & b.pp) | (a.ss & b.sp), (a.sp & b.ps) | (a.ss & b.ss)};
}
template <class V>
HWY_INLINE ReachMatrix<V> operator|(const ReachMatrix<V>& a, const ReachMatrix<V>& b) {
  return {a.pp | b.pp, a.ps | b.ps, a.sp | b.sp, a.ss | b.ss};
}
template <class V>
HWY_INLINE ReachMatrix<V> transposed(const ReachMatrix<V>& m) {
  return {m.pp, m.sp, m.ps, m.ss};
}

template <class V>
using Reach = std::array<ReachMatrix<V>, kReachOffsets>;

// Steps: right(dx, dy) and down(dx, dy) are the matrices from the pixel at that offset to its neighbour on the right,
// and to that below it. The step to the left from an offset is the transpose of right(dx − 1, dy).
template <class V, class Right, class Down>
HWY_INLINE Reach<V> chain_reach(const Right& right, const Down& down) {
  const auto left = [&](int dx, int dy) HWY_ATTR { return transposed(right(dx - 1, dy)); };
  const ReachMatrix<V> e = right(0, 0), w = left(0, 0), s = down(0, 0);
  const ReachMatrix<V> ee = e * right(1, 0), ww = w * left(-1, 0), ss = s * down(0, 1);
  const ReachMatrix<V> se = (e * down(1, 0)) | (s * right(0, 1));
  const ReachMatrix<V> sw = (w * down(-1, 0)) | (s * left(0, 1));
  const ReachMatrix<V> see = (se * right(1, 1)) | (ee * down(2, 0));
  const ReachMatrix<V> sww = (sw * left(-1, 1)) | (ww * down(-2, 0));
  const ReachMatrix<V> sse = (se * down(1, 1)) | (ss * right(0, 2));
  const ReachMatrix<V> ssw = (sw * down(-1, 1)) | (ss * left(0, 2));
  const ReachMatrix<V> ssee = (see * down(2, 1)) | (sse * right(1, 2));
  const ReachMatrix<V> ssww = (sww * down(-2, 1)) | (ssw * left(-1, 2));
  return {e, ee, sww, sw, s, se, see, ssww, ssw, ss, sse, ssee};
}

// The regions at the four corners of a pixel: whether the corner lies in the primary region, or in the secondary.
// Neither in complex pixels, so that nothing passes through them.
template <class V>
struct CornerRegions {
  V primary, secondary;
};

// Two pixels with a common side, whose ends are corners of both (§5.2, "Neighbor reachability"): what the first has
// at an end touches what the second has there, and edges cross the side between the ends if at all.
template <class V>
HWY_INLINE ReachMatrix<V> reach_across(const CornerRegions<V>& a0, const CornerRegions<V>& a1,
                                       const CornerRegions<V>& b0, const CornerRegions<V>& b1) {
  return {(a0.primary & b0.primary) | (a1.primary & b1.primary),
          (a0.primary & b0.secondary) | (a1.primary & b1.secondary),
          (a0.secondary & b0.primary) | (a1.secondary & b1.primary),
          (a0.secondary & b0.secondary) | (a1.secondary & b1.secondary)};
}

}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
