// The beam renderer against closed forms and the path tracer.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "arris/render.h"
#include "support/csg_oracle.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// A ball of radius 0.7 on a slab, with a hole through both, in the light of a lamp.
Scene beam_scene() {
  Camera camera;
  camera.position = {0.5, -5, 4};
  Scene scene = make_empty_scene(camera);
  scene.meshes.emplace_back();
  scene.materials = {make_lambert(0.5F), make_lambert(0.8F)};
  CsgTree tree =
      flat_tree(CsgOperation::subtract, {{CsgBox{{-2, -2, -0.5}, {2, 2, 0}}, {}, {0}},
                                         {CsgCone{-2, 2, 0.15, 0.15}, {{}, {0.9, -0.8, 0}}, {0}}});
  scene.csg_trees.push_back(std::move(tree));
  scene.csg_trees.push_back(one_leaf(CsgSphere{0.7}, {{}, {0, 0, 1}}));
  scene.csg_trees[1].leaves[0].material = MaterialId{1};
  for (std::uint32_t i = 0; i < 2; ++i) {
    Object object;
    object.name = i == 0 ? "slab" : "ball";
    object.csg = CsgId{i};
    scene.objects.push_back(object);
  }
  scene.lights.emplace_back(PointLight{{2, -3, 6}, {90, 90, 90}});
  scene.image.width_px = scene.image.height_px = 24;
  scene.image.filter = ImageSettings::Filter::box;
  scene.image.max_depth = 1;
  return scene;
}

RenderResult render(const Scene& scene, const Renderer& renderer, std::uint32_t samples,
                    std::vector<std::string> aovs = {}, int threads = 0) {
  RenderOptions options;
  options.samples = {0, samples};
  options.aovs = std::move(aovs);
  options.threads = threads;
  return renderer.render(*prepare_scene(scene), options);
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    sum += std::pow(double(a.values[i]) - double(b.values[i]), 2);
  }
  return std::sqrt(sum / double(a.values.size()));
}

TEST(beam_renderer, agrees_with_the_path_tracer) {
  const Scene scene = beam_scene();
  const Image beam = render(scene, *make_beam_renderer(), 1).picture.color;
  const Image many = render(scene, *make_path_renderer(), 1024).picture.color;
  EXPECT_LT(rmse(beam, many), 0.01);
  const Image corners =
      render(scene, *make_beam_renderer({.rule = BeamRule::corners}), 1).picture.color;
  EXPECT_LT(rmse(corners, many), 0.02);
}

TEST(beam_renderer, other_light_is_path_traced) {
  Scene scene = beam_scene();
  scene.environment = ConstantEnvironment{{0.5F, 0.5F, 0.5F}};
  scene.image.max_depth = 4;
  const Image beam = render(scene, *make_beam_renderer(), 256).picture.color;
  const Image path = render(scene, *make_path_renderer(), 1024).picture.color;
  EXPECT_LT(rmse(beam, path), 0.03);
  EXPECT_NEAR(mean_of(beam), mean_of(path), 0.01 * mean_of(path));
}

// Between diffuse surfaces it then follows no light: as with paths of one vertex. A mirror shows the other surfaces.
TEST(beam_renderer, light_may_be_followed_by_glossy_surfaces_alone) {
  Scene scene = beam_scene();
  scene.materials = {make_lambert(0.9F), make_lambert(0.9F)};
  scene.environment = ConstantEnvironment{{0.5F, 0.5F, 0.5F}};
  const auto mean = [&](int max_depth, bool only_glossy) {
    scene.image.max_depth = max_depth;
    return mean_of(
        render(scene, *make_beam_renderer({.only_glossy = only_glossy}), 256).picture.color);
  };
  const double direct = mean(1, false), all = mean(6, false);
  EXPECT_GT(all, 1.05 * direct);
  EXPECT_NEAR(mean(6, true), direct, 0.01 * direct);
  scene.materials[1].glossy_mix.reset();
  scene.materials[1].metallic = 1;
  scene.materials[1].roughness = 0;
  EXPECT_GT(mean(6, true), 1.02 * mean(1, false));
}

// What a torus takes away is seen from its other side; seen as a whole, it has no root that says so.
TEST(beam_renderer, grooves_are_hollow) {
  Scene scene = beam_scene();
  scene.csg_trees[0] =
      flat_tree(CsgOperation::subtract,
                {{CsgBox{{-2, -2, -0.5}, {2, 2, 0}}, {}, {0}}, {CsgTorus{1.2, 0.3}, {}, {0}}});
  scene.objects.pop_back();
  const Image beam = render(scene, *make_beam_renderer(), 1).picture.color;
  const Image path = render(scene, *make_path_renderer(), 1024).picture.color;
  EXPECT_LT(rmse(beam, path), 0.02);
}

// 64 points for an area light that is not near.
TEST(beam_renderer, area_lights_can_be_sets_of_beams) {
  Scene scene = beam_scene();
  AreaLight light;
  light.corner = {1, -3.5, 5};
  light.edge_u = {0, 1.5, 0};
  light.edge_v = {1.5, 0, 0};
  light.radiance = {20, 20, 20};
  scene.lights = {light};
  const auto renderer = make_beam_renderer({.light_beams = 8});
  const Image beam = render(scene, *renderer, 1).picture.color;
  const Image path = render(scene, *make_path_renderer(), 2048).picture.color;
  EXPECT_GT(mean_of(path), 0.05);
  EXPECT_LT(rmse(beam, path), 0.01);
  scene.image.max_depth = 3;
  scene.environment = ConstantEnvironment{{0.2F, 0.2F, 0.2F}};
  EXPECT_LT(rmse(render(scene, *renderer, 256).picture.color,
                 render(scene, *make_path_renderer(), 1024).picture.color),
            0.02);
}

