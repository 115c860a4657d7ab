#include "view/frame_encoder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "arris/io.h"
#include "image/srgb.h"
#include "io/picture_jpeg.h"

namespace arris::view {
namespace {

TEST(ToneMap, shows_what_a_saved_picture_shows_to_within_a_code) {
  constexpr int kWidth = 519, kHeight = 64;
  Image image(kWidth, kHeight, 3);
  // From far below the first code to far above the last one, in many colours.
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float light = std::exp2(-16.0F + 22.0F * float(x) / kWidth);
      image.at(x, y, 0) = light;
      image.at(x, y, 1) = light * float(y) / kHeight;
      image.at(x, y, 2) = light * float(y % 8) / 8;
    }
  }
  image.at(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  image.at(1, 0, 0) = std::numeric_limits<float>::infinity();
  image.at(2, 0, 0) = -1;
  Rgb8Picture shown;
  for (const double exposure : {0.0, 2.5, -4.0}) {
    make_codes(image, exposure, 1, shown);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t at = image.offset(x, y);
        const Rgb saved =
            tone_map({image.values[at], image.values[at + 1], image.values[at + 2]}, exposure);
        const int codes[] = {quantize8(saved.x), quantize8(saved.y), quantize8(saved.z)};
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_LE(std::abs(codes[c] - int(shown.samples[at + c])), 1) << x << "," << y;
        }
      }
    }
  }
}

TEST(JpegEncoder, moving_pictures_are_smaller) {
  Image image(128, 64, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = float(i * 7919 % 101) / 101;
  }
  Rgb8Picture picture;
  make_codes(image, 0, 1, picture);
  JpegEncoder encoder;
  const auto moving = encoder.encode(picture, {60, ChromaDetail::half});
  const auto still = encoder.encode(picture, {90, ChromaDetail::full});
  EXPECT_LT(moving.size() * 3, still.size() * 2);
  EXPECT_EQ(decode_jpeg(still, "still").width_px, 128);
}

}  // namespace
}  // namespace arris::view
