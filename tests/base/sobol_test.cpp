#include "base/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace arris {
namespace {

constexpr std::uint32_t kPixels = 20;

TEST(Sobol, puts_one_of_a_prefix_into_each_interval) {
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    for (int bits = 0; bits <= 10; ++bits) {
      const std::uint32_t count = 1U << unsigned(bits);
      std::set<int> seen;
      for (std::uint32_t i = 0; i < count; ++i) {
        Sampler sampler(3, pixel, 7, i);
        sampler.set_dimension(pixel);
        seen.insert(int(sampler.next_1d() * float(count)));
      }
      ASSERT_EQ(seen.size(), count) << "pixel " << pixel;
    }
  }
}

TEST(Sobol, puts_one_of_a_prefix_into_each_elementary_rectangle) {
  constexpr unsigned kBits = 8;
  constexpr std::uint32_t kCount = 1U << kBits;
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    for (unsigned x_bits = 0; x_bits <= kBits; ++x_bits) {
      std::set<std::uint32_t> seen;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vec2f u = Sampler(0, pixel, 0, i).next_2d();
        const auto x = std::uint32_t(u.x * float(1U << x_bits));
        const auto y = std::uint32_t(u.y * float(1U << (kBits - x_bits)));
        seen.insert(x << (kBits - x_bits) | y);
      }
      ASSERT_EQ(seen.size(), kCount) << "pixel " << pixel << ", " << x_bits << " bits of x";
    }
  }
}

// Aligned blocks of the sequence are stratified like its beginning: parts of a render are as good as wholes.
TEST(Sobol, stratifies_later_blocks_as_well) {
  for (const std::uint32_t first : {64U, 4096U, 0x7fffffc0U, 0xffffffc0U}) {
    std::set<std::uint32_t> seen;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Vec2f u = Sampler(1, 5, 9, first + i).next_2d();
      seen.insert(std::uint32_t(u.x * 8) * 8 + std::uint32_t(u.y * 8));
    }
    EXPECT_EQ(seen.size(), 64U) << first;
  }
}

TEST(Sobol, depends_on_its_key_alone) {
  Sampler a(1, 2, 3, 4);
  a.next_1d();
  a.next_2d();
  a.set_dimension(17);
  Sampler b(1, 2, 3, 4);
  b.set_dimension(17);
  EXPECT_EQ(a.next_2d(), b.next_2d());
  EXPECT_EQ(a.next_1d(), b.next_1d());
}

TEST(Sobol, every_part_of_the_key_matters) {
  const Vec2f base = Sampler(1, 2, 3, 4).next_2d();
  EXPECT_NE(base, Sampler(2, 2, 3, 4).next_2d());
  EXPECT_NE(base, Sampler(1, 3, 3, 4).next_2d());
  EXPECT_NE(base, Sampler(1, 2, 4, 4).next_2d());
  EXPECT_NE(base, Sampler(1, 2, 3, 5).next_2d());
  EXPECT_NE(base, Sampler(1, 3, 2, 4).next_2d());
}

// Mean and variance over pixels at one sample index: each number alone is uniform.
TEST(Sobol, numbers_are_uniform_over_pixels) {
  constexpr std::uint32_t kSide = 200;
  for (const std::uint32_t sample : {0U, 1U, 77U}) {
    double sum = 0;
    double squares = 0;
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const Vec2f u = Sampler(0, x, y, sample).next_2d();
        ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
        sum += double(u.x) + double(u.y);
        squares += double(u.x) * double(u.x) + double(u.y) * double(u.y);
      }
    }
    constexpr double kCount = 2.0 * kSide * kSide;
    const double mean = sum / kCount;
    EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1.0 / 12.0 / kCount));
    EXPECT_NEAR(squares / kCount - mean * mean, 1.0 / 12.0, 0.002);
  }
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - 0.5) * (b[i] - 0.5);
  }
  return sum / double(a.size()) * 12.0;
}

TEST(Sobol, neighbours_and_dimensions_are_not_correlated) {
  constexpr std::uint32_t kSide = 200;
  std::vector<double> here;
  std::vector<double> right;
  std::vector<double> below;
  std::vector<double> next_dimension;
  std::vector<double> next_seed;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      Sampler sampler(0, x, y, 5);
      here.push_back(double(sampler.next_2d().x));
      next_dimension.push_back(double(sampler.next_2d().x));
      right.push_back(double(Sampler(0, x + 1, y, 5).next_2d().x));
      below.push_back(double(Sampler(0, x, y + 1, 5).next_2d().x));
      next_seed.push_back(double(Sampler(1, x, y, 5).next_2d().x));
    }
  }
  const double limit = 4.0 / std::sqrt(double(here.size()));
  EXPECT_LT(std::fabs(correlation(here, right)), limit);
  EXPECT_LT(std::fabs(correlation(here, below)), limit);
  EXPECT_LT(std::fabs(correlation(here, next_dimension)), limit);
  EXPECT_LT(std::fabs(correlation(here, next_seed)), limit);
}

// A product across padded dimensions integrates without bias: 1D numbers and pairs don't follow each other.
TEST(Sobol, integrates_products_across_dimensions) {
  double sum = 0;
  constexpr std::uint32_t kCount = 64;
  constexpr std::uint32_t kPixelCount = 2000;
  for (std::uint32_t pixel = 0; pixel < kPixelCount; ++pixel) {
    for (std::uint32_t i = 0; i < kCount; ++i) {
      Sampler sampler(11, pixel, pixel / 7, i);
      const float a = sampler.next_1d();
      const float b = sampler.next_1d();
      const Vec2f c = sampler.next_2d();
      sum += double(a) * double(b) * double(c.x) * double(c.y);
    }
  }
  EXPECT_NEAR(sum / (kCount * kPixelCount), 1.0 / 16.0, 3e-4);
}

// The reason for scrambling: a smooth integrand's error falls much faster than 1/sqrt(N).
TEST(Sobol, beats_random_numbers_on_smooth_integrands) {
  const auto rms_error = [](std::uint32_t count) {
    double squares = 0;
    for (std::uint32_t pixel = 0; pixel < 200; ++pixel) {
      double sum = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const Vec2f u = Sampler(0, pixel, 3, i).next_2d();
        sum += double(u.x) * double(u.y);
      }
      const double error = sum / count - 0.25;
      squares += error * error;
    }
    return std::sqrt(squares / 200);
  };
  // Random numbers: a factor of 4.
  EXPECT_GT(rms_error(16) / rms_error(256), 25);
}

}  // namespace
}  // namespace arris
