#include "edgepoint/reconstruct.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>

#include "edgepoint/antialias.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/complex_pixel.h"
#include "edgepoint/interpolate.h"
#include "edgepoint/point_rows.h"

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSampleRows = 8;   // of five that are needed; a power of two
constexpr int kPrimaryRows = 4;  // of three

class BandMaker {
 public:
  BandMaker(const EdgePointImage& image, const PointCache& cache,
            const ReconstructionSettings& settings, RowBand band, Image& picture,
            std::span<std::uint8_t> wanted)
      : image_(image),
        cache_(cache),
        settings_(settings),
        band_(band),
        picture_(picture),
        wanted_(wanted),
        width_(image.width_px),
        samples_(kSampleRows, width_),
        primary_(kPrimaryRows, width_),
        weights_(std::size_t(kPrimaryRows) * weight_stride()),
        wishes_(std::size_t(kSampleRows) * weight_stride()),
        looks_(weight_stride()),
        lacking_(std::size_t(kPrimaryRows) * lacking_stride()),
        painted_samples_(settings.tints != nullptr ? kSampleRows : 0, width_),
        painted_(settings.tints != nullptr ? 1 : 0, width_),
        complex_(image) {}

  BandReport run() {
    const int first = std::max(band_.first - 1, 0),
              last = std::min(band_.last + 1, image_.height_px);
    for (int y = first - 2; y < first + 2; ++y) fetch(y);
    for (int y = first; y < last; ++y) {
      fetch(y + 2);
      interpolate_row(image_, y, samples_, {primary_.row(y), weight_row(y), lacking_row(y)});
      if (settings_.tints != nullptr) tint_row(primary_.row(y), y);
      if (y > band_.first) finish(y - 1);
    }
    if (last == band_.last) finish(last - 1);
    return std::move(report_);
  }

 private:
  [[nodiscard]] std::size_t weight_stride() const {
    return std::size_t(width_) + 2 * ColorRows::kMargin;
  }
  [[nodiscard]] float* weight_row(int y) {
    return weights_.data() + std::size_t((y + kPrimaryRows) % kPrimaryRows) * weight_stride();
  }
  [[nodiscard]] std::size_t lacking_stride() const {
    return std::size_t(image_.samples.words()) + kVectorWords;
  }
  [[nodiscard]] std::uint64_t* lacking_row(int y) {
    return lacking_.data() + std::size_t((y + kPrimaryRows) % kPrimaryRows) * lacking_stride();
  }
  [[nodiscard]] std::uint8_t* wish_row(int y) {
    return wishes_.data() + std::size_t((y + kSampleRows) % kSampleRows) * weight_stride();
  }
  [[nodiscard]] PrimaryRows primary_rows(int y) { return {primary_.row(y), weight_row(y)}; }

  void fetch(int y) {
    // Beyond the picture nothing has a sample.
    if (y < 0 || y >= image_.height_px) return;
    const auto row_at = [&](int at) {
      return std::span(image_.points).subspan(image_.offset(0, at), std::size_t(width_));
    };
    fetch_points(row_at(y), row_at(std::min(y + 1, image_.height_px - 1)), cache_, settings_.frame,
                 looks_, samples_.row(y), wish_row(y));
    if (settings_.tints != nullptr) fetch_painted(y);
  }

  void fetch_painted(int y) {
    const ColorRow from = samples_.row(y), to = painted_samples_.row(y);
    const PointKey* const points = image_.points.data() + image_.offset(0, y);
    for (int x = 0; x < width_; ++x) {
      const float part =
          points[x].is_none() ? 0.0F : float(cache_.painted()[points[x].point()]) * (1.0F / 255);
      to.r[x] = from.r[x] * part;
      to.g[x] = from.g[x] * part;
      to.b[x] = from.b[x] * part;
    }
  }

  void tint_row(const ColorRow& row, int y) {
    const TintImage& tints = *settings_.tints;
    const std::uint64_t* const is_tinted = tints.is_tinted.row(y);
    if (std::all_of(is_tinted, is_tinted + tints.is_tinted.words(),
                    [](auto w) { return w == 0; })) {
      return;
    }
    const ColorRow painted = painted_.row(0);
    interpolate_row(image_, y, painted_samples_,
                    {painted, painted_weights_.data(), painted_lacking_.data()});
    for (int word = 0; word < tints.is_tinted.words(); ++word) {
      for (std::uint64_t bits = tints.is_tinted.row(y)[word]; bits != 0; bits &= bits - 1) {
        const int x = 64 * word + std::countr_zero(bits);
        const Rgb color =
            tinted(color_at(row, x), color_at(painted, x), tints.values[image_.offset(x, y)]);
        row.r[x] = color.x;
        row.g[x] = color.y;
        row.b[x] = color.z;
      }
    }
  }

