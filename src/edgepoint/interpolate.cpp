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

struct ColorLanes {
  hn::Vec<PixelLanes> r, g, b, weight;
};

// The means of a vector of pixels from x on, which are those of a word from bit `first` on.
template <std::size_t... kTap>
HWY_INLINE ColorLanes mean_of_taps(const TapMasks& masks, std::size_t word, unsigned first,
                                   const SampleRows& rows, std::ptrdiff_t x,
                                   std::index_sequence<kTap...> /*taps*/) {
  const PixelLanes f;
  const auto zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  auto r = zero, g = zero, b = zero, sum = zero;
  // Without being told, the compiler calls some of them, with the sums in memory.
  const auto add = [&](auto tap) HWY_ATTR __attribute__((always_inline)) {
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
  return {hn::Mul(r, inverse), hn::Mul(g, inverse), hn::Mul(b, inverse), sum};
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
        const ColorLanes mean = mean_of_taps(masks, in_masks, unsigned(x % 64), rows, x, kAll);
        hn::StoreU(mean.r, f, out.color.r + x);
        hn::StoreU(mean.g, f, out.color.g + x);
        hn::StoreU(mean.b, f, out.color.b + x);
        hn::StoreU(mean.weight, f, out.weight + x);
        continue;
      }
      for (float* const row : {out.color.r, out.color.g, out.color.b, out.weight}) {
        hn::StoreU(zero, f, row + x);
      }
    }
  }
}

// For each tap the usable pixels within reach of holes. Returns whether there are any.
template <std::size_t... kTap>
HWY_INLINE bool find_usable(const EdgePointImage& image, const HolePlanes& planes, int y, int word,
                            TapMasks& out, std::index_sequence<kTap...> /*taps*/) {
  const WordLanes d;
  const WordVector holes = hn::LoadU(d, planes.holes.row(y) + word);
  if (hn::AllTrue(d, hn::Eq(holes, hn::Zero(d)))) return false;
  WordVector any = hn::Zero(d);
  hn::StoreU(any, d, out.taps[0].data());
  const auto add = [&](auto tap) HWY_ATTR {
    constexpr std::size_t kIndex = decltype(tap)::value + 1;
    constexpr ReachOffset kOffset = tap_offset(kIndex);
    const BitPlane& reach = image.reach.planes[(kIndex - 1) / 2];
    const WordVector reached = kIndex % 2 == 1
                                   ? hn::LoadU(d, reach.row(y) + word)
                                   : shifted_words<kOffset.dx>(reach.row(y + kOffset.dy), word);
    const WordVector mask = hn::And(
        hn::And(shifted_words<kOffset.dx>(planes.usable.row(y + kOffset.dy), word), reached),
        holes);
    hn::StoreU(mask, d, out.taps[kIndex].data());
    any = hn::Or(any, mask);
  };
  (add(std::integral_constant<std::size_t, kTap>()), ...);
  hn::StoreU(any, d, out.any.data());
  return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
}

bool fill_reached(const EdgePointImage& image, const HolePlanes& planes, int y,
                  const SampleRows& rows, std::uint64_t* filled) {
  constexpr auto kAll = std::make_index_sequence<kTaps>();
  constexpr auto kOthers = std::make_index_sequence<kTaps - 1>();
  const PixelLanes f;
  const ColorRow colors = rows[2];
  const int step = int(hn::Lanes(WordLanes())), lanes = int(hn::Lanes(f));
  bool any = false;
  TapMasks masks;
  for (int word = 0; word < planes.holes.words(); word += step) {
    if (!find_usable(image, planes, y, word, masks, kOthers)) {
      std::fill_n(filled + word, step, std::uint64_t{0});
      continue;
    }
    any = true;
    std::copy_n(masks.any.begin(), step, filled + word);
    for (int x = 64 * word; x < std::min(64 * (word + step), image.width_px); x += lanes) {
      const auto in_masks = std::size_t(x / 64 - word);
      const auto first = unsigned(x % 64);
      const auto mask = mask_from(f, masks.any[in_masks], first);
      if (hn::AllFalse(f, mask)) continue;
      const ColorLanes mean = mean_of_taps(masks, in_masks, first, rows, x, kAll);
      hn::BlendedStore(mean.r, mask, f, colors.r + x);
      hn::BlendedStore(mean.g, mask, f, colors.g + x);
      hn::BlendedStore(mean.b, mask, f, colors.b + x);
    }
  }
  return any;
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

void part(const float* pixels, int width, ColorRow row) {
  const hn::CappedTag<float, 16> f;
  const int lanes = int(hn::Lanes(f));
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    hn::Vec<decltype(f)> r, g, b;
    hn::LoadInterleaved3(f, pixels + 3 * std::ptrdiff_t(x), r, g, b);
    hn::StoreU(r, f, row.r + x);
    hn::StoreU(g, f, row.g + x);
    hn::StoreU(b, f, row.b + x);
  }
  for (; x < width; ++x) {
    row.r[x] = pixels[3 * x];
    row.g[x] = pixels[3 * x + 1];
    row.b[x] = pixels[3 * x + 2];
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(interpolate);
HWY_EXPORT(interleave);
HWY_EXPORT(part);
HWY_EXPORT(fill_reached);

namespace {

SampleRows rows_around(ColorRows& colors, int y) {
  SampleRows rows;
  for (int dy = -2; dy <= 2; ++dy) rows[std::size_t(2 + dy)] = colors.row(y + dy);
  return rows;
}

}  // namespace

void interleave_row(ColorRow row, int width, float* out) {
  HWY_DYNAMIC_DISPATCH(interleave)(row, width, out);
}

void interpolate_row(const EdgePointImage& image, int y, ColorRows& samples,
                     const InterpolatedRow& out) {
  HWY_DYNAMIC_DISPATCH(interpolate)(image, y, rows_around(samples, y), out);
}

void part_row(const float* pixels, int width, ColorRow row) {
  HWY_DYNAMIC_DISPATCH(part)(pixels, width, row);
}

bool fill_reached_row(const EdgePointImage& image, const HolePlanes& planes, int y,
                      ColorRows& colors, std::uint64_t* filled) {
  return HWY_DYNAMIC_DISPATCH(fill_reached)(image, planes, y, rows_around(colors, y), filled);
}

}  // namespace arris
#endif
