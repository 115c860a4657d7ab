#include "edgepoint/subpixel_reach.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/subpixel_reach.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/reach_words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE const std::uint64_t* ring_row(const BitPlane& plane, int row) {
  return plane.row(subpixel_ring(row));
}

// Whether any pixel is wanted whose subpixels are those of some words, of which two are of one word of pixels.
HWY_INLINE bool is_wanted(std::span<const std::uint64_t> wanted, std::size_t first,
                          std::size_t count) {
  const std::size_t last = std::min((first + count + 1) / 2, wanted.size());
  std::uint64_t any = 0;
  for (std::size_t i = first / 2; i < last; ++i) any |= wanted[i];
  return any != 0;
}

void find_reach(const SubpixelPlanes& planes, int row, std::span<const std::uint64_t> wanted,
                SubpixelReach& reach) {
  const WordLanes d;
  const int words = planes.known.words(), step = int(hn::Lanes(d)), to = subpixel_ring(row);
  const auto row_of = [](const BitPlane& plane, int y) HWY_ATTR { return ring_row(plane, y); };
  for (int i = 0; i < words; i += step) {
    if (!is_wanted(wanted, std::size_t(i), std::size_t(step))) continue;
    const Reach<WordVector> found = reach_of_words(planes.corners, row_of, row, i);
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      hn::StoreU(found[k].pp, d, reach.offsets[k].pp.row(to) + i);
      hn::StoreU(found[k].ps, d, reach.offsets[k].ps.row(to) + i);
      hn::StoreU(found[k].sp, d, reach.offsets[k].sp.row(to) + i);
    }
  }
}

// Of a vector of words of a row: for each tap the subpixels that it counts for.
using TapWords = std::array<std::array<std::uint64_t, kVectorWords>, kSubpixelTaps>;
struct TapMasks {
  TapWords primary, secondary;
};

template <std::size_t... kTap>
HWY_INLINE void find_masks(const SubpixelPlanes& planes, const SubpixelReach& reach, int row,
                           int word, TapMasks& out, std::index_sequence<kTap...> /*taps*/) {
  const WordLanes d;
  const auto add = [&](auto tap) HWY_ATTR {
    constexpr std::size_t kIndex = decltype(tap)::value;
    constexpr ReachOffset kOffset = subpixel_tap(kIndex);
    const WordVector known =
        shifted_words<kOffset.dx>(ring_row(planes.known, row + kOffset.dy), word);
    WordVector primary = known, secondary = hn::Zero(d);
    if constexpr (kIndex % 2 == 1) {
      const SubpixelReach::Planes& from = reach.offsets[(kIndex - 1) / 2];
      primary = hn::And(known, hn::LoadU(d, ring_row(from.pp, row) + word));
      secondary = hn::And(known, hn::LoadU(d, ring_row(from.sp, row) + word));
    } else if constexpr (kIndex > 0) {
      // The opposite of an offset is known where it starts.
      const SubpixelReach::Planes& to = reach.offsets[(kIndex - 1) / 2];
      const int start = row + kOffset.dy;
      primary = hn::And(known, shifted_words<kOffset.dx>(ring_row(to.pp, start), word));
      secondary = hn::And(known, shifted_words<kOffset.dx>(ring_row(to.ps, start), word));
    }
    hn::StoreU(primary, d, out.primary[kIndex].data());
    hn::StoreU(secondary, d, out.secondary[kIndex].data());
  };
  (add(std::integral_constant<std::size_t, kTap>()), ...);
}

// From a mask of subpixels for each tap to one of taps for each subpixel: of those of a word from bit `first` on, as
// many as vectors have lanes.
template <class Tag>
HWY_INLINE void transpose(Tag d, const TapWords& masks, std::size_t word, unsigned first,
                          std::uint32_t* out) {
  auto taps = hn::Zero(d);
  for (std::size_t k = 0; k < kSubpixelTaps; ++k) {
    const auto mask = mask_from(d, masks[k][word], first);
    taps = hn::Or(taps, hn::IfThenElseZero(mask, hn::Set(d, 1U << unsigned(k))));
  }
  hn::StoreU(taps, d, out);
}

void find_taps(const SubpixelPlanes& planes, const SubpixelReach& reach, int row,
               std::span<const std::uint64_t> wanted, SubpixelTaps taps) {
  constexpr auto kAll = std::make_index_sequence<kSubpixelTaps>();
  const hn::CappedTag<std::uint32_t, 16> d;
  const auto step = hn::Lanes(WordLanes()), lanes = hn::Lanes(d);
  const auto words = std::size_t(planes.known.words());
  TapMasks masks;
  for (std::size_t word = 0; word < words; word += step) {
    if (!is_wanted(wanted, word, step)) continue;
    find_masks(planes, reach, row, int(word), masks, kAll);
    for (std::size_t at = 64 * word; at < 64 * std::min(word + step, words); at += lanes) {
      const std::uint64_t pixels = wanted[at / 128] >> (at % 128 / 2);
      if ((pixels & ((std::uint64_t{1} << ((lanes + 1) / 2)) - 1)) == 0) continue;
      const std::size_t in_masks = at / 64 - word;
      transpose(d, masks.primary, in_masks, unsigned(at % 64), &taps.primary[at]);
      transpose(d, masks.secondary, in_masks, unsigned(at % 64), &taps.secondary[at]);
    }
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(find_reach);
HWY_EXPORT(find_taps);

void find_subpixel_reach(const SubpixelPlanes& planes, int row,
                         std::span<const std::uint64_t> wanted, SubpixelReach& reach) {
  HWY_DYNAMIC_DISPATCH(find_reach)(planes, row, wanted, reach);
}

void find_subpixel_taps(const SubpixelPlanes& planes, const SubpixelReach& reach, int row,
                        std::span<const std::uint64_t> wanted, SubpixelTaps taps) {
  HWY_DYNAMIC_DISPATCH(find_taps)(planes, reach, row, wanted, taps);
}

}  // namespace arris
#endif
