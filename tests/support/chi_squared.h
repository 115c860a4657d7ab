// chi_squared.h — does a sampler draw what its pdf says?
// What       chi_squared_test() throws samples into equal-area cells of the sphere (bands of cos θ, sectors
//            of φ), integrates the pdf over each cell, and compares the counts by Pearson's test. Samples
//            that fail are one more cell, which the pdf has to leave room for.
// In         draw(std::mt19937&) → std::optional<Vec3f>, a unit direction; pdf(Vec3f) → density per solid
//            angle
// Limits     cells expected to hold fewer than kMinExpected samples are pooled
// Source     p-value: E. Wilson, M. Hilferty, "The Distribution of Chi-Square" (1931)
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "arris/math.h"

namespace arris::test {

inline constexpr double kMinExpected = 10;

struct ChiSquaredSettings {
  int bands = 16, sectors = 32;
  int samples = 100'000;
  unsigned seed = 1;
  // Chance that a correct sampler fails, shared among `tests` of its kind (Bonferroni).
  double significance = 0.01;
  int tests = 1;
};

struct ChiSquaredResult {
  double p_value = 0;
  double pdf_integral = 0;
  bool passed = false;
};

inline Vec3f sphere_direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  return {float(sin_theta * std::cos(phi)), float(sin_theta * std::sin(phi)), float(cos_theta)};
}

// A rectangle of (θ, φ).
struct SphereCell {
  double theta0 = 0, theta1 = kPi, phi0 = 0, phi1 = 2 * kPi;
};

namespace detail {

// Cells are refined at least so far, that no narrow lobe slips between the points: 4 · 2³ along each side.
inline constexpr int kMinDepth = 3;
inline constexpr int kMaxDepth = 8;

template <class Function>
double midpoint_integral(const SphereCell& c, const Function& f) {
  constexpr int kSide = 4;
  double sum = 0;
  for (int i = 0; i < kSide; ++i) {
    const double theta = std::lerp(c.theta0, c.theta1, (i + 0.5) / kSide);
    for (int j = 0; j < kSide; ++j) {
      const double phi = std::lerp(c.phi0, c.phi1, (j + 0.5) / kSide);
      sum += double(f(sphere_direction(std::cos(theta), phi))) * std::sin(theta);
    }
  }
  return sum * (c.theta1 - c.theta0) * (c.phi1 - c.phi0) / (kSide * kSide);
}

template <class Function>
double refine(const SphereCell& c, const Function& f, double coarse, double tolerance, int depth) {
  const double theta = 0.5 * (c.theta0 + c.theta1);
  const double phi = 0.5 * (c.phi0 + c.phi1);
  const SphereCell parts[4] = {{c.theta0, theta, c.phi0, phi},
                               {theta, c.theta1, c.phi0, phi},
                               {c.theta0, theta, phi, c.phi1},
                               {theta, c.theta1, phi, c.phi1}};
  double values[4] = {};
  double fine = 0;
  if (depth >= kMinDepth - 1) {
    for (int i = 0; i < 4; ++i) {
      values[i] = midpoint_integral(parts[i], f);
      fine += values[i];
    }
    if (depth >= kMinDepth && (depth == kMaxDepth || std::fabs(fine - coarse) < tolerance)) {
      return fine;
    }
  }
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    sum += refine(parts[i], f, values[i], 0.5 * tolerance, depth + 1);
  }
  return sum;
}

}  // namespace detail

// ∫ f dω over the cell, adaptively.
template <class Function>
double integrate_cell(const SphereCell& cell, const Function& f, double tolerance = 1e-6) {
  return detail::refine(cell, f, 0.0, tolerance, 0);
}

// Bands of equal area, from the lower pole.
inline SphereCell sphere_cell(int band, int sector, int bands, int sectors) {
  return {std::acos(std::min(1.0, -1.0 + 2.0 * (band + 1) / bands)),
          std::acos(-1.0 + 2.0 * band / bands), 2.0 * kPi * sector / sectors,
          2.0 * kPi * (sector + 1) / sectors};
}

// ∫ f dω over the sphere.
template <class Function>
double integrate_sphere(const Function& f, double tolerance = 1e-6) {
  constexpr int kBands = 16;
  constexpr int kSectors = 32;
  double sum = 0;
  for (int band = 0; band < kBands; ++band) {
    for (int sector = 0; sector < kSectors; ++sector) {
      sum += integrate_cell(sphere_cell(band, sector, kBands, kSectors), f, tolerance);
    }
  }
  return sum;
}

// The chance of a chi-squared variable of that many degrees of freedom to be larger.
inline double chi_squared_p_value(double statistic, int degrees) {
  const double k = degrees;
  const double z =
      (std::cbrt(statistic / k) - (1.0 - 2.0 / (9.0 * k))) / std::sqrt(2.0 / (9.0 * k));
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

inline double compare_counts(const std::vector<double>& expected,
                             const std::vector<double>& observed) {
  double statistic = 0;
  int cells = 0;
  double pooled_expected = 0;
  double pooled_observed = 0;
  const auto add = [&](double e, double o) {
    statistic += (o - e) * (o - e) / e;
    ++cells;
  };
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] >= kMinExpected) {
      add(expected[i], observed[i]);
    } else {
      pooled_expected += expected[i];
      pooled_observed += observed[i];
    }
  }
  if (pooled_expected >= kMinExpected) {
    add(pooled_expected, pooled_observed);
  } else if (pooled_observed > 5.0 * kMinExpected) {
    return 0.0;  // many samples where there should be next to none
  }
  return cells > 1 ? chi_squared_p_value(statistic, cells - 1) : 1.0;
}

template <class Draw, class Pdf>
ChiSquaredResult chi_squared_test(const Draw& draw, const Pdf& pdf,
                                  const ChiSquaredSettings& settings = {}) {
  const std::size_t failed = std::size_t(settings.bands) * std::size_t(settings.sectors);
  std::vector<double> observed(failed + 1);
  std::mt19937 random(settings.seed);
  for (int i = 0; i < settings.samples; ++i) {
    const std::optional<Vec3f> w = draw(random);
    if (!w) {
      ++observed[failed];
      continue;
    }
    const double turn = std::atan2(double(w->y), double(w->x)) / (2.0 * kPi);
    const int band =
        std::clamp(int((double(w->z) + 1.0) * 0.5 * settings.bands), 0, settings.bands - 1);
    const int sector =
        std::clamp(int((turn < 0 ? turn + 1.0 : turn) * settings.sectors), 0, settings.sectors - 1);
    ++observed[std::size_t(band) * std::size_t(settings.sectors) + std::size_t(sector)];
  }
  std::vector<double> expected(failed + 1);
  ChiSquaredResult result;
  for (int band = 0; band < settings.bands; ++band) {
    for (int sector = 0; sector < settings.sectors; ++sector) {
      const double integral =
          integrate_cell(sphere_cell(band, sector, settings.bands, settings.sectors), pdf);
      expected[std::size_t(band) * std::size_t(settings.sectors) + std::size_t(sector)] =
          integral * settings.samples;
      result.pdf_integral += integral;
    }
  }
  expected[failed] = std::max(0.0, 1.0 - result.pdf_integral) * settings.samples;
  result.p_value = compare_counts(expected, observed);
  result.passed = result.p_value > settings.significance / settings.tests;
  return result;
}

inline float uniform(std::mt19937& random) {
  return float(random() >> 8U) * 0x1p-24F;
}
inline Vec2f uniform_2d(std::mt19937& random) {
  const float x = uniform(random);
  return {x, uniform(random)};
}

}  // namespace arris::test
