// Hidden objects, [[object.part]], [ground] and [material.default] of scene files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "arris/error.h"
#include "geometry/shapes.h"
#include "io/toml_scene.h"
#include "support/error_message.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Two of three objects have the same name; one material is as where a file has none.
Scene three_part_model() {
  Scene model;
  model.meshes = {make_box_mesh({1, 1, 1})};
  model.materials.resize(2);
  model.materials[0].name = "default";
  model.materials[1].name = "paint";
  model.materials[1].metallic = 1;
  model.objects.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    model.objects[i].name = i == 0 ? "lid" : "leg";
    model.objects[i].world_from_object.translation = {double(i), 0, 0};
  }
  model.objects[2].material = MaterialId{1};
  return model;
}

Scene read(const std::string& text) {
  return read_toml_scene(text, "s.toml", "/nonexistent",
                         [](const std::filesystem::path&) { return three_part_model(); });
}

std::string refusal(const std::string& text) {
  return test::refusal_of(read, text);
}

const std::string kFile = "[[object]]\nfile = \"m.glb\"\n";
const std::string kPart = "[[object.part]]\n";

TEST(TomlPart, automatic_radii_are_bounded_by_object_and_by_part) {
  const Scene scene =
      read(kFile + "auto_radius = 0.5\n" + kPart + "number = 2\nauto_radius = 0.25\n" +
           "[[object]]\nshape = \"box\"\nauto_radius = 2\n[[object]]\nshape = \"box\"\n");
  ASSERT_EQ(scene.objects.size(), 5U);
  EXPECT_EQ(scene.objects[0].auto_radius, 0.5);
  EXPECT_EQ(scene.objects[1].auto_radius, 0.25);
  EXPECT_EQ(scene.objects[2].auto_radius, 0.5);
  EXPECT_EQ(scene.objects[3].auto_radius, 2);
  EXPECT_EQ(scene.objects[4].auto_radius, std::nullopt);
  EXPECT_THAT(refusal(kFile + "auto_radius = 0\n"), HasSubstr("auto_radius"));
}

TEST(TomlPart, says_what_is_otherwise_with_a_part) {
  const Scene scene =
      read("[material.brass]\nmetallic = 0.5\n" + kFile + "translate = [0, 0, 5]\nround = 0.1\n" +
           kPart + "number = 1\nround = 0.2\nmaterial = \"brass\"\n" + kPart +
           "number = 3\nmatrix = [[1, 0, 0, 7], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, "
           "0, 1]]\n");
  ASSERT_EQ(scene.objects.size(), 3U);
  EXPECT_EQ(scene.objects[0].rounding->radius, Radius(0.2));
  EXPECT_EQ(scene.objects[1].rounding->radius, Radius(0.1));
  EXPECT_EQ(scene.materials[scene.objects[0].material.index].name, "brass");
  EXPECT_EQ(scene.materials[scene.objects[2].material.index].name, "paint");
  EXPECT_EQ(scene.objects[1].world_from_object.translation, Vec3d(1, 0, 5));
  // instead of where the file has it; the object's own place comes after
  EXPECT_EQ(scene.objects[2].world_from_object.translation, Vec3d(7, 0, 5));
  EXPECT_EQ(scene.objects[2].world_from_object.linear.y, Vec3d(0, 2, 0));
}

TEST(TomlPart, means_all_parts_of_its_name_and_later_ones_go_before_earlier_ones) {
  const Scene scene = read(kFile + kPart + "name = \"leg\"\nhidden = true\nround = 0.5\n" + kPart +
                           "number = 3\nhidden = false\n");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "m/lid");
  EXPECT_EQ(scene.objects[1].name, "m/leg");
  EXPECT_EQ(scene.objects[1].world_from_object.translation, Vec3d(2, 0, 0));
  EXPECT_EQ(scene.objects[1].rounding->radius, Radius(0.5));
  EXPECT_FALSE(scene.objects[0].rounding);
}

TEST(TomlPart, hidden_objects_are_not_there) {
  const Scene scene = read("[[object]]\nshape = \"box\"\nhidden = true\n" + kFile +
                           "hidden = true\n" + "[[object]]\nshape = \"cone\"\nhidden = false\n");
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "cone");
}

TEST(TomlPart, objects_know_where_they_come_from) {
  const Scene scene = read("[[object]]\nshape = \"box\"\nhidden = true\n" + kFile + kPart +
                           "number = 2\nhidden = true\n" + kFile);
  ASSERT_EQ(scene.objects.size(), 5U);
  EXPECT_EQ(scene.objects[0].origin.entry, 1U);
  EXPECT_EQ(scene.objects[1].origin.part, 2U);
  EXPECT_EQ(scene.objects[2].origin.entry, 2U);
  EXPECT_EQ(scene.objects[3].origin.part, 1U);
}

TEST(TomlPart, what_is_wrong_is_named) {
  EXPECT_THAT(refusal(kFile + kPart + "number = 4\n"),
              AllOf(HasSubstr("s.toml:4:10"), HasSubstr("is 4; use 1 to 3")));
  EXPECT_THAT(refusal(kFile + kPart + "name = \"lids\"\n"), HasSubstr("did you mean \"lid\""));
  EXPECT_THAT(refusal(kFile + kPart + "hidden = true\n"),
              HasSubstr("give either \"name\" or \"number\""));
  EXPECT_THAT(refusal(kFile + kPart + "number = 1\nhiden = true\n"), HasSubstr("\"hidden\""));
  EXPECT_THAT(refusal(kFile + kPart + "number = 1\nscale = 0\n"), HasSubstr("flattens"));
  EXPECT_THAT(refusal(kFile + kPart + "number = 1\nmaterial = \"x\"\n"),
              HasSubstr("no [material.…] named"));
  EXPECT_THAT(refusal(kFile + "part = 3\n"), HasSubstr("[[part]]"));
  EXPECT_THAT(refusal(kFile + "part = [3]\n"), HasSubstr("[[object.part]]"));
  EXPECT_THAT(refusal("[[object]]\nshape = \"box\"\n" + kPart + "number = 1\n"),
              HasSubstr("unknown key \"part\""));
  EXPECT_THAT(refusal(kFile + "hidden = 1\n"), HasSubstr("must be true or false"));
  EXPECT_THAT(refusal(kFile + "hidden = true\n"), HasSubstr("all objects are hidden"));
}

TEST(TomlPart, the_default_material_is_that_of_parts_without_one) {
  EXPECT_EQ(read(kFile).materials[read(kFile).objects[0].material.index].roughness, 0.5F);
  const Scene scene = read("[material.default]\nroughness = 0.125\n" + kFile);
  EXPECT_EQ(scene.materials[scene.objects[0].material.index].roughness, 0.125F);
  EXPECT_EQ(scene.materials[scene.objects[2].material.index].roughness, 0.5F);
}

TEST(TomlGround, has_a_centre_and_a_radius) {
  EXPECT_FALSE(read(kFile).ground);
  EXPECT_EQ(read("[ground]\ncenter = [1, 2, 3]\nradius = 4\n" + kFile).ground,
            (Ground{{1, 2, 3}, 4}));
  EXPECT_THAT(refusal("[ground]\n" + kFile),
              AllOf(HasSubstr("\"center\""), HasSubstr("\"radius\"")));
  EXPECT_THAT(refusal("[ground]\ncenter = [1, 2, 3]\nradius = 0\n" + kFile),
              HasSubstr("[ground] radius: is 0"));
  EXPECT_THAT(refusal("ground = true\n" + kFile), HasSubstr("must be a table, written [ground]"));
}

}  // namespace
}  // namespace arris
