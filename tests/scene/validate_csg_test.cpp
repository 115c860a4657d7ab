#include "scene/validate_csg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "arris/render.h"
#include "scene/scene_fingerprint.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Scene scene_of(CsgPrimitive primitive) {
  Scene scene;
  scene.materials.resize(2);
  CsgTree& tree = scene.csg_trees.emplace_back();
  tree.name = "part";
  tree.leaves.push_back({std::move(primitive), {}, {}});
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {1}});
  tree.nodes.push_back({0, CsgOperation::unite, {}});
  scene.objects.emplace_back().csg = CsgId{0};
  return scene;
}

const CsgMesh kTetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
const CsgRegion kTriangle{{{{0, 0}, {1, 0}, {0, 1}}}};

TEST(ValidateCsg, takes_sound_primitives_without_a_mesh) {
  for (const CsgPrimitive& sound :
       {CsgPrimitive(CsgSphere{}), CsgPrimitive(CsgBox{Vec3d(0), Vec3d(1)}),
        CsgPrimitive(CsgCone{}), CsgPrimitive(CsgTorus{}), CsgPrimitive(CsgHalfSpace{}),
        CsgPrimitive(kTetrahedron), CsgPrimitive(CsgPrism{kTriangle, 0, 1, {0, 0}}),
        CsgPrimitive(CsgRevolution{kTriangle})}) {
    EXPECT_THAT(validate_scene(scene_of(sound)), IsEmpty());
  }
}

TEST(ValidateCsg, names_what_is_wrong_with_a_primitive) {
  const CsgRegion left{{{{-1, 0}, {1, 0}, {0, 1}}}};
  CsgMesh open = kTetrahedron;
  open.triangles.pop_back();
  const std::pair<CsgPrimitive, std::string> cases[] = {
      {CsgSphere{0}, "sphere's radius"},
      {CsgBox{Vec3d(1), Vec3d(0)}, "low corner"},
      {CsgCone{0, 1, 0, 0}, "cone's radii"},
      {CsgCone{1, 1, 1, 1}, "cone needs a height"},
      {CsgTorus{1, -1}, "torus"},
      {CsgHalfSpace{{0, 0, 2}, 0}, "normal must have the length 1"},
      {CsgPolyhedron{}, "at least 4 faces"},
      {open, "isn't closed"},
      {CsgPrism{{}, 0, 1, {1, 1}}, "no outline"},
      {CsgPrism{kTriangle, 0, 1, {-1, 1}}, "scale"},
      {CsgRevolution{left}, "x of at least 0"},
      {CsgRounded{}, "rounding radius"},
      {CsgSphere{2e9}, "sphere's radius"}};
  for (const auto& [primitive, what] : cases) {
    EXPECT_THAT(validate_scene(scene_of(primitive)),
                ElementsAre(AllOf(HasSubstr("CSG tree \"part\": primitive 0"), HasSubstr(what))));
  }
}

TEST(ValidateCsg, names_what_is_wrong_with_a_tree) {
  Scene scene = scene_of(CsgSphere{});
  scene.csg_trees[0].nodes[1].leaf = 7;
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr("node 1: a node names no primitive")));
  scene = scene_of(CsgSphere{});
  scene.csg_trees[0].nodes[0].children = {0};
  EXPECT_THAT(validate_scene(scene),
              ElementsAre(HasSubstr("node 0: a node's child must come after it")));
  scene = scene_of(CsgSphere{});
  scene.csg_trees[0].leaves[0].object_from_primitive.linear.z = {};
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr("flattens")));
  scene = scene_of(CsgSphere{});
  scene.csg_trees[0].leaves[0].material.index = 2;
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr("material")));
  scene = scene_of(CsgSphere{});
  scene.objects[0].csg = CsgId{1};
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr("uses CSG tree 1, but there are 1")));
  scene = scene_of(CsgSphere{});
  scene.csg_trees[0].nodes.clear();
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr("has no nodes")));
}

TEST(SceneFingerprint, tells_csg_trees_apart) {
  std::set<std::uint64_t> seen;
  std::vector<Scene> scenes{scene_of(CsgSphere{}),
                            scene_of(CsgSphere{2}),
                            scene_of(CsgCone{}),
                            scene_of(CsgTorus{}),
                            scene_of(CsgPrism{kTriangle, 0, 1, {1, 1}}),
                            scene_of(CsgPrism{kTriangle, 0, 2, {1, 1}}),
                            scene_of(CsgRevolution{kTriangle}),
                            scene_of(kTetrahedron)};
  scenes.push_back(scenes[0]);
  scenes.back().csg_trees[0].nodes[0].operation = CsgOperation::intersect;
  scenes.push_back(scenes[0]);
  scenes.back().csg_trees[0].leaves[0].material.index = 1;
  scenes.push_back(scenes[0]);
  scenes.back().csg_trees[0].leaves[0].object_from_primitive.translation.x = 1e-9;
  for (const Scene& scene : scenes) EXPECT_TRUE(seen.insert(scene_fingerprint(scene)).second);
  // Names say nothing.
  scenes[0].csg_trees[0].name = "other";
  EXPECT_FALSE(seen.insert(scene_fingerprint(scenes[0])).second);
}

}  // namespace
}  // namespace arris
