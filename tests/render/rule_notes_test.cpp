// rule_notes_test.cpp — rules for radii that match no edge are told of
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"
#include "support/render_scenes.h"

namespace arris {
namespace {

std::vector<std::string> notes_of(const Scene& scene) {
  const auto prepared = prepare_scene(scene);
  std::vector<std::string> notes;
  for (const RoundingSummary& summary : prepare_stats(*prepared).rounding) {
    for (const RoundingNote& note : summary.notes) notes.push_back(note.text());
  }
  return notes;
}

EdgeRule rule_in(Vec3d low, Vec3d high, double radius) {
  EdgeRule rule;
  rule.radius = radius;
  rule.box = {low, high};
  return rule;
}

// Cubes of edge 2 and 1 about their own origins.
Scene two_cubes(std::vector<EdgeRule> rules) {
  Camera camera;
  camera.position = {2, -3, 2};
  Scene scene = test::make_empty_scene(camera);
  test::add_object(scene, test::make_box_mesh({1, 1, 1}), test::make_lambert(1));
  test::add_object(scene, test::make_box_mesh({0.5, 0.5, 0.5}), test::make_lambert(1),
                   test::translation({3, 0, 0}));
  scene.rounding.emplace();
  scene.rounding->method = RoundMethod::exact;
  scene.rounding->radius = 0.1;
  scene.rounding->rules = std::move(rules);
  return scene;
}

TEST(RuleNotes, tell_of_rules_that_match_no_edge_of_any_object) {
  const EdgeRule top_of_first = rule_in({-1, -1, 1}, {1, 1, 1}, 0.2);
  const EdgeRule nowhere = rule_in({-1, -1, 2}, {1, 1, 2}, 0.2);
  EXPECT_TRUE(notes_of(two_cubes({top_of_first})).empty());
  const std::vector<std::string> both(2, "rule 2 matches no edge to be rounded");
  EXPECT_EQ(notes_of(two_cubes({top_of_first, nowhere})), both);
}

TEST(RuleNotes, tell_of_kinds_that_are_not_rounded) {
  EdgeRule concave;
  concave.radius = 0.05;
  concave.kind = RoundEdges::concave;
  Scene scene = two_cubes({});
  scene.objects[0].rounding = scene.rounding;
  scene.objects[0].rounding->rules = {concave};
  const std::vector<std::string> one{"rule 1 matches no edge to be rounded"};
  EXPECT_EQ(notes_of(scene), one);
}

}  // namespace
}  // namespace arris
