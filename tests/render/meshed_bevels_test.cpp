#include "render/meshed_bevels.h"

#include <gtest/gtest.h>

#include "arris/error.h"
#include "render/prepared_scene.h"
#include "support/mesh_checks.h"
#include "support/render_scenes.h"

namespace arris {
namespace {

RoundingSettings mesh_settings(double radius, int subdivisions) {
  RoundingSettings settings;
  settings.method = RoundMethod::mesh;
  settings.radius = radius;
  settings.subdivisions = subdivisions;
  return settings;
}

Scene cube_scene() {
  Camera camera;
  camera.position = {4, -5, 3};
  Scene scene = test::make_empty_scene(camera);
  test::add_object(scene, test::make_box_mesh(Vec3d(1)), test::make_lambert(0.5F));
  return scene;
}

TEST(MeshedBevels, take_the_meshes_place_and_are_accounted_as_rounding) {
  Scene scene = cube_scene();
  scene.rounding = mesh_settings(0.1, 3);
  const auto prepared = prepare_scene(scene);
  const PrepareStats& stats = prepare_stats(*prepared);
  EXPECT_EQ(stats.triangles, 12U + 24 * 3 + 8 * 9);
  EXPECT_EQ(stats.rounded_edges, 12U);
  EXPECT_EQ(stats.rounded_corners, 8U);
  EXPECT_EQ(stats.rounding_bytes, bytes_of(prepared->scene().meshes.back()));
  ASSERT_EQ(stats.rounding.size(), 1U);
  EXPECT_DOUBLE_EQ(stats.rounding[0].radius, 0.1);
}

// Along a ray towards an edge, many subdivisions come as near as one likes to the exact rounding.
TEST(MeshedBevels, agree_with_the_exact_rounding_whatever_the_transform) {
  const Mat3d linears[] = {Mat3d{},
                           {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}},
                           {{0, 2, 0}, {2, 0, 0}, {0, 0, 2}},           // mirrored
                           {{1.5, 0, 0}, {0.3, 1, 0}, {0, 0.2, 0.8}}};  // sheared
  for (const Mat3d& linear : linears) {
    Scene scene = cube_scene();
    scene.objects[0].world_from_object = {linear, {0.2, 0.1, -0.3}};
    scene.rounding = mesh_settings(0.2, 40);
    const auto meshed = prepare_scene(scene);
    scene.rounding->method = RoundMethod::exact;
    const auto exact = prepare_scene(scene);
    int both = 0, rounded = 0;
    for (int i = 0; i < 4000; ++i) {
      TraceRay ray;
      ray.origin = {7, -6, 5};
      const Vec3f target(-2.5F + 0.08F * float(i % 64), 0.3F, -2.5F + 0.08F * float(i / 64));
      ray.direction = normalize(target - ray.origin);
      const auto a = meshed->intersect(ray), b = exact->intersect(ray);
      if (!a || !b) continue;
      ++both;
      if (b->feature == Feature::face) continue;
      ++rounded;
      const float cosine = -dot(b->geometric_normal, ray.direction);
      if (cosine < 0.2F) continue;
      EXPECT_NEAR(a->t, b->t, 1e-3F / cosine);
      EXPECT_GT(dot(a->shading_normal, b->geometric_normal), 0.9995F);
      EXPECT_EQ(a->side, Side::outside);
    }
    EXPECT_GT(both, 500);
    EXPECT_GT(rounded, 30);
  }
}

TEST(MeshedBevels, are_shared_by_objects_alike) {
  Scene scene = cube_scene();
  for (int i = 1; i < 5; ++i) {
    Object copy = scene.objects[0];
    copy.name = "copy" + std::to_string(i);
    copy.world_from_object.translation = {3.0 * i, 0, 0};
    scene.objects.push_back(copy);
  }
  scene.objects[4].rounding = mesh_settings(0.05, 2);
  scene.rounding = mesh_settings(0.1, 2);
  const auto prepared = prepare_scene(scene);
  EXPECT_EQ(prepared->scene().meshes.size(), 3U);
  EXPECT_EQ(prepare_stats(*prepared).rounding.size(), 5U);
}

TEST(MeshedBevels, give_way_to_another_rounding_of_the_same_scene) {
  Scene scene = cube_scene();
  const auto sharp = prepare_scene(scene);
  const auto meshed = prepare_again(*sharp, mesh_settings(0.1, 2));
  EXPECT_EQ(prepare_stats(*meshed).triangles, 12U + 48 + 32);
  const auto finer = prepare_again(*meshed, mesh_settings(0.1, 3));
  EXPECT_EQ(prepare_stats(*finer).triangles, 12U + 72 + 72);
  const auto none = prepare_again(*finer, RoundingSettings{});
  EXPECT_EQ(prepare_stats(*none).triangles, 12U);
  EXPECT_EQ(prepare_stats(*none).rounding_bytes, 0U);
}

TEST(MeshedBevels, name_the_object_whose_radius_does_not_fit) {
  Scene scene = cube_scene();
  scene.objects[0].name = "dice";
  scene.rounding = mesh_settings(1.5, 2);
  try {
    prepare_scene(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("dice"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace arris
