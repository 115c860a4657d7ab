// A white object under white light from everywhere is invisible, whatever its material.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/render_scenes.h"

namespace arris::test {
namespace {

struct FurnaceCase {
  std::string name;
  Material material;
  // How much light the scattering functions may lose or win; smooth ones none, but for long paths that are cut.
  double model_error;
};

Material white() {
  Material material;
  material.base_color = Rgb(1);
  return material;
}

std::vector<FurnaceCase> furnace_cases() {
  struct ModelErrors {
    float roughness;
    double plastic, coated, metal, glass;
  };
  std::vector<FurnaceCase> cases;
  cases.push_back({"lambert", make_lambert(1), 0.0005});
  for (const ModelErrors& error : {ModelErrors{0.0F, 0.0005, 0.001, 0.0005, 0.0005},
                                   ModelErrors{0.3F, 0.002, 0.002, 0.004, 0.002},
                                   ModelErrors{1.0F, 0.001, 0.001, 0.001, 0.002}}) {
    const std::string suffix = "_roughness_" + std::to_string(int(error.roughness * 10));
    Material m = white();
    m.roughness = error.roughness;
    cases.push_back({"plastic" + suffix, m, error.plastic});
    m.clearcoat = 1;
    m.clearcoat_roughness = 0.1F;
    cases.push_back({"coated" + suffix, m, error.coated});
    m = white();
    m.roughness = error.roughness;
    m.metallic = 1;
    cases.push_back({"metal" + suffix, m, error.metal});
    m = white();
    m.roughness = error.roughness;
    m.transmission = 1;
    cases.push_back({"glass" + suffix, m, error.glass});
  }
  return cases;
}

// Of the mean of a grey picture, from how much its pixels differ.
double standard_error(const Image& image) {
  const double mean = mean_of(image);
  double sum = 0;
  int pixels = 0;
  for (std::size_t i = 0; i < image.values.size(); i += 3, ++pixels) {
    sum += (double(image.values[i]) - mean) * (double(image.values[i]) - mean);
  }
  return std::sqrt(sum / (pixels - 1) / pixels);
}

// The statistical part of the tolerance is 0 for smooth glass and metal, where every path brings exactly 1.
void expect_white(const Image& image, double model_error, const std::string& what) {
  EXPECT_NEAR(mean_of(image), 1.0, model_error + 4 * standard_error(image))
      << what << ", standard error " << standard_error(image);
}

class Furnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(Furnace, stays_white) {
  Camera camera;
  camera.position = {2, -3, 2};
  camera.fov_deg = 28;
  for (const Mesh& mesh : {make_sphere_mesh(4), make_box_mesh({0.7, 0.7, 0.7})}) {
    Scene scene = make_empty_scene(camera);
    scene.image.max_depth = 1000;
    scene.environment = ConstantEnvironment{Rgb(1)};
    add_object(scene, mesh, GetParam().material);
    RenderOptions options;
    options.aovs = {"object"};
    const Picture picture = render_path(scene, 1024, options).picture;
    EXPECT_EQ(picture.layers[0].image.at(4, 4, 0), 1.0F);  // the object is in the picture
    expect_white(picture.color, GetParam().model_error, mesh.name);
  }
}

// Light that leaked into or out of the void between sharp and rounded edges would show as grey or black.
TEST_P(Furnace, stays_white_with_rounded_edges) {
  Camera camera;
  camera.position = {2, -3, 2};
  camera.fov_deg = 28;
  Scene scene = make_empty_scene(camera);
  scene.image.max_depth = 1000;
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
  const RenderResult result = render_path(scene, 1024);
  EXPECT_GT(result.rays.rounded * 20, result.rays.total);
  expect_white(result.picture.color, GetParam().model_error, "rounded");
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
