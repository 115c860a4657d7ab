#include "view/scene_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "arris/io.h"
#include "arris/render.h"
#include "io/gltf_test_file.h"
#include "program/run_program.h"
#include "scene/material_presets.h"
#include "support/temporary_folder.h"
#include "view/same_scene.h"
#include "view/view_stage.h"

namespace arris::view {
namespace {

using test::TemporaryFolder;
using test::write_text;
using testing::HasSubstr;

// As the program opens it.
ViewModel open(const std::filesystem::path& file) {
  ViewModel model;
  model.name = file.filename().string();
  model.file = file;
  model.scene = load_scene(file);
  model.is_scene_file = file.extension() == ".toml";
  if (model.is_scene_file) {
    model.text = test::read_text(file);
    model.stage.source = StageOptions::Source::scene_file;
  }
  model.has_own_rounding = model.scene.rounding.has_value();
  if (!model.is_scene_file && !model.scene.rounding) {
    model.scene.rounding.emplace().method = RoundMethod::exact;
  }
  return model;
}

// Saved elsewhere, and as `arris render` gets it.
Scene save_and_render(const ViewModel& model, const ViewEdits& edits) {
  const TemporaryFolder downloads;
  write_text(downloads / "scene.toml", make_scene_file(model, edits));
  Scene scene = load_scene(downloads / "scene.toml");
  StageOptions options;
  options.source = StageOptions::Source::scene_file;
  stage_model(scene, options);
  EXPECT_TRUE(validate_scene(scene).empty());
  return scene;
}

void expect_saved(const ViewModel& model, const ViewEdits& edits) {
  test::expect_same_scene(save_and_render(model, edits), stage_view(model, edits).scene);
}

std::string refusal(const ViewModel& model, const ViewEdits& edits) {
  try {
    make_scene_file(model, edits);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "(was saved)";
}

// Three cubes: two in one file, the second with a material; one turned by its node, with a radius of its own.
void write_models(const TemporaryFolder& folder) {
  write_text(folder / "cube.stl", test::cube_stl(2));
  write_text(folder / "paint.mtl", "newmtl red\nKd 0.9 0.1 0.1\n");
  std::string obj = "mtllib paint.mtl\n";
  for (int i = 0; i < 2; ++i) {
    obj += i == 0 ? "o cube\n" : "o cube\nusemtl red\n";
    for (int corner = 0; corner < 8; ++corner) {
      obj += fmt::format("v {} {} {}\n", (corner & 1) + 2 * i, corner >> 1 & 1, corner >> 2);
    }
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "2 4 8 6", "4 3 7 8", "3 1 5 7"}) {
      std::string line = "f";
      for (const char* c = face; *c != '\0'; ++c) {
        if (*c != ' ') line += fmt::format(" {}", *c - '0' + 8 * i);
      }
      obj += line + "\n";
    }
  }
  write_text(folder / "two.obj", obj);
  test::GltfTestFile file;
  std::vector<Vec3f> corners;
  for (int corner = 0; corner < 8; ++corner) {
    corners.emplace_back(float(corner & 1), float(corner >> 1 & 1), float(corner >> 2));
  }
  const auto positions = file.add_vec3(corners);
  const auto indices = file.add_indices({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  file.add("nodes", {{"mesh", 0}, {"name", "a"}, {"rotation", {0.6, 0, 0, 0.8}}});
  file.add("nodes", {{"mesh", 0},
                     {"name", "b"},
                     {"translation", {3, 0.1, 0}},
                     {"extras", {{"arris_radius", "7%"}}}});
  file.json["asset"]["extras"] = {{"arris_radius", 0.125}};
  file.json["scenes"] = {{{"nodes", {0, 1}}}};
  file.json["scene"] = 0;
  const auto glb = file.glb();
  write_text(folder / "nodes.glb", {glb.begin(), glb.end()});
}

// In ways that a reader of lines gets wrong.
constexpr std::string_view kHostileScene = R"toml(# [[object]] in a comment
"up" = [0, 0,
  1]  # ] [camera]
camera.position = [6, -7, 5]
camera."fov" = 30
'camera'.target = [ 1.0, # [image]
  0.25, 0 ]
round.radius = "10%" # = "
round.rules = [{ radius = 0, angle = [10, 50] }]
image = { size = [320, 200], "samples" = 3, filter = 'tent' }
  [ material . "a.b \"c\" #" ]
base_color = [0.1, 0.2, 0.3]
[[ "object" ]]
name = """
[camera]
position = [9, 9, 9]"""
shape = "box"
material = "a.b \"c\" #"
rotate = [0, 0, 30]
  [[object.key]]
  frame = -5
  [[object.key]]
  frame = 7
  translate = [0, 0, 2.5]
[[light]]
type = "spot"
position = [1, 2, 3]
target = [0.1, 0.2, 0.3]
color = [0.7, 0.6, 0.1]
inner_angle = 12.3
outer_angle = 33.3
[[object]]
file = 'two.obj'
round = { radius = 0.03, rules = [{ radius = "33%", box = [[0, 0, 0], [1, 1, 1]] }] }
scale = 0.7
  [[object.part]]
  number = 2
  round = "none"
  material = 'other'
[animation]
interpolation = "linear"
[[object]]
file = "nodes.glb"
name = 'quotes " and \ and ''
translate = [-4, 0, 0]
[material]
other = { roughness = 0.25 }
[material.default]
metallic = 1
[[light]]
type = "area"
position = [3, 3, 3]
direction = [-1, -1, -0.9]
radiance = 3e10
[[object]]
shape = "sphere"
hidden = true
[[object]]
shape = "cone"
translate = [0, 3, 0]
)toml";

std::string hostile_scene() {
  std::string text(kHostileScene);
  text.replace(text.find("and ''"), 6, "and '");
  return text;
}

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

Affine3d some_place(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-2, 2);
  const auto vector = [&] { return Vec3d(number(random), number(random), number(random)); };
  return {{vector(), vector(), vector()}, vector()};
}

// Everything that a page can change.
void change(const ViewModel& model, ViewEdits& edits, std::mt19937& random) {
  std::uniform_real_distribution<double> number(0.01, 2);
  const auto pick = [&](std::size_t count) { return random() % count; };
  const Radius radii[] = {AutoRadius{}, number(random), PercentOfInradius{number(random)}};
  SetObject object;
  object.id = std::uint32_t(pick(model.scene.objects.size()));
  SetRounding rounding;
  SetCamera camera{edits.camera};
  switch (pick(9)) {
    case 0:
      object.world_from_object = some_place(random);
      return apply_message(model, object, edits);
    case 1:
      object.visible = pick(2) == 0;
      return apply_message(model, object, edits);
    case 2:
      object.radius = radii[pick(3)];
      return apply_message(model, object, edits);
    case 3:
      object.radius.emplace();
      return apply_message(model, object, edits);
    case 4:
      rounding.method =
          std::array{RoundMethod::none, RoundMethod::exact, RoundMethod::shader}[pick(3)];
      rounding.radius = radii[pick(3)];
      rounding.min_angle = radians(90 * number(random));
      rounding.edges = RoundEdges::both;
      return apply_message(model, rounding, edits);
    case 5: {
      const std::vector<LightChoice> lightings = lightings_of(model);
      const LightChoice choice = lightings[pick(unsigned(lightings.size()))];
      const double rotation = std::floor(number(random) * 1e3) / 10;
      return apply_message(model, SetLight{choice, number(random), rotation}, edits);
    }
    case 6:
      return apply_message(model, pick(2) == 0 ? SetMaterial{"brass"} : SetMaterial{}, edits);
    case 7:
      return apply_message(model, SetGround{pick(2) == 0}, edits);
    default:
      camera.camera.position = Vec3d(number(random), number(random) + 5, number(random));
      camera.camera.fov_deg = 10 + number(random);
      return apply_message(model, camera, edits);
  }
}

void expect_saved_whatever_is_changed(const ViewModel& model, unsigned seed) {
  std::mt19937 random(seed);
  ViewEdits edits = first_edits(model);
  expect_saved(model, edits);
  for (int step = 0; step < 60 && !testing::Test::HasFailure(); ++step) {
    SCOPED_TRACE(fmt::format("seed {}, step {}", seed, step));
    if (random() % 10 == 0) edits = first_edits(model);
    change(model, edits, random);
    if (std::ranges::any_of(edits.objects, &ObjectEdit::visible)) expect_saved(model, edits);
  }
  if (testing::Test::HasFailure()) ADD_FAILURE() << make_scene_file(model, edits);
}

TEST(SceneFile, of_models_shows_what_the_viewer_shows) {
  const TemporaryFolder folder;
  write_models(folder);
  unsigned seed = 1;
  for (const char* name : {"cube.stl", "two.obj", "nodes.glb"}) {
    SCOPED_TRACE(name);
    expect_saved_whatever_is_changed(open(folder / name), seed++);
  }
}

TEST(SceneFile, of_scene_files_shows_what_the_viewer_shows_however_they_are_written) {
  const TemporaryFolder folder;
  write_models(folder);
  unsigned seed = 11;
  for (const std::string& text : {hostile_scene(), with_crlf(hostile_scene()),
                                  "\xEF\xBB\xBF" + hostile_scene() + "# no end of line"}) {
    write_text(folder / "s.toml", text);
    const ViewModel model = open(folder / "s.toml");
    ASSERT_EQ(model.scene.objects.size(), 6U);
    expect_saved_whatever_is_changed(model, seed++);
  }
}

double first_radius_of(const Scene& scene) {
  return prepare_stats(*prepare_scene(scene, {.threads = 1})).rounding.at(0).radius;
}

TEST(SceneFile, has_the_views_automatic_radius_whatever_the_size_of_its_picture) {
  const TemporaryFolder folder;
  write_models(folder);
  const ViewModel model = open(folder / "cube.stl");
  ViewEdits edits = first_edits(model);
  const double radius = first_radius_of(stage_view(model, edits).scene);
  apply_message(model, SetSize{{120, 90}}, edits);
  Scene scene = save_and_render(model, edits);
  EXPECT_EQ(scene.image.height_px, 90);
  EXPECT_EQ(first_radius_of(scene), radius);
  scene.image.height_px = 30;
  scene.camera->position = scene.camera->position * 2;
  EXPECT_EQ(first_radius_of(scene), radius);
}

TEST(SceneFile, follows_light_as_far_as_the_view) {
  const TemporaryFolder folder;
  write_models(folder);
  ViewModel model = open(folder / "cube.stl");
  model.scene.image.max_depth = 5;
  ViewEdits edits = first_edits(model);
  const auto depth = [&](EdgePointShader shader) {
    apply_message(model, SetShader{shader}, edits);
    return save_and_render(model, edits).image.max_depth;
  };
  EXPECT_EQ(depth(EdgePointShader::gi), 5);
  EXPECT_EQ(depth(EdgePointShader::direct), 1);
  EXPECT_THAT(make_scene_file(model, edits), HasSubstr("It was 5"));
  EXPECT_EQ(depth(EdgePointShader::glossy), 5);
  EXPECT_THAT(make_scene_file(model, edits), HasSubstr("--shader glossy -o"));
  model.scene.image.max_depth = 0;
  EXPECT_EQ(depth(EdgePointShader::direct), 0);
}

TEST(SceneFile, can_be_opened_and_saved_again) {
  const TemporaryFolder folder;
  write_models(folder);
  write_text(folder / "s.toml", hostile_scene());
  std::mt19937 random(21);
  ViewModel model = open(folder / "s.toml");
  for (int time = 0; time < 8; ++time) {
    ViewEdits edits = first_edits(model);
    for (int i = 0; i < 3; ++i) change(model, edits, random);
    edits.objects[0].visible = true;
    expect_saved(model, edits);
    write_text(folder / "s.toml", make_scene_file(model, edits));
    model = open(folder / "s.toml");
  }
}

TEST(SceneFile, names_maps_and_textures_where_they_are) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "pictures");
  Picture picture;
  picture.color = Image(4, 2, 3);
  for (std::size_t i = 0; i < picture.color.values.size(); ++i) {
    picture.color.values[i] = float(i) / 8;
  }
  save_picture(picture, folder / "pictures/sky.pfm");
  save_picture(picture, folder / "pictures/wood.png");
  write_text(folder / "s.toml", R"(
environment = { type = "hdr", file = "pictures/sky.pfm", rotation = 300 }
material.a.base_color_texture = "./pictures/wood.png"
material.b.base_color_texture = { wrap = "clamp", file = "pictures/../pictures/wood.png" }
object = [{ shape = "plane", material = "a" }, { shape = "plane", material = "b" }]
)");
  const ViewModel model = open(folder / "s.toml");
  ViewEdits edits = first_edits(model);
  apply_message(model, SetLight{{}, 0.5, 170.0}, edits);
  expect_saved(model, edits);
}

