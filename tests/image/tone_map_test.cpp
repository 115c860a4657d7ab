#include <gtest/gtest.h>

#include <cmath>

#include "arris/io.h"
#include "image/srgb.h"

namespace arris {
namespace {

TEST(Srgb, curves_are_inverse_and_codes_survive) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(quantize8(srgb_from_linear(linear_from_srgb(float(code) / 255))), code);
  }
}

TEST(Srgb, has_the_published_values) {
  EXPECT_NEAR(srgb_from_linear(0.18F), 0.4613F, 1e-4F);
  EXPECT_NEAR(srgb_from_linear(0.001F), 0.01292F, 1e-6F);
  EXPECT_NEAR(linear_from_srgb(0.5F), 0.2140F, 1e-4F);
}

// A base colour lit to its own value and 4% reflected light on top is shown as the base colour.
TEST(ToneMap, shows_base_colours_as_they_are) {
  for (const Rgb base : {Rgb{0.7F, 0.1F, 0.1F}, Rgb{0.2F, 0.5F, 0.75F}, Rgb(0.18F)}) {
    const Rgb shown = tone_map(base + Rgb(0.04F), 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(linear_from_srgb(shown[c]), base[c], 1e-4F);
  }
}

TEST(ToneMap, rises_and_stays_below_white) {
  float previous = -1;
  for (float value = 0; value < 100; value = value * 1.1F + 0.01F) {
    const float shown = tone_map(Rgb(value), 0).x;
    EXPECT_GT(shown, previous) << value;
    EXPECT_LT(shown, 1) << value;
    previous = shown;
  }
}

TEST(ToneMap, is_continuous_where_its_pieces_meet) {
  for (const float joint : {0.08F, 0.8F}) {
    EXPECT_NEAR(tone_map(Rgb(joint - 1e-5F), 0).x, tone_map(Rgb(joint + 1e-5F), 0).x, 1e-3F);
  }
}

TEST(ToneMap, keeps_the_order_of_channels) {
  for (const float scale : {0.1F, 1.0F, 3.0F, 30.0F}) {
    const Rgb shown = tone_map(Rgb{1.0F, 0.4F, 0.1F} * scale, 0);
    EXPECT_GE(shown.x, shown.y);
    EXPECT_GE(shown.y, shown.z);
  }
}

TEST(ToneMap, exposure_is_in_stops) {
  EXPECT_EQ(tone_map(Rgb{0.4F, 0.2F, 0.1F}, 0), tone_map(Rgb{0.1F, 0.05F, 0.025F}, 2));
}

}  // namespace
}  // namespace arris
