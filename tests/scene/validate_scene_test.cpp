#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "arris/error.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Scene valid_scene() {
  Camera camera;
  camera.position = {3, -4, 3};
  Scene scene = make_empty_scene(camera);
  add_object(scene, make_box_mesh({1, 1, 1}), make_lambert(0.5F)).name = "leg";
  scene.lights = {PointLight{.position = {1, 1, 1}}, SpotLight{}, DirectionalLight{}, AreaLight{}};
  return scene;
}

Affine3d scaling(double factor) {
  return {{{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}}, {}};
}

void expect_problem(const Scene& scene, const std::string& text) {
  EXPECT_THAT(validate_scene(scene), ElementsAre(HasSubstr(text)));
}

TEST(validate_scene, accepts_a_valid_scene) {
  EXPECT_THAT(validate_scene(valid_scene()), ElementsAre());
}

TEST(validate_scene, names_bad_vertices_and_counts_them) {
  Scene scene = valid_scene();
  scene.meshes[0].positions[2].x = kNan;
  expect_problem(scene, "mesh \"box\": vertex 2 is at (nan, ");
  scene.meshes[0].positions[5].y = std::numeric_limits<float>::infinity();
  expect_problem(scene, "(1 more like it)");
}

TEST(validate_scene, names_indices_out_of_range) {
  Scene scene = valid_scene();
  scene.meshes[0].triangles[3][1] = 8;
  expect_problem(scene, "triangle 3 refers to vertex 8, but there are 8");
}

TEST(validate_scene, names_sharp_edges_out_of_range) {
  Scene scene = valid_scene();
  scene.meshes[0].sharp_edges = {{{0, 7}}};
  EXPECT_THAT(validate_scene(scene), ElementsAre());
  scene.meshes[0].sharp_edges->push_back({8, 1});
  expect_problem(scene, "the sharp edge 1 refers to vertex 8, but there are 8");
}

TEST(validate_scene, names_bad_edge_radii) {
  Scene scene = valid_scene();
  scene.meshes[0].edge_radii = {{{0, 7}, 0.25F}, {{1, 2}, 0}};
  EXPECT_THAT(validate_scene(scene), ElementsAre());
  scene.meshes[0].edge_radii.push_back({{8, 1}, 0.5F});
  expect_problem(scene, "the edge radius 2 refers to vertex 8, but there are 8");
  scene.meshes[0].edge_radii.back() = {{0, 1}, -0.5F};
  expect_problem(scene, "the edge radius 2 is -0.5; it must be at least 0 and finite");
  scene.meshes[0].edge_radii.push_back({{0, 1}, kNan});
  expect_problem(scene, "(1 more like it)");
}

TEST(validate_scene, names_arrays_of_the_wrong_length) {
  Scene scene = valid_scene();
  scene.meshes[0].normals.resize(3);
  expect_problem(scene, "3 vertex normals, but 8 are needed");
}

TEST(validate_scene, names_missing_meshes_materials_and_textures) {
  Scene scene = valid_scene();
  scene.objects[0].mesh.index = 1;
  expect_problem(scene, "object \"leg\": uses mesh 1, but there are 1");
  scene = valid_scene();
  scene.objects[0].material.index = 9;
  expect_problem(scene, "object \"leg\": uses material 9");
  scene = valid_scene();
  scene.materials[0].normal_texture = TextureId{4};
  expect_problem(scene, "material \"lambert\": uses texture 4, but there are 0");
}

TEST(validate_scene, rejects_flattening_transforms) {
  Scene scene = valid_scene();
  scene.objects[0].world_from_object.linear.z = {};
  expect_problem(scene, "object \"leg\": its transform flattens it");
  scene.objects[0].world_from_object.linear.z = {0, 0, 1e-4};  // thin is allowed
  EXPECT_THAT(validate_scene(scene), ElementsAre());
}

TEST(validate_scene, rejects_objects_that_reach_too_far) {
  Scene scene = valid_scene();
  scene.objects[0].world_from_object = scaling(1e30);
  expect_problem(scene, "object \"leg\": reaches from (-1e+30, -1e+30, -1e+30) to (1e+30, ");
  scene.objects[0].world_from_object = scaling(1e8);
  EXPECT_THAT(validate_scene(scene), ElementsAre());
}

TEST(validate_scene, rejects_scenes_too_small_for_the_ray_kernel) {
  Scene scene = valid_scene();
  scene.objects[0].world_from_object = scaling(1e-9);
  expect_problem(scene, "object \"leg\": is 3.4641e-09 large; at least 1e-07 is needed");
  scene.objects[0].world_from_object = scaling(1e-7);
  EXPECT_THAT(validate_scene(scene), ElementsAre());
  // Beside something of a size that can be seen it is no harm.
  scene.objects[0].world_from_object = scaling(1e-9);
  add_object(scene, make_box_mesh({1, 1, 1}), make_lambert(0.5F));
  EXPECT_THAT(validate_scene(scene), ElementsAre());
}

