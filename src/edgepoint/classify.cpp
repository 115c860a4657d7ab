#include "edgepoint/classify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "edgepoint/point_rows.h"

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/classify.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Of 64 pixels those with a crossing on any side. The right side of each is the left one of the next.
std::uint64_t crossed(const std::uint8_t* upper, const std::uint8_t* lower,
                      const std::uint8_t* left) {
  const hn::CappedTag<std::uint8_t, 64> d;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(d)) {
    const auto rows = hn::Or(hn::LoadU(d, upper + i), hn::LoadU(d, lower + i));
    const auto columns = hn::Or(hn::LoadU(d, left + i), hn::LoadU(d, left + i + 1));
    bits |= bits_of(d, hn::Ne(hn::Or(rows, columns), hn::Zero(d))) << i;
  }
  return bits;
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {
namespace {

HWY_EXPORT(crossed);

constexpr int kWord = 64;  // pixels
using Word = std::uint64_t;

Word find_crossed(const std::uint8_t* upper, const std::uint8_t* lower, const std::uint8_t* left) {
  return HWY_DYNAMIC_DISPATCH(crossed)(upper, lower, left);
}

struct Corners {
  std::array<std::uint64_t, 4> primary{}, secondary{};

  void add(PixelCode code, int bit) {
    if (code.is_complex()) return;
    std::uint32_t in_primary = 15;
    if (code.is_simple()) {
      in_primary = edge_tables().corners_a[code.edge()];
      if (!code.primary_is_a()) in_primary ^= 15U;
    }
    for (unsigned k = 0; k < 4; ++k) {
      const std::uint64_t is_primary = in_primary >> k & 1U;
      primary[k] |= is_primary << unsigned(bit);
      secondary[k] |= (is_primary ^ 1U) << unsigned(bit);
    }
  }
};

}  // namespace

PixelClasses classify_pixels(RowBand band, EdgePointImage& image) {
  PixelClasses classes;
  const int width = image.width_px;
  for (int y = band.first; y < band.last; ++y) {
    const Crossings& c = image.crossings;
    const std::uint8_t *upper = c.upper.row(y), *lower = c.upper.row(y + 1), *left = c.left.row(y);
    PixelCode* const codes = image.codes.data() + image.offset(0, y);
    const PointKey* const points = image.points.data() + image.offset(0, y);
    std::fill_n(codes, unsigned(width), PixelCode(kEmptyEdge));
    for (int x0 = 0; x0 < width; x0 += kWord) {
      const int count = std::min(kWord, width - x0);
      const Word inside = ~Word{0} >> unsigned(kWord - count);
      const Word crossed = find_crossed(upper + x0, lower + x0, left + x0) & inside;
      Corners corners;
      corners.primary.fill(inside & ~crossed);
      Word samples = find_occupied({points + x0, std::size_t(count)});
      image.occupied.row(y)[x0 / kWord] = samples;
      classes.empty += std::uint64_t(count - std::popcount(crossed));
      for (Word rest = crossed; rest != 0; rest &= rest - 1) {
        const int bit = std::countr_zero(rest), x = x0 + bit;
        const ClassifiedPixel pixel = classify_pixel(boundary_mask(c.of_pixel(x, y)), points[x]);
        codes[x] = pixel.code;
        corners.add(pixel.code, bit);
        if (!pixel.has_sample) samples &= ~(Word{1} << unsigned(bit));
        (pixel.code.is_simple() ? classes.simple : classes.complex) += 1;
      }
      image.samples.row(y)[x0 / kWord] = samples;
      for (std::size_t k = 0; k < 4; ++k) {
        image.corners.primary[k].row(y)[x0 / kWord] = corners.primary[k];
        image.corners.secondary[k].row(y)[x0 / kWord] = corners.secondary[k];
      }
    }
  }
  return classes;
}

}  // namespace arris
#endif
