#include "edgepoint/hidden_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "edgepoint/point_rows.h"
#include "edgepoint/shifted_word.h"

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/hidden_points.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"

#ifndef ARRIS_EDGEPOINT_HIDDEN_POINTS_ONCE
#define ARRIS_EDGEPOINT_HIDDEN_POINTS_ONCE
namespace arris {

// A neighbour within reach: which of 64 pixels it has a sample for, the inverse depths there, and its offset.
struct DepthTap {
  std::uint64_t pixels;
  const float* inverse;
  int dx, dy;
};
struct DepthTaps {
  std::array<DepthTap, 24> taps;
  std::size_t count = 0;
};

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Of 64 pixels those whose inverse depth is below `part` of a neighbour's.
std::uint64_t find_deeper(const DepthTaps& taps, const float* inverse, float part) {
  const hn::CappedTag<float, 16> f;
  const std::size_t lanes = hn::Lanes(f);
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < 64; i += lanes) {
    auto most = hn::Zero(f);
    for (std::size_t k = 0; k < taps.count; ++k) {
      const std::uint64_t bits = taps.taps[k].pixels >> i;
      std::array<std::uint8_t, 8> bytes;
      std::memcpy(bytes.data(), &bits, sizeof bits);
      const auto mask = hn::LoadMaskBits(f, bytes.data());
      most = hn::Max(most, hn::IfThenElseZero(mask, hn::LoadU(f, taps.taps[k].inverse + i)));
    }
    const auto own = hn::LoadU(f, inverse + i);
    found |= bits_of(f, hn::Lt(own, hn::Mul(most, hn::Set(f, part)))) << i;
  }
  return found;
}

