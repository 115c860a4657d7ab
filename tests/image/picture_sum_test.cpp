#include "image/picture_sum.h"

#include <gtest/gtest.h>

#include <random>

#include "arris/error.h"

namespace arris {
namespace {

// The mean of samples first..last of a picture of 4 x 3 pixels, as a renderer makes it.
Picture render(unsigned first, unsigned last) {
  Picture picture{Image(4, 3, 3), {{"depth", Image(4, 3, 1)}, {"object", Image(4, 3, 1)}}};
  for (std::size_t i = 0; i < 36; ++i) {
    double sum = 0;
    for (unsigned s = first; s < last; ++s) sum += double(std::mt19937(s * 64 + i)() % 1000) / 7;
    picture.color.values[i] = float(sum / (last - first));
  }
  for (std::size_t i = 0; i < 12; ++i) {
    float nearest = 0;
    for (unsigned s = first; s < last; ++s) {
      const float depth = float(std::mt19937(s * 100 + i)() % 5);  // 0: nothing was hit
      if (depth > 0 && (nearest == 0 || depth < nearest)) nearest = depth;
    }
    picture.layers[0].image.values[i] = nearest;
    picture.layers[1].image.values[i] = float(std::mt19937(first * 100 + i)() % 3);
  }
  return picture;
}

TEST(PictureSum, parts_of_any_size_make_the_whole) {
  const Picture whole = render(0, 32);
  for (const auto& cuts :
       std::vector<std::vector<unsigned>>{{0, 16, 32}, {0, 1, 32}, {0, 5, 9, 32}}) {
    PictureSum sum;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      add_picture(sum, render(cuts[i], cuts[i + 1]), cuts[i + 1] - cuts[i]);
    }
    const Picture joined = mean_picture(sum);
    for (std::size_t i = 0; i < 36; ++i) {
      EXPECT_NEAR(joined.color.values[i], whole.color.values[i], 1e-6F * whole.color.values[i]);
    }
    EXPECT_EQ(joined.layers[0].image.values, whole.layers[0].image.values);
    EXPECT_EQ(joined.layers[1].image.values, whole.layers[1].image.values);
  }
}

TEST(PictureSum, packing_loses_nothing) {
  PictureSum sum;
  for (unsigned i = 0; i < 7; ++i) add_picture(sum, render(3 * i, 3 * i + 3), 3);
  const PictureSum read = unpack_sum(pack_sum(sum), sum.samples);
  ASSERT_EQ(read.images.size(), sum.images.size());
  for (std::size_t i = 0; i < sum.images.size(); ++i) {
    EXPECT_EQ(read.images[i].name, sum.images[i].name);
    EXPECT_EQ(read.images[i].values, sum.images[i].values);
  }
}

TEST(PictureSum, parts_that_differ_are_errors) {
  PictureSum sum;
  add_picture(sum, render(0, 1), 1);
  EXPECT_THROW(add_picture(sum, {Image(3, 4, 3), {}}, 1), Error);
  EXPECT_THROW(add_picture(sum, {Image(4, 3, 3), {}}, 1), Error);
  Picture other = render(1, 2);
  other.layers[0].name = "normal";
  EXPECT_THROW(add_picture(sum, other, 1), Error);
  EXPECT_THROW(unpack_sum(render(0, 1), 1), Error);
}

}  // namespace
}  // namespace arris
