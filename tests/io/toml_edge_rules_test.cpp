// toml_edge_rules_test.cpp — rules of scene files for the radii of single edges
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "arris/error.h"
#include "io/toml_scene.h"
#include "support/error_message.h"

namespace arris {
namespace {

using testing::HasSubstr;

Scene read_rules(const std::string& text) {
  const auto no_model = [](const std::filesystem::path& path) -> Scene {
    throw Error(Error::Kind::input, path.string(), "no such file");
  };
  return read_toml_scene(text, "s.toml", "/nonexistent", no_model);
}

std::string refusal_of_box(const std::string& rest) {
  return test::refusal_of(read_rules, "[[object]]\nshape = \"box\"\n" + rest);
}

TEST(TomlEdgeRules, reads_rules_for_single_edges) {
  const Scene scene = read_rules(R"(
[round]
radius = 0.5
on_overlap = "clamp"
[[round.rules]]
radius = 0
[[round.rules]]
radius = "50%"
angle = [80, 100]
kind = "concave"
box = [[1, 0, 0.5], [0, 2, 0]]
edges = [[[0, 0, 0], [0, 0, 1]], [[0.5, 0, 0], [0.5, 1, 0]]]
[[object]]
shape = "box"
round = 0.25
[[object]]
shape = "box"
round = { on_overlap = "report", rules = [{ radius = 0.125 }] }
[[object]]
shape = "box"
round = { rules = [] }
)");
  EXPECT_EQ(scene.rounding->on_overlap, OnOverlap::clamp);
  const std::vector<EdgeRule> rules = {
      {},
      {.radius = 0.5,
       .is_part = true,
       .turn = {{radians(80), radians(100)}},
       .kind = RoundEdges::concave,
       .box = {{Vec3d(0, 0, 0), Vec3d(1, 2, 0.5)}},
       .segments = {{Vec3d(0, 0, 0), Vec3d(0, 0, 1)}, {Vec3d(0.5, 0, 0), Vec3d(0.5, 1, 0)}}}};
  EXPECT_EQ(scene.rounding->rules, rules);
  const auto rounding = [&](std::size_t i) { return *scene.objects.at(i).rounding; };
  EXPECT_EQ(rounding(0).rules, rules);
  EXPECT_EQ(rounding(0).on_overlap, OnOverlap::clamp);
  EXPECT_EQ(rounding(1).rules, std::vector<EdgeRule>{{.radius = 0.125}});
  EXPECT_EQ(rounding(1).on_overlap, OnOverlap::report);
  EXPECT_TRUE(rounding(2).rules.empty());
}

TEST(TomlEdgeRules, names_what_is_wrong_with_rules_for_edges) {
  const auto refusal_of_rule = [](const std::string& rule) {
    return refusal_of_box("round = { rules = [{ radius = 1 }, { " + rule + " }] }\n");
  };
  EXPECT_THAT(refusal_of_rule("angle = [0, 90]"), HasSubstr("round rule 2: \"radius\" is missing"));
  EXPECT_THAT(refusal_of_rule("radius = -1"),
              HasSubstr("s.toml:3:47: round rule 2 radius: is -1; use 0 to 1e+09"));
  for (const char* radius : {"\"-5%\"", "\"auto\"", "\"inf%\"", "\"3\""}) {
    EXPECT_THAT(refusal_of_rule(std::string("radius = ") + radius),
                HasSubstr("round rule 2 radius: must be a number of 0 or more, or a percentage"));
  }
  EXPECT_THAT(refusal_of_rule("radius = 1, angle = [0, 181]"), HasSubstr("use 0 to 180"));
  EXPECT_THAT(refusal_of_rule("radius = 1, angle = [90, 30]"),
              HasSubstr("round rule 2 angle: is [90, 30]; the least comes first"));
  EXPECT_THAT(refusal_of_rule("radius = 1, kind = \"sharp\""),
              HasSubstr("round rule 2 kind: \"sharp\" is not one of convex, concave, both"));
  EXPECT_THAT(refusal_of_rule("radius = 1, box = [0, 0, 0]"),
              HasSubstr("round rule 2 box: must be two points like"));
  EXPECT_THAT(refusal_of_rule("radius = 1, box = [[0, 0, 0], [1, 1]]"),
              HasSubstr("box: has 2 numbers; 3 are needed"));
  EXPECT_THAT(refusal_of_rule("radius = 1, box = [[0, 0, 0], [1, 1, 2e9]]"),
              HasSubstr("box: is 2000000000; use -1e+09 to 1e+09"));
  for (const char* edges : {"[]", "3"}) {
    EXPECT_THAT(refusal_of_rule(std::string("radius = 1, edges = ") + edges),
                HasSubstr("edges: must be an array of segments like"));
  }
  EXPECT_THAT(refusal_of_rule("radius = 1, edges = [[0, 0, 1]]"),
              HasSubstr("edges: must be two points like"));
  EXPECT_THAT(refusal_of_rule("radius = 1, edges = [[[0, 0, 1], [0, 0, 1]]]"),
              HasSubstr("the segment's ends are one point"));
  EXPECT_THAT(refusal_of_rule("radius = 1, edge = 3"),
              HasSubstr("round rule 2: unknown key \"edge\"; did you mean \"edges\"?"));
  EXPECT_THAT(refusal_of_box("round = { rules = [3] }\n"),
              HasSubstr("round rule 1: must be a table with a radius"));
  EXPECT_THAT(refusal_of_box("round = { rules = 3 }\n"),
              HasSubstr("rules: must be an array of tables"));
  EXPECT_THAT(test::refusal_of(read_rules, "[round]\non_overlap = \"clip\"\n"),
              HasSubstr("on_overlap: \"clip\" is not one of report, clamp"));
}

}  // namespace
}  // namespace arris
