// A white object under white light from everywhere is invisible, whatever its material.
#include <gtest/gtest.h>

#include <string>

#include "support/render_scenes.h"

namespace arris::test {
namespace {

struct FurnaceCase {
  std::string name;
  Material material;
  double tolerance;
};

Material white() {
  Material material;
  material.base_color = Rgb(1);
  return material;
}

std::vector<FurnaceCase> furnace_cases() {
  std::vector<FurnaceCase> cases;
  cases.push_back({"lambert", make_lambert(1), 0.002});
  for (const float roughness : {0.0F, 0.3F, 1.0F}) {
    const std::string suffix = "_roughness_" + std::to_string(int(roughness * 10));
    Material m = white();
    m.roughness = roughness;
    cases.push_back({"plastic" + suffix, m, 0.025});
    m.clearcoat = 1;
    m.clearcoat_roughness = 0.1F;
    cases.push_back({"coated" + suffix, m, 0.03});
    m = white();
    m.roughness = roughness;
    m.metallic = 1;
    cases.push_back({"metal" + suffix, m, 0.025});
    m = white();
    m.roughness = roughness;
    m.transmission = 1;
    cases.push_back({"glass" + suffix, m, 0.03});
  }
  return cases;
}

class Furnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(Furnace, stays_white) {
  Camera camera;
  camera.position = {2, -3, 2};
  camera.fov_deg = 28;
  for (const Mesh& mesh : {make_sphere_mesh(4), make_box_mesh({0.7, 0.7, 0.7})}) {
    Scene scene = make_empty_scene(camera);
    scene.image.max_depth = 100;
    scene.environment = ConstantEnvironment{Rgb(1)};
    add_object(scene, mesh, GetParam().material);
    RenderOptions options;
    options.aovs = {"object"};
    const Picture picture = render_path(scene, 256, options).picture;
    EXPECT_EQ(picture.layers[0].image.at(4, 4, 0), 1.0F);  // the object is in the picture
    EXPECT_NEAR(mean_of(picture.color), 1.0, GetParam().tolerance) << mesh.name;
  }
}

// Light that leaked into or out of the void between sharp and rounded edges would show as grey or black.
TEST_P(Furnace, stays_white_with_rounded_edges) {
  Camera camera;
  camera.position = {2, -3, 2};
  camera.fov_deg = 28;
  Scene scene = make_empty_scene(camera);
  scene.image.max_depth = 100;
  scene.environment = ConstantEnvironment{Rgb(1)};
  scene.rounding.emplace();
  scene.rounding->method = RoundMethod::exact;
  scene.rounding->radius = 0.12;
  for (const double x : {-0.4, 0.4}) {  // two blocks that touch
    add_object(scene, make_box_mesh({0.4, 0.5, 0.6}), GetParam().material, translation({x, 0, 0}));
  }
  // A mirrored, unevenly scaled one that stands in both.
  add_object(scene, make_box_mesh({1, 1, 1}), GetParam().material,
             {{{-0.3, 0, 0}, {0, 0.9, 0}, {0, 0, 0.2}}, {0, -0.1, 0.1}});
  const RenderResult result = render_path(scene, 256);
  EXPECT_GT(result.rays.rounded * 20, result.rays.total);
  EXPECT_NEAR(mean_of(result.picture.color), 1.0, GetParam().tolerance);
}

// A ray that starts on the sharp box, in the void of the rounded one, enters that from outside.
TEST(FurnaceOfTwo, a_sharp_box_in_a_rounded_one_stays_white) {
  Camera camera;
  camera.position = {5, -6, 4};
  camera.fov_deg = 28;
  Scene scene = make_empty_scene(camera);
  scene.image.max_depth = 64;
  scene.environment = ConstantEnvironment{Rgb(1)};
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = 0.2;
  add_object(scene, make_box_mesh({2, 2, 2}), make_lambert(1));
  scene.objects.back().rounding = rounding;
  add_object(scene, make_box_mesh({2, 2, 2}), make_lambert(1), translation({0.7, 0.6, 0.5}));
  const Picture picture = render_path(scene, 64).picture;
  for (const float value : picture.color.values) EXPECT_GT(value, 0.97F);
}

INSTANTIATE_TEST_SUITE_P(render, Furnace, testing::ValuesIn(furnace_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace arris::test
