#include "io/render_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arris/error.h"
#include "io/picture_exr.h"

namespace arris {
namespace {

using testing::HasSubstr;

RenderPart part(std::vector<SampleRange> samples) {
  return {std::move(samples), 0x0123456789ABCDEF, 7, "path"};
}

std::string join_error(const RenderPart& a, const RenderPart& b) {
  try {
    join_parts(a, "a.exr", b, "b.exr");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(RenderPart, survives_an_exr_file) {
  const RenderPart written = part({{0, 16}, {32, 48}});
  const Picture picture{Image(1, 1, 3), {}};
  const RenderPart read =
      render_part_of(decode_exr(encode_exr(picture, attributes_of(written)), "a"), "a");
  EXPECT_EQ(format_samples(read.samples), "0..16,32..48");
  EXPECT_EQ(read.scene, written.scene);
  EXPECT_EQ(read.seed, 7U);
  EXPECT_EQ(read.integrator, "path");
  EXPECT_EQ(sample_count(read), 32U);
}

TEST(RenderPart, other_pictures_are_no_parts) {
  try {
    render_part_of({}, "photo.exr");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "photo.exr: is no part of a render: it lacks the attribute arris.samples; use "
                 ".exr files that arris render wrote");
  }
}

TEST(RenderPart, damaged_attributes_are_errors) {
  for (const char* samples : {"", "5", "5..5", "9..5", "a..b", "0..16,8..24", "-1..4"}) {
    Attributes attributes = attributes_of(part({{0, 1}}));
    attributes[0].second = samples;
    EXPECT_THROW(render_part_of({{}, attributes}, "a"), Error) << samples;
  }
}

TEST(RenderPart, neighbours_become_one_range) {
  EXPECT_EQ(
      format_samples(join_parts(part({{16, 32}}), "a", part({{0, 16}, {40, 44}}), "b").samples),
      "0..32,40..44");
}

TEST(RenderPart, parts_that_do_not_fit_are_refused) {
  EXPECT_EQ(join_error(part({{0, 16}}), part({{8, 24}})),
            "b.exr: holds the samples 8..16 that are also in a.exr");
  RenderPart other = part({{16, 32}});
  other.seed = 8;
  EXPECT_EQ(join_error(part({{0, 16}}), other), "b.exr: has seed 8, not 7 as a.exr");
  other = part({{16, 32}});
  other.scene = 1;
  EXPECT_THAT(join_error(part({{0, 16}}), other), HasSubstr("shows another scene"));
  other = part({{16, 32}});
  other.integrator = "beam";
  EXPECT_THAT(join_error(part({{0, 16}}), other), HasSubstr("integrator beam, not path"));
}

}  // namespace
}  // namespace arris