TEST(validate_scene, rejects_scenes_of_which_nothing_is_left_to_draw) {
  Scene scene = valid_scene();
  scene.objects[0].world_from_object = translation({1e8, 1e8, 1e8}) * scaling(0.1);
  expect_problem(scene,
                 "object \"leg\": nothing is left to draw: of 12 triangles none has an area");
  scene.objects.clear();
  EXPECT_THAT(validate_scene(scene), ElementsAre());
}

TEST(prepare_scene, notes_triangles_without_area_once) {
  Scene scene = valid_scene();
  scene.meshes[0].triangles.push_back({0, 0, 1});
  const auto prepared = prepare_scene(scene);
  EXPECT_THAT(scene_of(*prepared).notes, ElementsAre("1 triangle has no area and is not drawn"));
}

TEST(validate_scene, rejects_bad_cameras) {
  Scene scene = valid_scene();
  scene.camera->target = scene.camera->position;
  expect_problem(scene, "camera: position and target are both (3, -4, 3)");
  scene = valid_scene();
  scene.camera->up = scene.camera->target - scene.camera->position;
  expect_problem(scene, "along the view");
  scene = valid_scene();
  scene.camera->fov_deg = 180;
  expect_problem(scene, "fov is 180 degrees");
}

TEST(validate_scene, rejects_bad_lights_and_environments) {
  Scene scene = valid_scene();
  scene.lights[3] = AreaLight{.corner = {}, .edge_u = {1, 0, 0}, .edge_v = {2, 0, 0}};
  expect_problem(scene, "light 3: edges (1, 0, 0) and (2, 0, 0) span no area");
  scene = valid_scene();
  scene.lights[1] = SpotLight{.position = {}, .inner_angle = 2, .outer_angle = 1};
  expect_problem(scene, "light 1: angles are");
  scene = valid_scene();
  scene.environment =
      HdrEnvironment{.name = "room.hdr", .width_px = 2, .height_px = 2, .radiance = {}};
  expect_problem(scene, "environment \"room.hdr\": 0 values for 2x2 pixels");
}

TEST(validate_scene, rejects_bad_rounding) {
  Scene scene = valid_scene();
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = -1.0;
  scene.objects[0].rounding = rounding;
  expect_problem(scene, "object \"leg\": rounding radius is -1");
  rounding.radius = PercentOfInradius{120};
  scene.objects[0].rounding = rounding;
  expect_problem(scene, "120% of the inradius");
  scene.objects[0].rounding.reset();
  scene.objects[0].auto_radius = 0;
  expect_problem(scene, "object \"leg\": its automatic radius is 0; it must be more than 0");
}

TEST(validate_scene, rejects_bad_rules_for_edges) {
  const auto expect_rule_problem = [](const EdgeRule& rule, const std::string& text) {
    Scene scene = valid_scene();
    scene.rounding.emplace();
    scene.rounding->method = RoundMethod::exact;
    scene.rounding->rules = {{}, rule};
    expect_problem(scene, text);
  };
  expect_rule_problem({.radius = -1},
                      "scene: rounding rule 1: radius is -1; it must be at least 0");
  expect_rule_problem({.radius = kNan}, "radius is nan");
  expect_rule_problem({.turn = {{2, 1}}}, "turns from 114.592 to 57.2958 degrees; needed: 0 <= ");
  expect_rule_problem({.box = {{Vec3d(0, 1, 0), Vec3d(1, 0, 1)}}},
                      "box from (0, 1, 0) to (1, 0, 1); corners must be numbers");
  expect_rule_problem({.box = {{Vec3d(0, 0, kNan), Vec3d(1, 1, 1)}}}, "box from (0, 0, nan)");
  expect_rule_problem({.segments = {{Vec3d(0, 0, 0), Vec3d(0, 0, 1)}, {Vec3d(1), Vec3d(1)}}},
                      "segment 1 goes from (1, 1, 1) to (1, 1, 1); give two different points");
}

TEST(validate_scene, rejects_bad_materials_and_pictures) {
  Scene scene = valid_scene();
  scene.materials[0].roughness = 1.5F;
  expect_problem(scene, "material \"lambert\": roughness is 1.5; it must be from 0 to 1");
  scene = valid_scene();
  scene.materials[0].base_color.y = kNan;
  expect_problem(scene, "base_color is (0.5, nan, 0.5)");
  scene = valid_scene();
  scene.image.width_px = 0;
  expect_problem(scene, "size 0x8");
}

TEST(validate_scene, lists_every_problem) {
  Scene scene = valid_scene();
  scene.meshes[0].positions[0].x = kNan;
  scene.materials[0].metallic = -1;
  scene.camera->fov_deg = 0;
  EXPECT_EQ(validate_scene(scene).size(), 3U);
  try {
    static_cast<void>(prepare_scene(scene));
    FAIL() << "a bad scene was prepared";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_THAT(error.what(), HasSubstr("vertex 0"));
    EXPECT_THAT(error.what(), HasSubstr("metallic"));
    EXPECT_THAT(error.what(), HasSubstr("fov"));
  }
}

}  // namespace
}  // namespace arris::test
