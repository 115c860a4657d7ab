#include "scene/rounding_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace arris {
namespace {

TEST(RoundingText, reads_radius_percentage_auto_and_none) {
  const auto radius = parse_rounding_text("0.5");
  EXPECT_EQ(radius->method, RoundMethod::exact);
  EXPECT_EQ(std::get<double>(radius->radius), 0.5);
  EXPECT_EQ(std::get<PercentOfInradius>(parse_rounding_text("12.5%")->radius).percent, 12.5);
  EXPECT_TRUE(std::holds_alternative<AutoRadius>(parse_rounding_text("auto")->radius));
  EXPECT_EQ(parse_rounding_text("none")->method, RoundMethod::none);
  EXPECT_EQ(parse_rounding_text("0")->method, RoundMethod::none);
}

TEST(RoundingText, refuses_everything_else) {
  for (const char* text :
       {"", "-1", "1x", " 1", "nan", "inf", "-inf", "0%", "100%", "-5%", "%", "Auto", "1e999"}) {
    EXPECT_FALSE(parse_rounding_text(text)) << text;
  }
  EXPECT_FALSE(make_rounding_settings(-1));
  EXPECT_FALSE(make_rounding_settings(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(make_rounding_settings(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace arris
