#include "render/pixel_filter.h"

#include <cmath>
#include <vector>

namespace arris {

double filter_radius(ImageSettings::Filter filter) {
  switch (filter) {
    case ImageSettings::Filter::box:
      return 0.5;
    case ImageSettings::Filter::tent:
      return 1;
    case ImageSettings::Filter::gaussian:
    case ImageSettings::Filter::blackman_harris:
      return 1.5;
  }
  return 0.5;
}

double eval_filter(ImageSettings::Filter filter, double x) {
  const double radius = filter_radius(filter);
  if (std::abs(x) > radius) {
    return 0;
  }
  switch (filter) {
    case ImageSettings::Filter::box:
      return 1;
    case ImageSettings::Filter::tent:
      return 1 - std::abs(x);
    case ImageSettings::Filter::gaussian: {
      constexpr double kSigma = 0.5;  // cut to reach zero at the radius
      const auto gauss = [](double d) { return std::exp(-d * d / (2 * kSigma * kSigma)); };
      return gauss(x) - gauss(radius);
    }
    case ImageSettings::Filter::blackman_harris: {
      const double phase = kPi * (x / radius + 1);
      return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
             0.01168 * std::cos(3 * phase);
    }
  }
  return 0;
}

// The distribution function by the trapezoid rule on a fine grid, then inverted at even steps.
PixelFilter::PixelFilter(ImageSettings::Filter filter) {
  constexpr std::size_t kCells = 8192;
  const double radius = filter_radius(filter);
  const double step = 2 * radius / kCells;
  std::vector<double> below(kCells + 1);
  for (std::size_t i = 0; i < kCells; ++i) {
    const double x = -radius + double(i) * step;
    below[i + 1] = below[i] + (eval_filter(filter, x) + eval_filter(filter, x + step)) / 2;
  }
  std::size_t cell = 0;
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double target = below[kCells] * double(i) / kSteps;
    while (cell + 1 < kCells && below[cell + 1] < target) {
      ++cell;
    }
    const double inside = below[cell + 1] > below[cell]
                              ? (target - below[cell]) / (below[cell + 1] - below[cell])
                              : 0;
    offsets_[i] = float(-radius + (double(cell) + inside) * step);
  }
}

}  // namespace arris
