#include "image/picture_sum.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "arris/error.h"

namespace arris {
namespace {

// What one sample adds to a channel: of very different sizes, as light is.
float sample_value(unsigned sample, std::size_t i) {
  std::mt19937 random(sample * 64 + unsigned(i));
  return std::exp2(std::uniform_real_distribution<float>(-40, 20)(random));
}

// Samples first..last of a picture of 4 x 3 pixels, as a renderer sums them.
PictureSum render(unsigned first, unsigned last) {
  PictureSum sum{4, 3, last - first, {}};
  sum.images = {make_image_sum("", 3, 12), make_image_sum("depth", 1, 12),
                make_image_sum("object", 1, 12), make_image_sum("rounded", 1, 12)};
  for (unsigned s = first; s < last; ++s) {
    for (std::size_t i = 0; i < 36; ++i) sum.images[0].sums[i].add(sample_value(s, i));
    for (std::size_t i = 0; i < 12; ++i) {
      const float depth = float(std::mt19937(s * 100 + i)() % 5);  // 0: nothing was hit
      float& nearest = sum.images[1].values[i];
      if (depth > 0 && (nearest == 0 || depth < nearest)) nearest = depth;
      if (s == first) sum.images[2].values[i] = float(std::mt19937(s * 100 + i)() % 3);
      sum.images[3].sums[i].add(float(s % 2));
    }
  }
  return sum;
}

void expect_same(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.color.values, b.color.values);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(a.layers[i].name, b.layers[i].name);
    EXPECT_EQ(a.layers[i].image.values, b.layers[i].image.values) << a.layers[i].name;
  }
}

TEST(PictureSum, parts_of_any_size_make_the_whole_bit_by_bit) {
  const Picture whole = pack_sum(render(0, 32));
  for (const auto& cuts :
       std::vector<std::vector<unsigned>>{{0, 16, 32}, {0, 1, 32}, {0, 5, 6, 9, 32}}) {
    PictureSum sum;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const PictureSum part = render(cuts[i], cuts[i + 1]);
      add_sum(sum, unpack_sum(pack_sum(part), part.samples));
    }
    EXPECT_EQ(sum.samples, 32U);
    expect_same(pack_sum(sum), whole);
  }
}

TEST(PictureSum, packing_loses_nothing) {
  PictureSum sum = render(0, 7);
  // The ends of what a sum can hold.
  const auto largest = ExactSum::Units(1) << 120;
  sum.images[0].sums[0] = ExactSum::from_units(largest - 1);
  sum.images[0].sums[1] = ExactSum::from_units(1 - largest);
  sum.images[0].sums[2] = ExactSum::from_units(largest / 3 + largest / 3);
  const Picture packed = pack_sum(sum);
  EXPECT_TRUE(holds_sum(packed));
  const PictureSum read = unpack_sum(packed, sum.samples);
  ASSERT_EQ(read.images.size(), sum.images.size());
  for (std::size_t i = 0; i < sum.images.size(); ++i) {
    EXPECT_EQ(read.images[i].name, sum.images[i].name);
    EXPECT_EQ(read.images[i].values, sum.images[i].values);
    EXPECT_TRUE(read.images[i].sums == sum.images[i].sums);
  }
}

TEST(PictureSum, pictures_without_sums_are_joined_to_the_rounding_of_their_floats) {
  const Picture whole = mean_picture(render(0, 32));
  EXPECT_FALSE(holds_sum(whole));
  PictureSum sum;
  add_sum(sum, sum_of_mean(mean_picture(render(0, 5)), 5));
  add_sum(sum, sum_of_mean(mean_picture(render(5, 32)), 27));
  const Picture joined = mean_picture(sum);
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_NEAR(joined.color.values[i], whole.color.values[i], 1e-6F * whole.color.values[i]);
  }
  EXPECT_EQ(joined.layers[0].image.values, whole.layers[0].image.values);
  EXPECT_EQ(joined.layers[1].image.values, whole.layers[1].image.values);
}

TEST(PictureSum, parts_that_differ_are_errors) {
  const PictureSum sum = render(0, 1);
  const auto expect_refused = [&](PictureSum other) {
    PictureSum into = sum;
    EXPECT_THROW(add_sum(into, other), Error);
  };
  expect_refused({3, 4, 1, sum.images});
  PictureSum other = sum;
  other.images.pop_back();
  expect_refused(other);
  other = sum;
  other.images[3].name = "albedo";
  expect_refused(other);
}

TEST(PictureSum, sums_that_no_render_makes_are_errors) {
  Picture packed = pack_sum(render(0, 1));
  packed.layers.back().image.values[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)unpack_sum(packed, 1), Error);
  packed.layers.pop_back();
  EXPECT_THROW((void)unpack_sum(packed, 1), Error);
}

}  // namespace
}  // namespace arris
