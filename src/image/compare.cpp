#include "image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "arris/error.h"
#include "image/srgb.h"

namespace arris {
namespace {

void check_sizes(const Image& a, const Image& b) {
  if (a.width_px == b.width_px && a.height_px == b.height_px && a.channels == b.channels) return;
  throw Error(
      Error::Kind::input, "",
      fmt::format("the pictures differ in size: {} x {} pixels of {} channels and {} x {} of "
                  "{}; compare pictures of one size",
                  a.width_px, a.height_px, a.channels, b.width_px, b.height_px, b.channels));
}

bool is_finite_pixel(const Image& image, std::size_t first) {
  for (std::size_t c = 0; c < std::size_t(image.channels); ++c) {
    if (!std::isfinite(image.values[first + c])) return false;
  }
  return true;
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, ValueEncoding encoding) {
  check_sizes(a, b);
  const auto value = [&](const Image& image, std::size_t i) {
    const float v = image.values[i];
    return double(encoding == ValueEncoding::srgb ? srgb_from_linear(v) : v);
  };
  ImageDifference difference;
  double sum = 0, brightest = 0;
  std::size_t compared = 0;
  const std::size_t channels = std::size_t(a.channels);
  for (std::size_t pixel = 0; pixel < a.values.size(); pixel += channels) {
    if (!is_finite_pixel(a, pixel) || !is_finite_pixel(b, pixel)) {
      ++difference.nonfinite_pixels;
      continue;
    }
    compared += channels;
    for (std::size_t i = pixel; i < pixel + channels; ++i) {
      const double error = std::abs(value(a, i) - value(b, i));
      sum += error * error;
      brightest = std::max(brightest, value(a, i));
      if (error <= difference.max_error) continue;
      difference.max_error = error;
      difference.max_x = int(pixel / channels % std::size_t(a.width_px));
      difference.max_y = int(pixel / channels / std::size_t(a.width_px));
    }
  }
  difference.rmse = compared == 0 ? 0 : std::sqrt(sum / double(compared));
  difference.peak = encoding == ValueEncoding::srgb ? 1 : brightest;
  difference.psnr_db = difference.rmse == 0 ? std::numeric_limits<double>::infinity()
                                            : 20 * std::log10(difference.peak / difference.rmse);
  double flip = 0;
  for (const float f : flip_map(a, b).values) flip += double(f);
  difference.flip = flip / double(a.values.size() / channels);
  return difference;
}

}  // namespace arris
