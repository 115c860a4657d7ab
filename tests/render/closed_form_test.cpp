// Scenes whose radiance is known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scenes.h"

namespace arris::test {
namespace {

// Seen from a point below its centre: a rectangle of sides a, b at height h fills this share of the
// cosine-weighted hemisphere (four corner rectangles; Siegel and Howell, configuration C-13).
double form_factor(double a, double b, double h) {
  const double x = a / 2 / h, y = b / 2 / h;
  const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return 4 / (2 * kPi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

// A camera that looks at one point of the floor, so closely that the whole picture is that point.
Camera look_at_origin(Vec3d position) {
  Camera camera;
  camera.position = position;
  camera.fov_deg = 0.02;
  return camera;
}

Scene make_floor(float albedo) {
  Scene scene = make_empty_scene(look_at_origin({3, -4, 5}));
  add_object(scene, make_square_mesh(50), make_lambert(albedo));
  return scene;
}

Camera inside_camera() {
  Camera camera;
  camera.position = {0.1, 0.2, -0.1};
  camera.target = {1, 0, 0};
  camera.fov_deg = 90;
  return camera;
}

TEST(closed_form, sphere_around_point_light_adds_half_per_scattering) {
  Scene scene = make_empty_scene(inside_camera());
  scene.image.max_depth = 3;
  add_object(scene, make_sphere_mesh(5), make_lambert(0.5F));
  scene.lights.push_back(PointLight{.position = {}, .intensity = Rgb(float(kPi))});
  EXPECT_NEAR(mean_of(render_path(scene, 256).picture.color), 0.875, 0.875 * 0.005);
}

TEST(closed_form, deep_paths_reach_the_geometric_sum) {
  Scene scene = make_empty_scene(inside_camera());
  scene.image.max_depth = 64;
  add_object(scene, make_sphere_mesh(5), make_lambert(0.5F));
  scene.lights.push_back(PointLight{.position = {}, .intensity = Rgb(float(kPi))});
  EXPECT_NEAR(mean_of(render_path(scene, 256).picture.color), 1.0, 0.005);
}

TEST(closed_form, depth_zero_shows_emission_only) {
  Scene scene = make_floor(0.5F);
  scene.image.max_depth = 0;
  scene.environment = ConstantEnvironment{Rgb(1)};
  EXPECT_EQ(mean_of(render_path(scene, 4).picture.color), 0.0);
}

TEST(closed_form, floor_under_rectangle_light) {
  for (const double height : {0.3, 1.0, 4.0}) {
    Scene scene = make_floor(0.6F);
    scene.image.max_depth = 1;
    scene.lights.push_back(AreaLight{.corner = {-1, 0.5, height},
                                     .edge_u = {2, 0, 0},
                                     .edge_v = {0, -1, 0},
                                     .radiance = Rgb(2),
                                     .visible_to_camera = false});
    const double expected = 0.6 * 2 * form_factor(2, 1, height);
    EXPECT_NEAR(mean_of(render_path(scene, 256).picture.color), expected, 0.01 * expected)
        << height;
  }
}

TEST(closed_form, floor_under_emissive_square) {
  Scene scene = make_floor(0.6F);
  scene.image.max_depth = 1;
  Material lamp = make_lambert(0);
  lamp.emission = Rgb(2);
  add_object(scene, make_square_mesh(0.5F), lamp, translation({0, 0, 1}));
  const double expected = 0.6 * 2 * form_factor(1, 1, 1);
  EXPECT_NEAR(mean_of(render_path(scene, 512).picture.color), expected, 0.01 * expected);
}

TEST(closed_form, floor_under_open_constant_sky) {
  Scene scene = make_floor(0.6F);
  scene.image.max_depth = 1;
  scene.environment = ConstantEnvironment{Rgb(3)};
  EXPECT_NEAR(mean_of(render_path(scene, 16).picture.color), 1.8, 1e-4);
}

TEST(closed_form, floor_under_directional_light) {
  Scene scene = make_floor(0.6F);
  scene.lights.push_back(DirectionalLight{.direction = {1, 0, -1}, .irradiance = Rgb(2)});
  const double expected = 0.6 / kPi * 2 * std::sqrt(0.5);
  EXPECT_NEAR(mean_of(render_path(scene, 1).picture.color), expected, 1e-5);
}

TEST(closed_form, floor_under_point_light_falls_with_distance) {
  for (const double height : {0.5, 2.0}) {
    Scene scene = make_floor(0.6F);
    scene.lights.push_back(PointLight{.position = {0, 0, height}, .intensity = Rgb(1)});
    const double expected = 0.6 / kPi / (height * height);
    EXPECT_NEAR(mean_of(render_path(scene, 1).picture.color), expected, 1e-4 * expected);
  }
}

TEST(closed_form, spot_lights_its_cone_only) {
  Scene scene = make_floor(0.6F);
  scene.lights.push_back(SpotLight{
      .position = {0, 0, 2}, .intensity = Rgb(1), .inner_angle = 0.2, .outer_angle = 0.3});
  EXPECT_NEAR(mean_of(render_path(scene, 1).picture.color), 0.6 / kPi / 4, 1e-5);
  scene.lights[0] =
      SpotLight{.position = {1, 0, 2}, .intensity = Rgb(1), .inner_angle = 0.2, .outer_angle = 0.3};
  EXPECT_EQ(mean_of(render_path(scene, 1).picture.color), 0.0);
}

TEST(closed_form, an_object_between_casts_a_shadow) {
  Scene scene = make_floor(0.6F);
  scene.lights.push_back(PointLight{.position = {0, 0, 2}, .intensity = Rgb(1)});
  scene.image.max_depth = 1;
  add_object(scene, make_square_mesh(0.1F), make_lambert(0), translation({0, 0, 1}));
  EXPECT_EQ(mean_of(render_path(scene, 4).picture.color), 0.0);
}

TEST(closed_form, a_translucent_sheet_passes_its_share) {
  Scene scene = make_floor(0.6F);
  scene.lights.push_back(PointLight{.position = {0, 0, 2}, .intensity = Rgb(1)});
  scene.image.max_depth = 1;
  Material sheet = make_lambert(0);
  sheet.opacity = 0.25F;
  add_object(scene, make_square_mesh(0.1F), sheet, translation({0, 0, 1}));
  const double expected = 0.75 * 0.6 / kPi / 4;
  EXPECT_NEAR(mean_of(render_path(scene, 4).picture.color), expected, 1e-4 * expected);
}

TEST(closed_form, the_camera_sees_through_a_translucent_sheet) {
  Scene scene = make_empty_scene(look_at_origin({0, 0.001, 5}));
  Material lamp = make_lambert(0);
  lamp.emission = Rgb(2);
  add_object(scene, make_square_mesh(1), lamp);
  Material sheet = make_lambert(0);
  sheet.opacity = 0.25F;
  add_object(scene, make_square_mesh(1), sheet, translation({0, 0, 1}));
  EXPECT_NEAR(mean_of(render_path(scene, 256).picture.color), 1.5, 0.01);
}

TEST(closed_form, emissive_sphere_and_box_show_their_radiance) {
  for (const Mesh& mesh : {make_sphere_mesh(3), make_box_mesh({1, 1, 1})}) {
    Scene scene = make_empty_scene(look_at_origin({3, -4, 5}));
    Material lamp = make_lambert(0);
    lamp.emission = {1, 2, 3};
    add_object(scene, mesh, lamp);
    const Image image = render_path(scene, 4).picture.color;
    EXPECT_EQ(image.at(3, 3, 0), 1.0F);
    EXPECT_EQ(image.at(3, 3, 2), 3.0F);
  }
}

TEST(closed_form, inside_of_glowing_box_is_the_geometric_sum) {
  Scene scene = make_empty_scene(inside_camera());
  scene.image.max_depth = 5;
  Material lamp = make_lambert(0.5F);
  lamp.emission = Rgb(1);
  add_object(scene, make_box_mesh({1, 1, 1}), lamp);
  const double expected = (1 - std::pow(0.5, 6)) / 0.5;
  EXPECT_NEAR(mean_of(render_path(scene, 256).picture.color), expected, 0.005 * expected);
}

TEST(closed_form, area_light_is_seen_from_its_front_unless_hidden) {
  Scene scene = make_empty_scene(look_at_origin({0, 0.001, 5}));
  AreaLight light{
      .corner = {-1, -1, 0}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}, .radiance = Rgb(3)};
  scene.lights = {light};
  EXPECT_EQ(mean_of(render_path(scene, 1).picture.color), 3.0);
  light.visible_to_camera = false;
  scene.lights = {light};
  EXPECT_EQ(mean_of(render_path(scene, 1).picture.color), 0.0);
}

TEST(closed_form, mirror_shows_a_light_hidden_from_the_camera) {
  Scene scene = make_empty_scene(look_at_origin({0, -4, 4}));
  Material mirror;
  mirror.base_color = Rgb(1);
  mirror.metallic = 1;
  mirror.roughness = 0;
  add_object(scene, make_square_mesh(1), mirror);
  scene.lights.push_back(AreaLight{.corner = {-2, 6, 4},
                                   .edge_u = {4, 0, 0},
                                   .edge_v = {0, 0, 4},
                                   .radiance = Rgb(2),
                                   .visible_to_camera = false});
  EXPECT_NEAR(mean_of(render_path(scene, 16).picture.color), 2.0, 0.01);
}

}  // namespace
}  // namespace arris::test
