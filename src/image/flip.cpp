// FLIP for low dynamic range, after Andersson et al. 2020 (compare.h).
// Legend     ppd  pixels per degree of visual angle
//            YCxCz  linear opponent colours: the CIELAB formulas without the cube root
//            qc, qf, pc, pt  the paper's exponents (§4.1.4, §4.3) and the knee of its colour error
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "arris/math.h"
#include "image/compare.h"

namespace arris {
namespace {

constexpr double kPixelsPerDegree = 0.7 * (3840 / 0.7) * (kPi / 180);
constexpr float kQc = 0.7F, kQf = 0.5F, kPc = 0.4F, kPt = 0.95F;
constexpr double kFeatureDegrees = 0.082;                // w: width of the eye's edge detector
constexpr Rgb kWhite{0.950428545F, 1.0F, 1.088900371F};  // XYZ of D65

// ---- colour spaces

Rgb xyz_from_rgb(Rgb c) {
  return {0.4123908F * c.x + 0.3575843F * c.y + 0.1804808F * c.z,
          0.2126390F * c.x + 0.7151687F * c.y + 0.0721923F * c.z,
          0.0193308F * c.x + 0.1191948F * c.y + 0.9505322F * c.z};
}

Rgb rgb_from_xyz(Rgb c) {
  return {3.2409699F * c.x - 1.5373832F * c.y - 0.4986108F * c.z,
          -0.9692436F * c.x + 1.8759675F * c.y + 0.0415551F * c.z,
          0.0556301F * c.x - 0.2039770F * c.y + 1.0569715F * c.z};
}

Rgb opponent_from_rgb(Rgb c) {
  const Rgb w = xyz_from_rgb(c) / kWhite;
  return {116 * w.y - 16, 500 * (w.x - w.y), 200 * (w.y - w.z)};
}

Rgb rgb_from_opponent(Rgb c) {
  const float y = (c.x + 16) / 116;
  return rgb_from_xyz(Rgb{y + c.y / 500, y, y - c.z / 200} * kWhite);
}

float lab_curve(float t) {
  constexpr float kDelta = 6.0F / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0F / 29;
}

// CIELAB with chroma that fades with lightness (Hunt effect).
Rgb hunt_lab_from_rgb(Rgb c) {
  const Rgb w = xyz_from_rgb(c) / kWhite;
  const Rgb f{lab_curve(w.x), lab_curve(w.y), lab_curve(w.z)};
  const float lightness = 116 * f.y - 16;
  return {lightness, 0.01F * lightness * 500 * (f.x - f.y), 0.01F * lightness * 200 * (f.y - f.z)};
}

float hyab_distance(Rgb a, Rgb b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- filters

using Kernel = std::vector<float>;  // odd length, centred

struct ValuePlane {
  int width = 0, height = 0;
  std::vector<float> values;
};

ValuePlane filter_rows(const ValuePlane& in, const Kernel& kernel) {
  ValuePlane out{in.width, in.height, std::vector<float>(in.values.size())};
  const int radius = int(kernel.size() / 2);
  for (int y = 0; y < in.height; ++y) {
    const float* row = &in.values[std::size_t(y) * std::size_t(in.width)];
    for (int x = 0; x < in.width; ++x) {
      float sum = 0;
      for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
        sum += kernel[tap] * row[std::clamp(x + int(tap) - radius, 0, in.width - 1)];
      }
      out.values[std::size_t(y) * std::size_t(in.width) + std::size_t(x)] = sum;
    }
  }
  return out;
}

ValuePlane filter_columns(const ValuePlane& in, const Kernel& kernel) {
  ValuePlane out{in.width, in.height, std::vector<float>(in.values.size())};
  const int radius = int(kernel.size() / 2);
  const std::size_t width = std::size_t(in.width);
  for (int y = 0; y < in.height; ++y) {
    float* sums = &out.values[std::size_t(y) * width];
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const float weight = kernel[tap];
      const int y_in = std::clamp(y + int(tap) - radius, 0, in.height - 1);
      const float* row = &in.values[std::size_t(y_in) * width];
      for (std::size_t x = 0; x < width; ++x) sums[x] += weight * row[x];
    }
  }
  return out;
}

template <class Function>
Kernel make_kernel(int radius, Function&& function) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(float(function(double(i))));
  return kernel;
}

double sum_of(const Kernel& kernel) {
  double sum = 0;
  for (const float weight : kernel) sum += double(weight);
  return sum;
}

// One Gaussian of a contrast sensitivity function (table 1): a √(π/b) exp(−π² d²/b), d in degrees.
struct SensitivityTerm {
  double a, b;
};

// The eye's low-pass filter of one opponent channel: a sum of Gaussians, each separable.
ValuePlane filter_sensitivity(const ValuePlane& in, const std::vector<SensitivityTerm>& terms) {
  constexpr double kWidestB = 0.04;
  const int radius = int(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi * kPi)) * kPixelsPerDegree));
  ValuePlane out{in.width, in.height, std::vector<float>(in.values.size())};
  double total = 0;
  for (const SensitivityTerm& term : terms) {
    const Kernel kernel = make_kernel(radius, [&](double i) {
      const double d = i / kPixelsPerDegree;
      return std::exp(-kPi * kPi * d * d / term.b);
    });
    const double weight = term.a * std::sqrt(kPi / term.b);
    total += weight * sum_of(kernel) * sum_of(kernel);
    const ValuePlane filtered = filter_columns(filter_rows(in, kernel), kernel);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
      out.values[i] += float(weight) * filtered.values[i];
    }
  }
  for (float& value : out.values) value = float(double(value) / total);
  return out;
}

