#include "image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "arris/error.h"
#include "arris/math.h"
#include "image/srgb.h"

namespace arris {
namespace {

Image constant(Rgb color, int width = 24, int height = 16) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = color[int(i % 3)];
  return image;
}

Image noise(unsigned seed, int width = 40, int height = 30) {
  std::mt19937 random(seed);
  Image image(width, height, 3);
  for (float& value : image.values) value = float(random() % 1000) / 1000;
  return image;
}

TEST(Compare, equal_pictures_have_no_difference) {
  const ImageDifference d = compare_images(noise(1), noise(1), ValueEncoding::srgb);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_EQ(d.max_error, 0);
  EXPECT_EQ(d.flip, 0);
  EXPECT_EQ(d.psnr_db, std::numeric_limits<double>::infinity());
}

TEST(Compare, one_changed_value_gives_the_errors_of_the_formulas) {
  Image a = constant(Rgb(0.5F), 10, 10);
  Image b = a;
  b.at(7, 3, 1) = 0.8F;
  const ImageDifference d = compare_images(a, b, ValueEncoding::linear);
  EXPECT_NEAR(d.rmse, 0.3 / std::sqrt(300.0), 1e-7);
  EXPECT_NEAR(d.max_error, 0.3, 1e-7);
  EXPECT_EQ(d.max_x, 7);
  EXPECT_EQ(d.max_y, 3);
  EXPECT_EQ(d.peak, 0.5);
  EXPECT_NEAR(d.psnr_db, 20 * std::log10(0.5 / (0.3 / std::sqrt(300.0))), 1e-6);
}

TEST(Compare, encoded_values_are_compared_as_codes) {
  const Image a = constant(Rgb(linear_from_srgb(100.0F / 255)));
  const Image b = constant(Rgb(linear_from_srgb(103.0F / 255)));
  const ImageDifference d = compare_images(a, b, ValueEncoding::srgb);
  EXPECT_NEAR(d.rmse * 255, 3, 1e-4);
  EXPECT_EQ(d.peak, 1);
}

TEST(Compare, different_sizes_are_an_error_that_names_both) {
  try {
    compare_images(constant(Rgb(0.0F), 3, 4), constant(Rgb(0.0F), 4, 3), ValueEncoding::linear);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("3 x 4 pixels"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("4 x 3"), std::string::npos);
  }
}

TEST(Compare, pixels_that_are_not_finite_are_counted_and_left_out) {
  Image a = constant(Rgb(0.5F));
  a.at(1, 1, 2) = std::numeric_limits<float>::quiet_NaN();
  const ImageDifference d = compare_images(a, constant(Rgb(0.5F)), ValueEncoding::linear);
  EXPECT_EQ(d.nonfinite_pixels, 1U);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_TRUE(std::isfinite(d.flip));
  EXPECT_GT(d.flip, 0);
}

// Its largest colour difference is by definition that of pure green and pure blue.
TEST(Flip, is_one_for_green_and_blue) {
  const Image map = flip_map(constant({0, 1, 0}), constant({0, 0, 1}));
  for (const float value : map.values) EXPECT_NEAR(value, 1, 1e-4F);
}

// By hand: HyAB of black and white is 100, of green and blue 203.29 (after Hunt); with q = 0.7 these are
// 25.119 and 41.28, and 0.95 + 0.05 (25.119 − 0.4·41.28) / (0.6·41.28) = 0.9674.
TEST(Flip, of_black_and_white_is_the_value_computed_by_hand) {
  const Image map = flip_map(constant(Rgb(0.0F)), constant(Rgb(1.0F)));
  for (const float value : map.values) EXPECT_NEAR(value, 0.9674F, 1e-3F);
}

TEST(Flip, does_not_depend_on_the_order) {
  const Image a = noise(1), b = noise(2);
  EXPECT_EQ(flip_map(a, b).values, flip_map(b, a).values);
}

TEST(Flip, stays_within_its_range) {
  for (const float value : flip_map(noise(1), noise(2)).values) {
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1);
  }
}

TEST(Flip, grows_with_the_difference) {
  float previous = 0;
  for (const float other : {0.51F, 0.55F, 0.6F, 0.8F, 1.0F}) {
    const float value = flip_map(constant(Rgb(0.5F)), constant(Rgb(other))).values[0];
    EXPECT_GT(value, previous);
    previous = value;
  }
}

// What the measure was made for: the eye averages a fine checkerboard, but sees coarse squares.
TEST(Flip, sees_fine_patterns_less_than_coarse_ones) {
  const auto checkers = [](int size) {
    Image image(96, 96, 3);
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        for (int c = 0; c < 3; ++c)
          image.at(x, y, c) = (x / size + y / size) % 2 == 0 ? 0.3F : 0.7F;
      }
    }
    return image;
  };
  const Image grey = constant(Rgb(0.5F), 96, 96);
  const double fine = compare_images(grey, checkers(1), ValueEncoding::linear).flip;
  const double coarse = compare_images(grey, checkers(16), ValueEncoding::linear).flip;
  EXPECT_LT(fine, 0.5 * coarse);
  EXPECT_NEAR(compare_images(grey, checkers(1), ValueEncoding::linear).rmse,
              compare_images(grey, checkers(16), ValueEncoding::linear).rmse, 1e-6);
}

TEST(Flip, is_strongest_at_a_moved_edge) {
  const auto step = [](int edge) {
    Image image(64, 20, 3);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 64; ++x) {
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = x < edge ? 0.2F : 0.7F;
      }
    }
    return image;
  };
  const Image map = flip_map(step(30), step(34));
  EXPECT_GT(map.at(32, 10, 0), 0.5F);
  EXPECT_LT(map.at(5, 10, 0), 0.01F);
  EXPECT_LT(map.at(60, 10, 0), 0.01F);
}

TEST(Flip, colors_grow_brighter_with_the_error) {
  Image map(11, 1, 1);
  for (int x = 0; x < 11; ++x) map.at(x, 0, 0) = float(x) / 10;
  const Image colors = flip_colors(map);
  for (int x = 1; x < 11; ++x) {
    const auto luminance = [&](int i) {
      return 0.2126F * colors.at(i, 0, 0) + 0.7152F * colors.at(i, 0, 1) +
             0.0722F * colors.at(i, 0, 2);
    };
    EXPECT_GT(luminance(x), luminance(x - 1));
  }
}

}  // namespace
}  // namespace arris
