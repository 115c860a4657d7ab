#include "edgepoint/interpolate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "edgepoint/kernel.h"
#include "edgepoint/reach_offsets.h"

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/interpolate.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"

#ifndef ARRIS_EDGEPOINT_INTERPOLATE_ONCE
#define ARRIS_EDGEPOINT_INTERPOLATE_ONCE
namespace arris {

// Five rows of samples around a row of pixels, where that is 2.
using SampleRows = std::array<ColorRow, 5>;

// The pixel itself, then each offset of kReachOffset and its opposite: sums are always made in this order.
inline constexpr std::size_t kTaps = 1 + 2 * kReachOffsets;
constexpr ReachOffset tap_offset(std::size_t tap) {
  if (tap == 0) return {0, 0};
  const auto [dx, dy] = kReachOffset[(tap - 1) / 2];
  return tap % 2 == 1 ? ReachOffset{dx, dy} : ReachOffset{-dx, -dy};
}

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Of a vector of words of a row: for each tap the pixels that it has a sample for within reach, and those that any has.
struct TapMasks {
  std::array<std::array<std::uint64_t, kVectorWords>, kTaps> taps;
  std::array<std::uint64_t, kVectorWords> any;
};

// Where a fresh sample is within reach, all that is not is left out. lacking: pixels that have none.
template <std::size_t... kTap>
HWY_INLINE void keep_fresh(const EdgePointImage& image, int y, int word, TapMasks& masks,
                           std::uint64_t* lacking, std::index_sequence<kTap...> /*taps*/) {
  const WordLanes d;
  WordVector any = hn::Zero(d);
  std::array<std::array<std::uint64_t, kVectorWords>, kTaps> fresh;
  const auto find = [&](auto tap) HWY_ATTR {
    constexpr std::size_t kIndex = decltype(tap)::value;
    constexpr ReachOffset kOffset = tap_offset(kIndex);
    const WordVector found =
        hn::And(hn::LoadU(d, masks.taps[kIndex].data()),
                shifted_words<kOffset.dx>(image.fresh.row(y + kOffset.dy), word));
    hn::StoreU(found, d, fresh[kIndex].data());
    any = hn::Or(any, found);
  };
  (find(std::integral_constant<std::size_t, kTap>()), ...);
  hn::StoreU(hn::Not(any), d, lacking + word);
  for (std::size_t tap = 0; tap < kTaps; ++tap) {
    const WordVector all = hn::LoadU(d, masks.taps[tap].data());
    hn::StoreU(hn::Or(hn::LoadU(d, fresh[tap].data()), hn::AndNot(any, all)), d,
               masks.taps[tap].data());
  }
}

template <std::size_t... kTap>
HWY_INLINE void find_masks(const EdgePointImage& image, int y, int word, TapMasks& out,
                           std::uint64_t* lacking, std::index_sequence<kTap...> /*taps*/) {
  const WordLanes d;
  // Complex pixels are those whose corners belong to no region.
  const WordVector complex =
      hn::Not(hn::Or(hn::LoadU(d, image.corners.primary[0].row(y) + word),
                     hn::LoadU(d, image.corners.secondary[0].row(y) + word)));
  const bool any_complex = !hn::AllFalse(d, hn::Ne(complex, hn::Zero(d)));
  WordVector any = hn::Zero(d);
  const auto add = [&](auto tap) HWY_ATTR {
    constexpr std::size_t kIndex = decltype(tap)::value;
    constexpr ReachOffset kOffset = tap_offset(kIndex);
    WordVector mask = shifted_words<kOffset.dx>(image.samples.row(y + kOffset.dy), word);
    if constexpr (kIndex > 0) {
      const BitPlane& reach = image.reach.planes[(kIndex - 1) / 2];
      // The opposite of an offset is known where it starts.
      const WordVector reached = kIndex % 2 == 1
                                     ? hn::LoadU(d, reach.row(y) + word)
                                     : shifted_words<kOffset.dx>(reach.row(y + kOffset.dy), word);
      mask = hn::And(mask, reached);
    }
    // What lies in which region of a complex pixel is not known: any point may be of use to any.
    if (any_complex) {
      const WordVector points = shifted_words<kOffset.dx>(image.occupied.row(y + kOffset.dy), word);
      mask = hn::Or(mask, hn::And(points, complex));
    }
    hn::StoreU(mask, d, out.taps[kIndex].data());
    any = hn::Or(any, mask);
  };
  (add(std::integral_constant<std::size_t, kTap>()), ...);
  hn::StoreU(any, d, out.any.data());
  if (image.some_are_stale)
    keep_fresh(image, y, word, out, lacking, std::index_sequence<kTap...>());
}

// A vector of pixels from x on, which are those of a word from bit `first` on.
template <std::size_t... kTap>
HWY_INLINE void sum_taps(const TapMasks& masks, std::size_t word, unsigned first,
                         const SampleRows& rows, std::ptrdiff_t x, ColorRow out, float* weight,
                         std::index_sequence<kTap...> /*taps*/) {
  const PixelLanes f;
  const auto zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  auto r = zero, g = zero, b = zero, sum = zero;
  const auto add = [&](auto tap) HWY_ATTR {
    constexpr ReachOffset kOffset = tap_offset(decltype(tap)::value);
    const ColorRow& row = rows[std::size_t(2 + kOffset.dy)];
    const auto mask = mask_from(f, masks.taps[decltype(tap)::value][word], first);
    const auto w = hn::IfThenElseZero(mask, hn::Set(f, kernel_weight(kOffset.dx, kOffset.dy)));
    const std::ptrdiff_t from = x + kOffset.dx;
    r = hn::MulAdd(w, hn::LoadU(f, row.r + from), r);
    g = hn::MulAdd(w, hn::LoadU(f, row.g + from), g);
    b = hn::MulAdd(w, hn::LoadU(f, row.b + from), b);
    sum = hn::Add(w, sum);
  };
  (add(std::integral_constant<std::size_t, kTap>()), ...);
  const auto inverse = hn::Div(one, hn::IfThenElse(hn::Gt(sum, zero), sum, one));
  hn::StoreU(hn::Mul(r, inverse), f, out.r + x);
  hn::StoreU(hn::Mul(g, inverse), f, out.g + x);
  hn::StoreU(hn::Mul(b, inverse), f, out.b + x);
  hn::StoreU(sum, f, weight + x);
}

void interpolate(const EdgePointImage& image, int y, const SampleRows& rows,
                 const InterpolatedRow& out) {
  constexpr auto kAll = std::make_index_sequence<kTaps>();
  const PixelLanes f;
  const auto zero = hn::Zero(f);
  const int step = int(hn::Lanes(WordLanes())), lanes = int(hn::Lanes(f));
  TapMasks masks;
  for (int word = 0; word < image.samples.words(); word += step) {
    find_masks(image, y, word, masks, out.lacking, kAll);
    for (int x = 64 * word; x < std::min(64 * (word + step), image.width_px); x += lanes) {
      const auto in_masks = std::size_t(x / 64 - word);
      if (masks.any[in_masks] != 0) {
        sum_taps(masks, in_masks, unsigned(x % 64), rows, x, out.color, out.weight, kAll);
        continue;
      }
      for (float* const row : {out.color.r, out.color.g, out.color.b, out.weight}) {
        hn::StoreU(zero, f, row + x);
      }
    }
  }
}

void interleave(ColorRow row, int width, float* out) {
  const hn::CappedTag<float, 16> f;
  const int lanes = int(hn::Lanes(f));
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    hn::StoreInterleaved3(hn::LoadU(f, row.r + x), hn::LoadU(f, row.g + x), hn::LoadU(f, row.b + x),
                          f, out + 3 * std::ptrdiff_t(x));
  }
  for (; x < width; ++x) {
    out[3 * x] = row.r[x];
    out[3 * x + 1] = row.g[x];
    out[3 * x + 2] = row.b[x];
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(interpolate);
HWY_EXPORT(interleave);

void interleave_row(ColorRow row, int width, float* out) {
  HWY_DYNAMIC_DISPATCH(interleave)(row, width, out);
}

void interpolate_row(const EdgePointImage& image, int y, ColorRows& samples,
                     const InterpolatedRow& out) {
  SampleRows rows;
  for (int dy = -2; dy <= 2; ++dy) rows[std::size_t(2 + dy)] = samples.row(y + dy);
  HWY_DYNAMIC_DISPATCH(interpolate)(image, y, rows, out);
}

}  // namespace arris
#endif
