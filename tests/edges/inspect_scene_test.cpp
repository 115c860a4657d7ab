#include "arris/inspect.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "support/mesh_checks.h"

#include "arris/io.h"

namespace arris {
namespace {

Scene scene_of_one(const Mesh& mesh, const Affine3d& world_from_object = {}) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(mesh);
  Object object;
  object.name = "part";
  object.world_from_object = world_from_object;
  scene.objects.push_back(object);
  return scene;
}

TEST(InspectScene, a_box_is_closed_and_convex_and_says_its_inradius) {
  const SceneReport report = inspect_scene(scene_of_one(make_box_mesh({1, 2, 3})));
  ASSERT_EQ(report.objects.size(), 1U);
  const ObjectReport& box = report.objects[0];
  EXPECT_TRUE(box.closed);
  EXPECT_TRUE(box.convex);
  EXPECT_EQ(box.vertices, 8U);
  EXPECT_EQ(box.edges.convex, 12U);
  EXPECT_EQ(box.edges.flat, 6U);
  ASSERT_TRUE(box.inradius);
  EXPECT_NEAR(*box.inradius, 0.5, 1e-6);
  EXPECT_EQ(report.triangles, 12U);
}

TEST(InspectScene, lengths_are_in_world_units) {
  Affine3d scaled;
  scaled.linear = {{4, 0, 0}, {0, -4, 0}, {0, 0, 4}};
  scaled.translation = {10, 0, 0};
  const ObjectReport box = inspect_scene(scene_of_one(make_box_mesh({1, 1, 1}), scaled)).objects[0];
  EXPECT_NEAR(*box.inradius, 2, 1e-5);
  EXPECT_NEAR(box.bounds_min.x, 8, 1e-5);
  EXPECT_NEAR(box.bounds_max.x, 12, 1e-5);
}

TEST(InspectScene, an_open_mesh_counts_its_border) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.triangles.resize(10);
  const ObjectReport box = inspect_scene(scene_of_one(mesh)).objects[0];
  EXPECT_FALSE(box.closed);
  EXPECT_FALSE(box.convex);
  EXPECT_FALSE(box.inradius);
  EXPECT_EQ(box.edges.boundary, 4U);
}

TEST(InspectScene, nist_part_is_closed_and_not_convex) {
  const auto path = test::shared_model("mesh/NIST_MBE_PMI_6.stl");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const ObjectReport part = inspect_scene(load_scene(path)).objects[0];
  EXPECT_TRUE(part.closed);
  EXPECT_FALSE(part.convex);
  EXPECT_EQ(part.triangles, 10872U);
  EXPECT_GT(part.edges.concave, 0U);
}

}  // namespace
}  // namespace arris
