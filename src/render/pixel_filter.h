// pixel_filter.h — where in and around a pixel its samples fall
// What       filter importance sampling: offsets are distributed as the reconstruction filter, so a
//            sample belongs to one pixel only, with weight 1, and parts of a render add up exactly
// Source     Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006
#pragma once

#include <array>
#include <cstddef>

#include "arris/scene.h"

namespace arris {

class PixelFilter {
 public:
  explicit PixelFilter(ImageSettings::Filter filter);

  // Offset from the pixel's centre along one axis, in pixels; the filters are separable. u in [0, 1).
  [[nodiscard]] float sample_offset(float u) const {
    const float scaled = u * float(kSteps);
    const std::size_t i = scaled < float(kSteps) ? std::size_t(scaled) : kSteps - 1;
    const float part = scaled - float(i);
    return offsets_[i] * (1 - part) + offsets_[i + 1] * part;
  }

 private:
  static constexpr std::size_t kSteps = 512;
  std::array<float, kSteps + 1> offsets_{};  // inverse of the distribution function
};

// Value at a distance from the pixel's centre along one axis, and the distance where it vanishes.
double eval_filter(ImageSettings::Filter filter, double x);
double filter_radius(ImageSettings::Filter filter);

}  // namespace arris