// Of 64 places those where a · b is below `limit`.
std::uint64_t find_products_below(const float* a, const float* b, float limit) {
  const hn::CappedTag<float, 16> f;
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(f)) {
    const auto product = hn::Mul(hn::LoadU(f, a + i), hn::LoadU(f, b + i));
    found |= bits_of(f, hn::Lt(product, hn::Set(f, limit))) << i;
  }
  return found;
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {
namespace {

HWY_EXPORT(find_deeper);
HWY_EXPORT(find_products_below);

// Depths within what a steep surface gains over some pixels say nothing.
constexpr float kPixelsDeep = 8;
// So many samples around give a plane.
constexpr int kPlaneSamples = 4;
// Of places, in pixels.
constexpr float kPlaceError = 0.25F;

// Least squares of inverse depth over pixel offsets.
class DepthFit {
 public:
  void add(float dx, float dy, float inverse) {
    ++count_;
    x_ += dx;
    y_ += dy;
    xx_ += dx * dx;
    xy_ += dx * dy;
    yy_ += dy * dy;
    s_ += inverse;
    sx_ += dx * inverse;
    sy_ += dy * inverse;
  }

  // The inverse depth at the middle, and how far it may be off. Nothing if the samples fix no plane.
  struct Result {
    float inverse, tolerance;
  };
  [[nodiscard]] std::optional<Result> result() const {
    if (count_ < kPlaneSamples) return std::nullopt;
    const float n = float(count_), mean = s_ / n;
    const float mx = x_ / n, my = y_ / n;
    const float a = xx_ - n * mx * mx, b = xy_ - n * mx * my, c = yy_ - n * my * my;
    const float determinant = a * c - b * b;
    // Nearly in a line.
    if (!(determinant > n)) return std::nullopt;
    const float p = sx_ - n * mx * mean, q = sy_ - n * my * mean;
    const float slope_x = (c * p - b * q) / determinant, slope_y = (a * q - b * p) / determinant;
    // The value is a sum of the samples' with weights, and the sum of their squares. A place is known to a quarter of
    // a pixel, the middle's own too: each is off by an eighth at most, taken twice as the slope is off as well.
    const float squares = 1 / n + (c * mx * mx - 2 * b * mx * my + a * my * my) / determinant;
    const float slope = std::abs(slope_x) + std::abs(slope_y);
    return Result{mean - slope_x * mx - slope_y * my,
                  kPlaceError * slope * (1 + std::sqrt(n * squares))};
  }

 private:
  int count_ = 0;
  float x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, s_ = 0, sx_ = 0, sy_ = 0;
};

// Rows of a band, with those around it.
class HiddenFinder {
 public:
  HiddenFinder(const EdgePointImage& image, const PointObjects& objects, const DepthCells& cells,
               RowBand band, float pixel_size)
      : image_(image),
        objects_(objects),
        cells_(cells),
        band_(band),
        pixel_size_(pixel_size),
        stride_(std::size_t(image.samples.words()) * 64 + 2 * kMargin),
        rows_(stride_ * kRows),
        nearest_(std::size_t(image.samples.words()) * 64) {}

  std::vector<std::uint32_t> find() {
    for (int y = band_.first - 2; y < band_.first + 2; ++y) fetch(y);
    for (int y = band_.first; y < band_.last; ++y) {
      fetch(y + 2);
      if (y == band_.first || DepthCells::row_changes_at(y)) cells_.copy_nearest(y, nearest_);
      for (int word = 0; word < image_.samples.words(); ++word) find_in(y, word);
    }
    return std::move(hidden_);
  }

 private:
  static constexpr int kRows = 8, kMargin = 16;

  [[nodiscard]] float* row(int y) {
    return rows_.data() + stride_ * std::size_t((y + kRows) % kRows) + kMargin;
  }

  void fetch(int y) {
    if (y < 0 || y >= image_.height_px) return;
    find_inverse_depths({image_.points.data() + image_.offset(0, y), std::size_t(image_.width_px)},
                        row(y));
  }

  void find_in(int y, int word) {
    const float part = 1 / (1 + kPixelsDeep * pixel_size_);
    const std::ptrdiff_t x0 = 64 * std::ptrdiff_t(word);
    const float* const inverse = row(y) + x0;
    std::uint64_t deep = image_.samples.row(y)[word] & HWY_DYNAMIC_DISPATCH(find_products_below)(
                                                           inverse, nearest_.data() + x0, part);
    if (deep == 0) return;
    const DepthTaps& taps = taps_of(y, word);
    deep &= HWY_DYNAMIC_DISPATCH(find_deeper)(taps, inverse, part);
    for (; deep != 0; deep &= deep - 1) {
      const int bit = std::countr_zero(deep);
      const std::size_t at = image_.offset(64 * word + bit, y);
      if (is_hidden(taps, bit, at, inverse[bit])) {
        hidden_.push_back(std::uint32_t(at));
      }
    }
  }

  // The point of the pixel at an offset, which is a bit of the word that the taps are of.
  [[nodiscard]] bool is_hidden(const DepthTaps& taps, int bit, std::size_t at,
                               float inverse) const {
    const float part = 1 / (1 + kPixelsDeep * pixel_size_);
    const PointKey* const own = image_.points.data() + at;
    DepthFit fit;
    // Which taps count can't be guessed, so they are found without a branch.
    std::uint32_t with_sample = 0;
    for (std::size_t k = 0; k < taps.count; ++k) {
      with_sample |= std::uint32_t(taps.taps[k].pixels >> unsigned(bit) & 1U) << k;
    }
    for (; with_sample != 0; with_sample &= with_sample - 1) {
      const DepthTap& tap = taps.taps[std::size_t(std::countr_zero(with_sample))];
      const PointKey other = own[tap.dy * std::ptrdiff_t(image_.width_px) + tap.dx];
      const float there = tap.inverse[bit];
      if (inverse < there * part && !objects_.empty() &&
          objects_[other.point()] != objects_[own->point()]) {
        return true;
      }
      const auto quarters = [](std::uint32_t a, std::uint32_t b) {
        return 0.25F * (float(a) - float(b));
      };
      fit.add(float(tap.dx) + quarters(other.cell() % 4, own->cell() % 4),
              float(tap.dy) + quarters(other.cell() / 4, own->cell() / 4), there);
    }
    const std::optional<DepthFit::Result> surface = fit.result();
    return surface && inverse < surface->inverse * part - surface->tolerance;
  }

  const DepthTaps& taps_of(int y, int word) {
    DepthTaps& taps = taps_;
    taps.count = 0;
    const auto add = [&](int dx, int dy, std::uint64_t reached) {
      const std::uint64_t pixels = reached & shifted_word(image_.samples.row(y + dy), word, dx);
      if (pixels != 0)
        taps.taps[taps.count++] = {pixels, row(y + dy) + 64 * std::ptrdiff_t(word) + dx, dx, dy};
    };
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      const auto [dx, dy] = kReachOffset[k];
      const BitPlane& reach = image_.reach.planes[k];
      add(dx, dy, reach.row(y)[word]);
      add(-dx, -dy, shifted_word(reach.row(y - dy), word, -dx));
    }
    return taps;
  }

  const EdgePointImage& image_;
  PointObjects objects_;
  const DepthCells& cells_;
  RowBand band_;
  float pixel_size_;
  std::size_t stride_;
  std::vector<float> rows_;
  std::vector<float> nearest_;  // around each pixel of the row
  std::vector<std::uint32_t> hidden_;
  DepthTaps taps_;
};

}  // namespace

std::vector<std::uint32_t> find_hidden_points(const EdgePointImage& image,
                                              const PointObjects& objects, const DepthCells& cells,
                                              RowBand band, float pixel_size) {
  return HiddenFinder(image, objects, cells, band, pixel_size).find();
}

void remove_points(std::span<const std::uint32_t> pixels, EdgePointImage& image) {
  for (const std::uint32_t at : pixels) {
    image.points[at] = PointKey();
    const int x = int(at % std::uint32_t(image.width_px)),
              y = int(at / std::uint32_t(image.width_px));
    const std::uint64_t others = ~(std::uint64_t{1} << unsigned(x & 63));
    image.samples.row(y)[x >> 6] &= others;
    image.occupied.row(y)[x >> 6] &= others;
  }
}

}  // namespace arris
#endif