// ---- the two halves of the measure

struct Opponent {
  std::array<ValuePlane, 3> planes;  // Y, Cx, Cz
};

Opponent opponent_planes(const Image& image) {
  Opponent out;
  for (ValuePlane& plane : out.planes) {
    plane = {image.width_px, image.height_px, std::vector<float>(image.values.size() / 3)};
  }
  const auto shown = [](float v) { return v > 0 ? std::min(v, 1.0F) : 0.0F; };
  for (std::size_t i = 0; i < out.planes[0].values.size(); ++i) {
    const float* v = &image.values[3 * i];
    const Rgb c = opponent_from_rgb({shown(v[0]), shown(v[1]), shown(v[2])});
    for (std::size_t k = 0; k < 3; ++k) out.planes[k].values[i] = c[int(k)];
  }
  return out;
}

std::vector<Rgb> seen_colors(const Opponent& opponent) {
  const ValuePlane y = filter_sensitivity(opponent.planes[0], {{1, 0.0047}});
  const ValuePlane cx = filter_sensitivity(opponent.planes[1], {{1, 0.0053}});
  const ValuePlane cz = filter_sensitivity(opponent.planes[2], {{34.1, 0.04}, {13.5, 0.025}});
  std::vector<Rgb> colors(y.values.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Rgb rgb = rgb_from_opponent({y.values[i], cx.values[i], cz.values[i]});
    colors[i] = hunt_lab_from_rgb(min(max(rgb, Rgb(0.0F)), Rgb(1.0F)));
  }
  return colors;
}

// 0..1 from a HyAB distance: small differences take most of the range (§4.1.4).
float color_error(float distance) {
  static const float kLargest =
      std::pow(hyab_distance(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), kQc);
  const float error = std::pow(distance, kQc);
  const float knee = kPc * kLargest;
  if (error < knee) return kPt / knee * error;
  return std::min(kPt + (error - knee) / (kLargest - knee) * (1 - kPt), 1.0F);
}

// Positive weights sum to 1, negative ones to −1.
void balance(Kernel& kernel) {
  double positive = 0, negative = 0;
  for (const float w : kernel) (w > 0 ? positive : negative) += double(w);
  for (float& w : kernel) w = float(double(w) / (w > 0 ? positive : -negative));
}

struct Features {
  std::vector<float> edges, points;  // magnitudes
};

Features find_features(const ValuePlane& opponent_y) {
  ValuePlane y = opponent_y;
  for (float& value : y.values) value = (value + 16) / 116;
  const double sigma = 0.5 * kFeatureDegrees * kPixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  Kernel smooth = make_kernel(radius, gauss);
  const double total = sum_of(smooth);
  for (float& w : smooth) w = float(double(w) / total);
  Kernel edge = make_kernel(radius, [&](double x) { return -x * gauss(x); });
  Kernel point =
      make_kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gauss(x); });
  balance(edge);
  balance(point);
  const auto magnitudes = [&](const Kernel& kernel) {
    const ValuePlane dx = filter_columns(filter_rows(y, kernel), smooth);
    const ValuePlane dy = filter_columns(filter_rows(y, smooth), kernel);
    std::vector<float> out(dx.values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(dx.values[i], dy.values[i]);
    return out;
  };
  return {magnitudes(edge), magnitudes(point)};
}

float feature_error(const Features& a, const Features& b, std::size_t i) {
  const float difference =
      std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
  return std::pow(std::min(difference / std::sqrt(2.0F), 1.0F), kQf);
}

}  // namespace

Image flip_map(const Image& a, const Image& b) {
  const Opponent opponent_a = opponent_planes(a), opponent_b = opponent_planes(b);
  const std::vector<Rgb> colors_a = seen_colors(opponent_a), colors_b = seen_colors(opponent_b);
  const Features features_a = find_features(opponent_a.planes[0]);
  const Features features_b = find_features(opponent_b.planes[0]);
  Image map(a.width_px, a.height_px, 1);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const float color = color_error(hyab_distance(colors_a[i], colors_b[i]));
    map.values[i] = std::pow(color, 1 - feature_error(features_a, features_b, i));
  }
  return map;
}

Image flip_colors(const Image& map) {
  constexpr std::array<Rgb, 6> kStops{{{0, 0, 0.002F},
                                       {0.08F, 0.004F, 0.16F},
                                       {0.38F, 0.02F, 0.16F},
                                       {0.82F, 0.11F, 0.04F},
                                       {0.98F, 0.5F, 0.03F},
                                       {0.97F, 0.99F, 0.37F}}};
  Image out(map.width_px, map.height_px, 3);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const float place = std::clamp(map.values[i], 0.0F, 1.0F) * float(kStops.size() - 1);
    const std::size_t stop = std::min(std::size_t(place), kStops.size() - 2);
    const float t = place - float(stop);
    const Rgb color = kStops[stop] * (1 - t) + kStops[stop + 1] * t;
    for (int c = 0; c < 3; ++c) out.values[3 * i + std::size_t(c)] = color[c];
  }
  return out;
}

}  // namespace arris
