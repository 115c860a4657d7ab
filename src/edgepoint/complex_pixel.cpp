#include "edgepoint/complex_pixel.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "edgepoint/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Of the taps whose bits are set. Four lanes are on every processor.
HWY_INLINE Rgb weighted_mean(std::uint32_t reached, const CountedColor* colors,
                             const float* weights, const SubpixelTapSteps& taps, Rgb fallback) {
  const hn::FixedTag<float, 4> d;
  auto sum = hn::Zero(d);
  for (; reached != 0; reached &= reached - 1) {
    const SubpixelTapStep& tap = taps[std::size_t(std::countr_zero(reached))];
    const auto weight = hn::Set(d, tap.kernel * weights[tap.step]);
    sum = hn::Add(sum, hn::Mul(hn::Load(d, colors[tap.step].rgb1.data()), weight));
  }
  alignas(16) std::array<float, 4> rgb1;
  hn::Store(sum, d, rgb1.data());
  if (!(rgb1[3] > 0)) return fallback;
  return Rgb{rgb1[0], rgb1[1], rgb1[2]} * (1 / rgb1[3]);
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace arris {

ComplexPixels::ComplexPixels(const EdgePointImage& image)
    : image_(image), subpixels_(image), reach_(image.width_px) {
  complex_.resize(std::size_t(image.samples.words()));
  for (Row& row : rows_) row.wanted.resize(complex_.size());
  const auto width = std::size_t(subpixel_width(image.width_px));
  for (auto* const taps : {&primary_taps_, &secondary_taps_}) {
    for (std::vector<std::uint32_t>& of_row : *taps) of_row.resize(width);
  }
}

// Complex pixels are those whose corners belong to no region.
std::uint64_t ComplexPixels::complex_word(int y, std::size_t word) const {
  if (y < 0 || y >= image_.height_px) return 0;
  const std::uint64_t simple =
      image_.corners.primary[0].row(y)[word] | image_.corners.secondary[0].row(y)[word];
  const int count = std::min(64, image_.width_px - 64 * int(word));
  return ~simple & ~std::uint64_t{0} >> unsigned(64 - count);
}

void ComplexPixels::find_wanted(int y, Words& wanted) const {
  const std::size_t words = wanted.size();
  std::uint64_t before = 0;
  const auto of_column = [&](std::size_t word) {
    return complex_word(y - 1, word) | complex_word(y, word) | complex_word(y + 1, word);
  };
  std::uint64_t here = of_column(0);
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t after = i + 1 < words ? of_column(i + 1) : 0;
    wanted[i] = here | here << 1U | here >> 1U | before >> 63U | after << 63U;
    before = here;
    here = after;
  }
  const int count = image_.width_px - 64 * int(words - 1);
  wanted.back() &= ~std::uint64_t{0} >> unsigned(64 - count);
}

void ComplexPixels::fill(int y, const PrimaryRows& primary, const ComplexPixelColors& colors) {
  Row& of = row(y);
  if (of.filled == y) return;
  of.filled = y;
  if (y < 0 || y >= image_.height_px) {
    std::ranges::fill(of.wanted, 0);
    subpixels_.clear(y);
    return;
  }
  find_wanted(y, of.wanted);
  SubpixelColors colors_of_row{colors.samples.row(y), primary, colors.tints, {}};
  if (colors.tints != nullptr) colors_of_row.painted = colors.painted->row(y);
  subpixels_.fill(y, of.wanted, colors_of_row);
}

// Of a row that is filled, as the next one.
void ComplexPixels::find_reach(int y) {
  Row& of = row(y);
  if (of.reached == y) return;
  of.reached = y;
  for (int j = 0; j < 2; ++j) {
    find_subpixel_reach(subpixels_.planes(), 2 * y + j, of.wanted, reach_);
  }
}

// Sums are always made in this order.
SubpixelTapSteps ComplexPixels::taps_of(int row) const {
  SubpixelTapSteps taps;
  for (std::size_t k = 0; k < kSubpixelTaps; ++k) {
    const auto [dx, dy] = subpixel_tap(k);
    taps[k] = {int(subpixels_.place(dx, row + dy) - subpixels_.place(0, row)),
               kernel_weight(dx, dy)};
  }
  return taps;
}

Rgb ComplexPixels::region_color(std::uint32_t reached, std::ptrdiff_t place,
                                const SubpixelTapSteps& taps, Rgb fallback) const {
  return HWY_NAMESPACE::weighted_mean(reached, subpixels_.colors() + place,
                                      subpixels_.weights() + place, taps, fallback);
}

Rgb ComplexPixels::color_of(int x, int y, const std::array<SubpixelTapSteps, 2>& taps,
                            Rgb fallback) const {
  Rgb sum;
  for (int k = 0; k < 4; ++k) {
    const int column = 2 * x + k % 2;
    const auto j = std::size_t(k / 2), at = std::size_t(column);
    const std::ptrdiff_t place = subpixels_.place(column, 2 * y + k / 2);
    const PixelCode code = subpixels_.code(place);
    if (code.is_complex()) {
      sum += fallback;
      continue;
    }
    const Rgb primary = region_color(primary_taps_[j][at], place, taps[j], fallback);
    if (code.is_empty()) {
      sum += primary;
      continue;
    }
    const Rgb secondary = region_color(secondary_taps_[j][at], place, taps[j], fallback);
    const float area_a = edge_tables().area_a[code.edge()];
    const float area = code.primary_is_a() ? area_a : 1 - area_a;
    sum += primary * area + secondary * (1 - area);
  }
  return sum * 0.25F;
}

void ComplexPixels::reconstruct_row(int y, const ComplexPixelColors& colors, float* out) {
  for (std::size_t i = 0; i < complex_.size(); ++i) complex_[i] = complex_word(y, i);
  if (std::ranges::all_of(complex_, [](std::uint64_t word) { return word == 0; })) return;
  fill(y - 1, colors.around.above, colors);
  fill(y, colors.around.here, colors);
  fill(y + 1, colors.around.below, colors);
  find_reach(y - 1);
  find_reach(y);
  std::array<SubpixelTapSteps, 2> taps;
  for (int j = 0; j < 2; ++j) {
    const auto of = std::size_t(j);
    find_subpixel_taps(subpixels_.planes(), reach_, 2 * y + j, complex_,
                       {primary_taps_[of], secondary_taps_[of]});
    taps[of] = taps_of(2 * y + j);
  }
  for (std::size_t i = 0; i < complex_.size(); ++i) {
    for (std::uint64_t rest = complex_[i]; rest != 0; rest &= rest - 1) {
      const int x = 64 * int(i) + std::countr_zero(rest);
      const Rgb color = color_of(x, y, taps, color_at(colors.around.here.color, x));
      for (int c = 0; c < 3; ++c) out[3 * x + c] = color[c];
    }
  }
}

}  // namespace arris
