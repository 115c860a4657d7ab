#include "edgepoint/interpolate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "edgepoint/kernel.h"
#include "edgepoint/shifted_word.h"

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/interpolate.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#ifndef ARRIS_EDGEPOINT_INTERPOLATE_ONCE
#define ARRIS_EDGEPOINT_INTERPOLATE_ONCE
namespace arris {

// A neighbour within reach: which of 64 pixels it has a sample for, where that is, and what it counts.
struct Tap {
  std::uint64_t pixels = 0;
  const float *r = nullptr, *g = nullptr, *b = nullptr;
  float weight = 0;
};
inline constexpr std::size_t kTaps = 25;

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Pixels x0 to x0 + count of the row; count ≤ 64, what lies beyond is anything.
void sum_taps(const std::array<Tap, kTaps>& taps, std::size_t tap_count, int x0, int count,
              ColorRow out, float* weight) {
  const hn::CappedTag<float, 16> f;
  const auto zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  const int lanes = int(hn::Lanes(f));
  for (int i = 0; i < count; i += lanes) {
    auto r = zero, g = zero, b = zero, sum = zero;
    for (std::size_t k = 0; k < tap_count; ++k) {
      const Tap& tap = taps[k];
      const std::uint64_t bits = tap.pixels >> unsigned(i);
      std::array<std::uint8_t, 8> bytes;
      std::memcpy(bytes.data(), &bits, sizeof bits);
      const auto mask = hn::LoadMaskBits(f, bytes.data());
      const auto w = hn::IfThenElseZero(mask, hn::Set(f, tap.weight));
      const int x = x0 + i;
      r = hn::MulAdd(w, hn::LoadU(f, tap.r + x), r);
      g = hn::MulAdd(w, hn::LoadU(f, tap.g + x), g);
      b = hn::MulAdd(w, hn::LoadU(f, tap.b + x), b);
      sum = hn::Add(w, sum);
    }
    const auto inverse = hn::Div(one, hn::IfThenElse(hn::Gt(sum, zero), sum, one));
    const int x = x0 + i;
    hn::StoreU(hn::Mul(r, inverse), f, out.r + x);
    hn::StoreU(hn::Mul(g, inverse), f, out.g + x);
    hn::StoreU(hn::Mul(b, inverse), f, out.b + x);
    hn::StoreU(sum, f, weight + x);
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
namespace {

HWY_EXPORT(sum_taps);
HWY_EXPORT(interleave);

class TapList {
 public:
  TapList(const EdgePointImage& image, ColorRows& samples, int y, int word)
      : image_(image), samples_(samples), y_(y), word_(word) {}

  void add(int dx, int dy, std::uint64_t pixels) {
    if (pixels == 0) return;
    const ColorRow row = samples_.row(y_ + dy);
    taps_[count_++] = {pixels, row.r + dx, row.g + dx, row.b + dx, kernel_weight(dx, dy)};
  }
  // Of a neighbour the pixels for which it has a sample.
  [[nodiscard]] std::uint64_t sampled(int dx, int dy) const {
    return shifted_word(image_.samples.row(y_ + dy), word_, dx);
  }
  // Of the pixels those that reach the neighbour at an offset of kReachOffset, and at its opposite.
  [[nodiscard]] std::uint64_t reached(std::size_t k) const {
    return image_.reach.planes[k].row(y_)[word_];
  }
  [[nodiscard]] std::uint64_t reached_back(std::size_t k) const {
    const auto [dx, dy] = kReachOffset[k];
    return shifted_word(image_.reach.planes[k].row(y_ - dy), word_, -dx);
  }
  void sum(int x0, int count, ColorRow out, float* weight) const {
    HWY_DYNAMIC_DISPATCH(sum_taps)(taps_, count_, x0, count, out, weight);
  }

 private:
  const EdgePointImage& image_;
  ColorRows& samples_;
  int y_, word_;
  std::array<Tap, kTaps> taps_;
  std::size_t count_ = 0;
};

}  // namespace

void interleave_row(ColorRow row, int width, float* out) {
  HWY_DYNAMIC_DISPATCH(interleave)(row, width, out);
}

void interpolate_row(const EdgePointImage& image, int y, ColorRows& samples, ColorRow out,
                     float* weight) {
  for (int word = 0; word < image.samples.words(); ++word) {
    TapList taps(image, samples, y, word);
    // Complex pixels are those whose corners belong to no region.
    const std::uint64_t complex =
        ~(image.corners.primary[0].row(y)[word] | image.corners.secondary[0].row(y)[word]);
    taps.add(0, 0, taps.sampled(0, 0));
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      const auto [dx, dy] = kReachOffset[k];
      taps.add(dx, dy, (taps.reached(k) | complex) & taps.sampled(dx, dy));
      taps.add(-dx, -dy, (taps.reached_back(k) | complex) & taps.sampled(-dx, -dy));
    }
    const int x0 = word * 64;
    taps.sum(x0, std::min(64, image.width_px - x0), out, weight);
  }
}

}  // namespace arris
#endif