TEST(SceneFile, keeps_what_moves_where_the_viewer_has_not_moved_it) {
  const TemporaryFolder folder;
  write_text(folder / "s.toml", R"(
camera = { position = [3, 3, 3], key = [{ frame = 0 }, { frame = 9, fov = 20 }] }
[animation]
interpolation = "linear"
[[object]]
shape = "box"
key = [{ frame = -1 }, { frame = 3, translate = [1, 0, 0] }]
)");
  const ViewModel model = open(folder / "s.toml");
  ViewEdits edits = first_edits(model);
  const Scene kept = save_and_render(model, edits);
  EXPECT_EQ(kept.animation.objects.size(), 1U);
  EXPECT_TRUE(kept.animation.camera.empty());
  EXPECT_EQ(kept.animation.interpolation, Interpolation::linear);
  edits.objects[0].world_from_object.translation = {5, 5, 5};
  EXPECT_FALSE(save_and_render(model, edits).animation.has_keys());
}

TEST(SceneFile, names_files_with_any_characters_that_are_text) {
  const TemporaryFolder folder;
  for (const std::string name : {"a b.stl", "'single' \"double\".stl", "back\\slash\\.stl",
                                 "#[x]=.stl", "line\n[camera]\nx.stl", "\t\x01\x7f.stl",
                                 "\xC3\xBC\xE2\x82\xAC.stl", "..stl", "%20.stl"}) {
    SCOPED_TRACE(name);
    write_text(folder / name, test::cube_stl(2));
    const ViewModel model = open(folder / name);
    expect_saved(model, first_edits(model));
  }
}

