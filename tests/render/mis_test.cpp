// Light sampling, BSDF sampling and both together estimate the same picture.
#include <gtest/gtest.h>

#include <cmath>

#include "render/path_renderer.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

struct Estimate {
  double mean = 0, variance_of_mean = 0;
};

Estimate estimate(const PreparedScene& scene, Strategies strategies) {
  constexpr int kRuns = 24;
  const auto renderer = make_path_renderer(strategies);
  double sum = 0, squares = 0;
  for (int run = 0; run < kRuns; ++run) {
    RenderOptions options;
    options.samples = {0, 64};
    options.seed = std::uint32_t(run + 1);
    const double mean = mean_of(renderer->render(scene, options).picture.color);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / kRuns;
  return {mean, (squares / kRuns - mean * mean) / (kRuns - 1)};
}

void expect_equal(const Estimate& a, const Estimate& b, const char* what) {
  const double z = (a.mean - b.mean) / std::sqrt(a.variance_of_mean + b.variance_of_mean + 1e-20);
  EXPECT_LT(std::abs(z), 4) << what << ": " << a.mean << " and " << b.mean;
  // The test must be able to see a difference of two percent.
  EXPECT_LT(std::sqrt(a.variance_of_mean + b.variance_of_mean), 0.01 * a.mean) << what;
}

Scene make_room(const Material& material) {
  Camera camera;
  camera.position = {3, -5, 3};
  camera.fov_deg = 40;
  Scene scene = make_empty_scene(camera);
  scene.image.max_depth = 3;
  add_object(scene, make_square_mesh(4), material);
  add_object(scene, make_box_mesh({0.5, 0.5, 0.5}), material, translation({0, 0, 0.5}));
  return scene;
}

void expect_strategies_agree(const Scene& scene) {
  const auto prepared = prepare_scene(scene);
  const Estimate both = estimate(*prepared, Strategies::both);
  expect_equal(both, estimate(*prepared, Strategies::bsdf_sampling), "both, BSDF sampling");
  expect_equal(both, estimate(*prepared, Strategies::light_sampling), "both, light sampling");
}

Material glossy() {
  Material material = make_lambert(0.6F);
  material.glossy_mix = 0.4F;
  material.roughness = 0.4F;
  return material;
}

TEST(mis, strategies_agree_under_rectangle_light) {
  Scene scene = make_room(glossy());
  scene.lights.push_back(AreaLight{.corner = {-2, 2, 2.5},
                                   .edge_u = {4, 0, 0},
                                   .edge_v = {0, -4, 0},
                                   .radiance = Rgb(2),
                                   .visible_to_camera = false});
  expect_strategies_agree(scene);
}

TEST(mis, strategies_agree_under_emissive_solid) {
  Scene scene = make_room(glossy());
  Material lamp = make_lambert(0);
  lamp.emission = Rgb(3);
  add_object(scene, make_box_mesh({1, 1, 0.2}), lamp, translation({0, 0, 2.2}));
  expect_strategies_agree(scene);
}

TEST(mis, strategies_agree_under_sky) {
  Scene scene = make_room(glossy());
  scene.environment = SkyEnvironment{.sun = false};
  expect_strategies_agree(scene);
}

TEST(mis, strategies_agree_through_translucent_sheets) {
  Scene scene = make_room(glossy());
  Material sheet = make_lambert(0.5F);
  sheet.opacity = 0.5F;
  add_object(scene, make_square_mesh(2), sheet, translation({0, 0, 1.5}));
  scene.lights.push_back(AreaLight{.corner = {-2, 2, 2.5},
                                   .edge_u = {4, 0, 0},
                                   .edge_v = {0, -4, 0},
                                   .radiance = Rgb(2),
                                   .visible_to_camera = false});
  expect_strategies_agree(scene);
}

TEST(mis, strategies_agree_on_plastic) {
  Material plastic;
  plastic.roughness = 0.4F;
  plastic.clearcoat = 0.5F;
  plastic.clearcoat_roughness = 0.3F;
  Scene scene = make_room(plastic);
  scene.lights.push_back(AreaLight{.corner = {-2, 2, 2.5},
                                   .edge_u = {4, 0, 0},
                                   .edge_v = {0, -4, 0},
                                   .radiance = Rgb(2),
                                   .visible_to_camera = false});
  expect_strategies_agree(scene);
}

}  // namespace
}  // namespace arris::test
