#include "io/scene_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "arris/error.h"
#include "io/toml_scene.h"
#include "io/toml_writer.h"

namespace arris {
namespace {

Scene read_back(const Scene& scene) {
  TomlTable table = make_scene_table(scene);
  set_toml(table, "object", TomlArray{{{}, TomlTable{{"shape", {}, {{}, std::string("box")}}}}});
  const std::vector<std::string> comments{"a\nb = 1\r\x7f", "\xE9 and \xC3\xA9"};
  return read_toml_scene(write_scene_file(table, comments), "s.toml", "/",
                         [](const auto&) { return Scene(); });
}

TEST(SceneWriter, keeps_every_digit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(0, 180), exponent(-20, 8);
  const auto number = [&] { return std::pow(10, exponent(random)); };
  for (int i = 0; i < 500; ++i) {
    Scene scene;
    scene.camera = Camera{{number(), -number(), number()}, {1e9, 0, 0}, {0, 0, number()}, 50.1};
    RoundingSettings rounding;
    rounding.method = RoundMethod::shader;
    rounding.radius = number();
    rounding.min_angle = radians(angle(random));
    rounding.shader.delta = number();
    rounding.on_overlap = i % 2 == 0 ? OnOverlap::report : OnOverlap::clamp;
    rounding.rules.push_back({.radius = number()});
    rounding.rules.push_back({.radius = angle(random) / 100, .is_part = true});
    EdgeRule& rule = rounding.rules.emplace_back();
    rule.turn = {0, radians(angle(random))};
    rule.box = {{Vec3d(-number(), 0, 0), Vec3d(0, number(), number())}};
    rule.segments = {{Vec3d(number(), 0, -1), Vec3d(0, 1e9, number())}, {Vec3d(0), Vec3d(1)}};
    scene.rounding = rounding;
    SpotLight spot;
    spot.outer_angle = radians(angle(random));
    spot.inner_angle = spot.outer_angle * 0.3;
    spot.intensity = Rgb(float(number()), 0, float(number()) * 1e12F);
    scene.lights = {spot};
    scene.ground = Ground{{number(), 0, -number()}, number()};
    scene.image.exposure = -number() / 1e8;
    const Scene read = read_back(scene);
    EXPECT_EQ(read.camera->position, scene.camera->position);
    EXPECT_EQ(read.camera->up, scene.camera->up);
    EXPECT_EQ(read.rounding, scene.rounding);
    const auto& light = std::get<SpotLight>(read.lights.at(0));
    EXPECT_EQ(light.outer_angle, spot.outer_angle);
    EXPECT_DOUBLE_EQ(light.inner_angle, spot.inner_angle);
    EXPECT_EQ(light.intensity, spot.intensity);
    EXPECT_EQ(read.ground, scene.ground);
    EXPECT_EQ(read.image.exposure, scene.image.exposure);
  }
}

TEST(SceneWriter, an_object_without_rules_gets_none_of_the_scene) {
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  TomlTable object{{"shape", {}, {{}, std::string("box")}}};
  set_toml(object, "round", make_rounding_table(rounding));
  Scene scene;
  scene.rounding = rounding;
  scene.rounding->rules = {{.radius = 1}};
  TomlTable table = make_scene_table(scene);
  set_toml(table, "object", TomlArray{{{}, object}});
  const Scene read = read_toml_scene(write_scene_file(table, {}), "s.toml", "/",
                                     [](const auto&) { return Scene(); });
  EXPECT_EQ(read.rounding, scene.rounding);
  EXPECT_EQ(read.objects.at(0).rounding, rounding);
}

TEST(SceneWriter, light_of_any_strength_is_within_what_scene_files_take) {
  for (const float strength : {0.0F, 1e9F, 1.1e9F, 1e12F, 1e20F}) {
    Scene scene;
    scene.environment = ConstantEnvironment{Rgb(strength, strength / 3, 0)};
    scene.lights = {PointLight{{}, Rgb(strength)}};
    const Scene read = read_back(scene);
    EXPECT_EQ(read.environment, scene.environment);
    EXPECT_EQ(std::get<PointLight>(read.lights.at(0)).intensity, Rgb(strength));
  }
}

TEST(SceneWriter, materials_are_read_back) {
  Material material;
  material.base_color = Rgb(0.1F, 0.7F, 1.0F / 3);
  material.roughness = 0.123456F;
  material.clearcoat_roughness = 1e-30F;
  material.emission = Rgb(7, 0.3F, 0);
  material.alpha_cutoff = 0.5F;
  Scene scene;
  TomlTable materials;
  set_toml(materials, "default", make_material_table(material));
  TomlTable table = make_scene_table(scene);
  set_toml(table, "material", materials);
  set_toml(table, "object", TomlArray{{{}, TomlTable{{"shape", {}, {{}, std::string("box")}}}}});
  const Material read =
      read_toml_scene(write_scene_file(table, {}), "s.toml", "/", [](const auto&) {
        return Scene();
      }).materials[0];
  EXPECT_EQ(read.base_color, material.base_color);
  EXPECT_EQ(read.roughness, material.roughness);
  EXPECT_EQ(read.clearcoat_roughness, material.clearcoat_roughness);
  EXPECT_EQ(read.emission, material.emission);
  EXPECT_EQ(read.alpha_cutoff, material.alpha_cutoff);
}

}  // namespace
}  // namespace arris