  // Row y, when its neighbours are interpolated.
  void finish(int y) {
    const PrimaryRows here = primary_rows(y);
    const PrimaryNeighborhood rows{primary_rows(y - 1), here, primary_rows(y + 1)};
    float* const out = picture_.values.data() + picture_.offset(0, y);
    interleave_row(here.color, width_, out);
    report_.times.interpolation += lap();
    for_crossed(y, [&](int x) {
      if (image_.codes[image_.offset(x, y)].is_simple()) {
        set_pixel(out + 3 * x, antialias_simple_pixel(image_, x, y, rows));
      }
    });
    report_.times.antialias += lap();
    if (settings_.complex_filter) {
      complex_.reconstruct_row(y, {samples_, rows, settings_.tints, &painted_samples_}, out);
    }
    report_.times.complex += lap();
    set_wanted(y, here.weight);
  }

  // Calls for the pixels of a row that edges cross.
  template <class Call>
  void for_crossed(int y, const Call& call) const {
    const auto& primary = image_.corners.primary;
    for (int word = 0; word < image_.samples.words(); ++word) {
      std::uint64_t crossed = ~(primary[0].row(y)[word] & primary[1].row(y)[word] &
                                primary[2].row(y)[word] & primary[3].row(y)[word]);
      const int count = std::min(64, width_ - 64 * word);
      if (count < 64) crossed &= (std::uint64_t{1} << unsigned(count)) - 1;
      for (; crossed != 0; crossed &= crossed - 1) call(64 * word + std::countr_zero(crossed));
    }
  }

  static void set_pixel(float* out, Rgb color) {
    out[0] = color.x;
    out[1] = color.y;
    out[2] = color.z;
  }

  // Milliseconds since the last call.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_lap_).count();
    last_lap_ = now;
    return ms;
  }

  void set_wanted(int y, const float* weight) {
    const std::size_t offset = image_.offset(0, y);
    find_wanted(wanted_.subspan(offset, std::size_t(width_)), weight, wish_row(y), offset,
                report_.unresolved);
    if (image_.some_are_stale) want_fresh(y);
  }

  // Where all that is seen is stale a sample is wanted, also by pixels without a point; where one of them is fresh,
  // little more are.
  void want_fresh(int y) {
    constexpr std::uint8_t kLacking = 160, kEnough = 32;
    const std::span<std::uint8_t> row = wanted_.subspan(image_.offset(0, y), std::size_t(width_));
    const std::uint64_t* const lacking = lacking_row(y);
    for (int x = 0; x < width_; ++x) {
      std::uint8_t& wanted = row[std::size_t(x)];
      const bool lacks = lacking[x / 64] >> unsigned(x % 64) & 1U;
      wanted = lacks ? std::max(wanted, kLacking) : std::min(wanted, kEnough);
    }
  }

  const EdgePointImage& image_;
  const PointCache& cache_;
  const ReconstructionSettings& settings_;
  RowBand band_;
  Image& picture_;
  std::span<std::uint8_t> wanted_;
  int width_;
  ColorRows samples_, primary_;
  std::vector<float> weights_;
  std::vector<std::uint8_t> wishes_;
  std::vector<PointLook> looks_;
  std::vector<std::uint64_t> lacking_;
  ColorRows painted_samples_, painted_;
  ComplexPixels complex_;
  std::vector<float> painted_weights_ = std::vector<float>(weight_stride());
  std::vector<std::uint64_t> painted_lacking_ = std::vector<std::uint64_t>(lacking_stride());
  BandReport report_;
  Clock::time_point last_lap_ = Clock::now();
};

}  // namespace

BandReport reconstruct_band(const EdgePointImage& image, const PointCache& cache,
                            const ReconstructionSettings& settings, RowBand band, Image& picture,
                            std::span<std::uint8_t> wanted) {
  return BandMaker(image, cache, settings, band, picture, wanted).run();
}

}  // namespace arris