TEST(SceneFile, refuses_names_that_are_not_text_and_says_which) {
  const TemporaryFolder folder;
  write_text(folder / "caf\xE9.stl", test::cube_stl(2));
  const ViewModel model = open(folder / "caf\xE9.stl");
  EXPECT_THAT(refusal(model, first_edits(model)),
              testing::AllOf(HasSubstr("caf\xEF\xBF\xBD.stl"), HasSubstr("not UTF-8")));
}

TEST(SceneFile, goes_beside_the_model_where_its_folders_name_is_no_text) {
  const TemporaryFolder folder;
  const std::filesystem::path odd = folder / "caf\xE9";
  std::filesystem::create_directory(odd);
  write_text(odd / "cube.stl", test::cube_stl(2));
  const ViewModel model = open(odd / "cube.stl");
  const std::string text = make_scene_file(model, first_edits(model));
  EXPECT_THAT(text, HasSubstr("# Save it beside cube.stl"));
  write_text(odd / "s.toml", text);
  const ViewModel scene = open(odd / "s.toml");
  EXPECT_EQ(scene.scene.objects.size(), 1U);
  EXPECT_THAT(make_scene_file(scene, first_edits(scene)), HasSubstr("# Save it beside s.toml"));
}

TEST(SceneFile, follows_links_and_dots_as_the_system_does) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "real/deep");
  write_text(folder / "real/cube.stl", test::cube_stl(2));
  write_text(folder / "cube.stl",
             test::cube_stl(3));  // where ".." of the link's own name would lead
  std::filesystem::create_directory_symlink(folder / "real/deep", folder / "link");
  const ViewModel model = open(folder / "link/../cube.stl");
  expect_saved(model, first_edits(model));
}

TEST(SceneFile, of_a_pipe_or_of_nothing_to_see_is_an_error) {
  const TemporaryFolder folder;
  write_models(folder);
  ViewModel model = open(folder / "two.obj");
  ViewEdits edits = first_edits(model);
  for (ObjectEdit& object : edits.objects) object.visible = false;
  EXPECT_THAT(refusal(model, edits), HasSubstr("hidden"));
  edits = first_edits(model);
  model.file.clear();
  EXPECT_THAT(make_scene_file(model, edits), HasSubstr("Save it beside two.obj"));
  model.name = "stdin";
  EXPECT_THAT(refusal(model, edits), HasSubstr("pipe"));
}

}  // namespace
}  // namespace arris::view