// A floor of polished metal below the slab, which shows its underside and the lamp's light on it.
TEST(beam_renderer, flat_mirrors_agree_with_the_path_tracer) {
  Scene scene = beam_scene();
  Material mirror;
  mirror.base_color = {0.9F, 0.8F, 0.7F};
  mirror.metallic = 1;
  mirror.roughness = 0;
  scene.materials.push_back(mirror);
  CsgTree floor = one_leaf(CsgBox{{-8, -8, -3}, {8, 8, -2}});
  floor.leaves[0].material = MaterialId{2};
  scene.csg_trees.push_back(floor);
  Object object;
  object.name = "floor";
  object.csg = CsgId{2};
  scene.objects.push_back(object);
  scene.lights.emplace_back(PointLight{{2, -3, -1}, {20, 20, 20}});
  scene.camera->position = {0.5, -6, 1.5};
  scene.image.max_depth = 3;
  const auto renderer = make_beam_renderer();
  const RenderResult beam = render(scene, *renderer, 64, {"uncertified"});
  const Image path = render(scene, *make_path_renderer(), 1024).picture.color;
  EXPECT_LT(rmse(beam.picture.color, path), 0.03);
  EXPECT_NEAR(mean_of(beam.picture.color), mean_of(path), 0.01 * mean_of(path));
  EXPECT_LT(mean_of(beam.picture.layers[0].image), 0.05);
}

// A cube of glass, as a solid and as a mesh, and how deep paths may go.
TEST(beam_renderer, glass_agrees_with_the_path_tracer) {
  const Mesh cube = make_box_mesh(Vec3d(0.7));
  for (const bool is_mesh : {false, true}) {
    Scene scene = beam_scene();
    Material glass;
    glass.base_color = {0.9F, 1, 0.9F};
    glass.transmission = 1;
    glass.roughness = 0;
    scene.materials.push_back(glass);
    scene.environment = ConstantEnvironment{{0.3F, 0.4F, 0.5F}};
    if (is_mesh) {
      scene.objects.pop_back();
      add_object(scene, cube, glass, {{}, {0, 0, 1}});
    } else {
      scene.csg_trees[1] = one_leaf(CsgBox{Vec3d(-0.7), Vec3d(0.7)}, {{}, {0, 0, 1}});
      scene.csg_trees[1].leaves[0].material = MaterialId{2};
    }
    scene.image.width_px = scene.image.height_px = 8;
    for (const int depth : {1, 8}) {
      scene.image.max_depth = depth;
      const Image beam = render(scene, *make_beam_renderer(), 64).picture.color;
      const Image path = render(scene, *make_path_renderer(), 1024).picture.color;
      EXPECT_LT(rmse(beam, path), 0.03) << is_mesh << ", " << depth;
      EXPECT_NEAR(mean_of(beam), mean_of(path), 0.01 * mean_of(path)) << is_mesh << ", " << depth;
    }
  }
}

TEST(beam_renderer, fills_its_layers_and_counts) {
  const Scene scene = beam_scene();
  const auto renderer = make_beam_renderer();
  const RenderResult result = render(scene, *renderer, 1, renderer->aovs());
  ASSERT_EQ(result.picture.layers.size(), 4U);
  EXPECT_EQ(result.picture.layers[3].image.channels, 3);
  const Image& lo = result.picture.layers[0].image;
  const Image& hi = result.picture.layers[1].image;
  double area = 0;
  for (std::size_t i = 0; i < lo.values.size(); ++i) {
    EXPECT_LE(lo.values[i], hi.values[i]);
    EXPECT_LE(hi.values[i], 1);
    EXPECT_TRUE(hi.values[i] - lo.values[i] <= 1.0F / 512 ||
                result.picture.layers[2].image.values[i] == 1);
    area += double(lo.values[i]);
  }
  EXPECT_GT(area, 50);
  ASSERT_TRUE(result.beam);
  EXPECT_GT(result.beam->regions, 0U);
  EXPECT_GT(result.beam->certified_fraction, 0.99);
  EXPECT_EQ(render(scene, *renderer, 1, {}, 1).picture.color.values, result.picture.color.values);
}

TEST(beam_renderer, a_stop_counts_until_the_picture_is_done) {
  const auto scene = prepare_scene(beam_scene());
  for (const bool at_the_end : {false, true}) {
    std::atomic<bool> stop = false;
    RenderOptions options;
    options.samples = {0, 4};
    options.threads = 1;
    options.stop = &stop;
    options.on_progress = [&](const Progress& progress) {
      if (!at_the_end || progress.done == 1) stop = true;
    };
    const RenderResult result = make_beam_renderer()->render(*scene, options);
    EXPECT_EQ(result.samples.last, at_the_end ? 4U : 0U);
    EXPECT_EQ(result.picture.color.width_px, at_the_end ? 24 : 0);
  }
}

TEST(beam_renderer, says_what_it_cannot_take) {
  Scene scene = beam_scene();
  add_object(scene, make_box_mesh(Vec3d(1)), make_lambert(0.5F));
  scene.objects.back().name = "box";
  EXPECT_TRUE(beam_problems(scene).empty());
  scene.rounding = RoundingSettings{};
  scene.rounding->method = RoundMethod::mesh;
  EXPECT_TRUE(beam_problems(scene).empty());
  scene.rounding->method = RoundMethod::exact;  // CSG solids are sharp anyway
  const std::vector<std::string> problems = beam_problems(scene);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].find("\"box\" is to have rounded edges"), std::string::npos);
}

}  // namespace
}  // namespace arris::test
