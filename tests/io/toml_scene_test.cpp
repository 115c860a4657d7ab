#include "io/toml_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "arris/error.h"
#include "arris/image.h"
#include "arris/io.h"
#include "geometry/shapes.h"
#include "io/gltf_test_file.h"
#include "support/cut_every_byte.h"
#include "support/error_message.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// Two objects of one mesh with two materials, one of them scaled, and a rounding of its own.
Scene two_part_model() {
  Scene model;
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.triangle_materials.assign(12, MaterialId{0});
  mesh.triangle_materials[3] = MaterialId{1};
  model.meshes = {mesh};
  model.materials.resize(2);
  model.materials[0].name = "inner";
  model.materials[1].name = "outer";
  model.objects.resize(2);
  model.objects[0].name = "lid";
  model.objects[1].name = "body";
  model.objects[1].world_from_object.translation = {0, 0, 5};
  model.rounding.emplace();
  model.rounding->method = RoundMethod::exact;
  model.rounding->radius = 0.125;
  model.camera = Camera{};
  model.notes = {"vertex colours left out"};
  return model;
}

Scene load_model(const std::filesystem::path& path) {
  if (path.filename() == "two.glb") return two_part_model();
  throw Error(Error::Kind::input, path.string(), "no such file");
}

Scene read(const std::string& text) {
  return read_toml_scene(text, "s.toml", "/nonexistent", load_model);
}

std::string refusal(const std::string& text) {
  return test::refusal_of(read, text);
}

const std::string kBox = "[[object]]\nshape = \"box\"\n";

void expect_near(Vec3d a, Vec3d b) {
  EXPECT_LT(length(a - b), 1e-9) << a.x << " " << a.y << " " << a.z;
}

// ---------------------------------------------------------------------------------- the whole scene

TEST(TomlScene, reads_image_camera_and_up) {
  const Scene scene = read(R"(
up = [0, 2, 0]
[image]
size = [640, 480]
samples = 16
max_depth = 4
exposure = -1.5
filter = "box"
[camera]
position = [3, -4, 2.5]
target = [0, 0, 1]
fov = 30
)" + kBox);
  EXPECT_EQ(scene.up, Vec3d(0, 1, 0));
  EXPECT_EQ(scene.image.width_px, 640);
  EXPECT_EQ(scene.image.height_px, 480);
  EXPECT_EQ(scene.image.samples_per_pixel, 16);
  EXPECT_EQ(scene.image.max_depth, 4);
  EXPECT_EQ(scene.image.exposure, -1.5);
  EXPECT_EQ(scene.image.filter, ImageSettings::Filter::box);
  EXPECT_EQ(scene.camera->position, Vec3d(3, -4, 2.5));
  EXPECT_EQ(scene.camera->target, Vec3d(0, 0, 1));
  EXPECT_EQ(scene.camera->up, Vec3d(0, 1, 0));
  EXPECT_EQ(scene.camera->fov_deg, 30);
}

TEST(TomlScene, leaves_to_the_program_what_the_file_does_not_say) {
  const Scene scene = read(kBox);
  EXPECT_FALSE(scene.camera);
  EXPECT_FALSE(scene.environment);
  EXPECT_FALSE(scene.rounding);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.image.width_px, ImageSettings{}.width_px);
  EXPECT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.name, "s");
}

TEST(TomlScene, reads_environments) {
  const auto with = [](const std::string& text) {
    return *read("up = [0, 1, 0]\n[environment]\n" + text + "\n" + kBox).environment;
  };
  EXPECT_EQ(std::get<ConstantEnvironment>(with("type=\"constant\"\ncolor=[1,0.5,0]\nstrength=2"))
                .radiance,
            Rgb(2, 1, 0));
  const auto sky = std::get<SkyEnvironment>(
      with("type=\"sky\"\nsun_direction=[1,2,3]\nturbidity=5\nstrength=0.5\nsun=false"));
  EXPECT_EQ(sky.sun_direction, Vec3d(1, 2, 3));
  EXPECT_EQ(sky.turbidity, 5);
  EXPECT_EQ(sky.strength, 0.5);
  EXPECT_FALSE(sky.sun);
  EXPECT_EQ(sky.up, Vec3d(0, 1, 0));
  EXPECT_EQ(std::get<StudioEnvironment>(with("type=\"studio\"\nstrength=3")).strength, 3);
}

TEST(TomlScene, reads_every_kind_of_light) {
  const Scene scene = read(R"(
[[light]]
type = "point"
position = [1, 2, 3]
color = [1, 0.5, 0.25]
intensity = 4
[[light]]
type = "spot"
position = [0, 0, 5]
target = [0, 0, 1]
intensity = 2
inner_angle = 10
outer_angle = 20
[[light]]
type = "directional"
direction = [0, 1, -1]
irradiance = 3
[[light]]
type = "area"
corner = [1, 1, 4]
edge_u = [2, 0, 0]
edge_v = [0, -3, 0]
radiance = 5
visible = false
)" + kBox);
  ASSERT_EQ(scene.lights.size(), 4U);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity, Rgb(4, 2, 1));
  const auto& spot = std::get<SpotLight>(scene.lights[1]);
  EXPECT_EQ(spot.direction, Vec3d(0, 0, -4));
  EXPECT_DOUBLE_EQ(spot.inner_angle, radians(10));
  EXPECT_DOUBLE_EQ(spot.outer_angle, radians(20));
  EXPECT_EQ(std::get<DirectionalLight>(scene.lights[2]).irradiance, Rgb(3, 3, 3));
  const auto& area = std::get<AreaLight>(scene.lights[3]);
  EXPECT_EQ(area.corner, Vec3d(1, 1, 4));
  EXPECT_EQ(area.edge_v, Vec3d(0, -3, 0));
  EXPECT_EQ(area.radiance, Rgb(5, 5, 5));
  EXPECT_FALSE(area.visible_to_camera);
}

TEST(TomlScene, turns_area_lights_towards_their_target) {
  for (const std::string target : {"[0, 0, 0]", "[1, 2, 9]", "[3, 2, 5]"}) {
    const Scene scene =
        read("[[light]]\ntype=\"area\"\nposition=[1, 2, 5]\nsize=[2, 4]\ntarget=" + target + "\n" +
             kBox);
    const auto& light = std::get<AreaLight>(scene.lights.at(0));
    expect_near(light.corner + (light.edge_u + light.edge_v) * 0.5, {1, 2, 5});
    EXPECT_NEAR(length(light.edge_u), 2, 1e-12);
    EXPECT_NEAR(length(light.edge_v), 4, 1e-12);
    const Vec3d towards = target == "[0, 0, 0]"   ? Vec3d(-1, -2, -5)
                          : target == "[1, 2, 9]" ? Vec3d(0, 0, 1)
                                                  : Vec3d(1, 0, 0);
    expect_near(normalize(cross(light.edge_u, light.edge_v)), normalize(towards));
  }
}

TEST(TomlScene, reads_every_field_of_a_material) {
  const Scene scene = read(R"(
[material.brass]
base_color = [0.9, 0.7, 0.4]
metallic = 1
roughness = 0.2
ior = 1.4
specular = 0.3
specular_color = [0.1, 0.2, 0.3]
transmission = 0.6
clearcoat = 0.7
clearcoat_roughness = 0.8
emission = [1, 2, 3]
emission_strength = 2
opacity = 0.9
alpha_cutoff = 0.25
normal_scale = -2
glossy_mix = 0.1
[material.default]
roughness = 1
[[object]]
shape = "box"
material = "brass"
[[object]]
shape = "box"
)");
  ASSERT_EQ(scene.materials.size(), 2U);
  const Material& brass = scene.materials[scene.objects[0].material.index];
  EXPECT_EQ(brass.name, "brass");
  EXPECT_EQ(brass.base_color, Rgb(0.9F, 0.7F, 0.4F));
  EXPECT_EQ(brass.metallic, 1);
  EXPECT_EQ(brass.roughness, 0.2F);
  EXPECT_EQ(brass.ior, 1.4F);
  EXPECT_EQ(brass.specular, 0.3F);
  EXPECT_EQ(brass.specular_color, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(brass.transmission, 0.6F);
  EXPECT_EQ(brass.clearcoat, 0.7F);
  EXPECT_EQ(brass.clearcoat_roughness, 0.8F);
  EXPECT_EQ(brass.emission, Rgb(2, 4, 6));
  EXPECT_EQ(brass.opacity, 0.9F);
  EXPECT_EQ(brass.alpha_cutoff, 0.25F);
  EXPECT_EQ(brass.normal_scale, -2);
  EXPECT_EQ(brass.glossy_mix, 0.1F);
  EXPECT_EQ(scene.materials[scene.objects[1].material.index].roughness, 1);
}

TEST(TomlScene, loads_textures_and_environment_maps_beside_the_file) {
  const test::TemporaryFolder folder;
  Picture picture;
  picture.color = Image(4, 2, 3);
  for (std::size_t i = 0; i < picture.color.values.size(); ++i)
    picture.color.values[i] = float(i) / 8;
  save_picture(picture, folder / "sky.pfm");
  SaveOptions clip;
  clip.tone_map = false;
  save_picture(picture, folder / "wood.png", clip);
  std::ofstream(folder / "s.toml") << R"(
[environment]
type = "hdr"
file = "sky.pfm"
rotation = 90
[material.wood]
base_color_texture = "wood.png"
normal_texture = { file = "wood.png", wrap = "clamp", wrap_v = "mirror" }
[[object]]
shape = "plane"
material = "wood"
)";
  const Scene scene = load_scene(folder / "s.toml");
  const auto& hdr = std::get<HdrEnvironment>(*scene.environment);
  EXPECT_EQ(hdr.width_px, 4);
  EXPECT_EQ(hdr.radiance.at(5), Rgb(15 / 8.0F, 2, 17 / 8.0F));
  EXPECT_DOUBLE_EQ(hdr.rotation, kPi / 2);
  const Material& wood = scene.materials.at(1);
  const Texture& color = scene.textures.at(wood.base_color_texture->index);
  EXPECT_TRUE(color.srgb);
  EXPECT_EQ(color.width_px, 4);
  const Texture& normal = scene.textures.at(wood.normal_texture->index);
  EXPECT_FALSE(normal.srgb);
  EXPECT_EQ(normal.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(normal.wrap_v, Texture::Wrap::mirror);
}

// ------------------------------------------------------------------------------------------ objects

TEST(TomlScene, applies_scale_then_rotation_about_x_y_z_then_translation) {
  const Scene scene =
      read(kBox + "translate = [10, 0, 0]\nrotate = [90, 0, 90]\nscale = [1, 2, 3]\n");
  const Affine3d& m = scene.objects.at(0).world_from_object;
  expect_near(transform_point(m, {1, 0, 0}), {10, 1, 0});  // x → z-turn → y
  expect_near(transform_point(m, {0, 1, 0}), {10, 0, 2});  // y → x-turn → z
  expect_near(transform_point(m, {0, 0, 1}), {13, 0, 0});  // z → −y → x
}

TEST(TomlScene, reads_a_matrix_as_rows) {
  const Scene scene =
      read(kBox + "matrix = [[0, -1, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9], [0, 0, 0, 1]]\n");
  expect_near(transform_point(scene.objects.at(0).world_from_object, {1, 0, 0}), {7, 9, 9});
}

TEST(TomlScene, makes_every_shape) {
  for (const std::string shape :
       {"box", "sphere", "icosphere", "cylinder", "cone", "prism", "pyramid", "plane",
        "tetrahedron", "octahedron", "dodecahedron", "icosahedron"}) {
    const Scene scene = read("[[object]]\nshape = \"" + shape + "\"\n");
    EXPECT_EQ(test::problem_of(scene), "");
    EXPECT_EQ(scene.objects.at(0).name, shape);
  }
}

TEST(TomlScene, shares_the_mesh_of_equal_shapes) {
  const Scene scene =
      read(kBox + kBox + "size = [1, 1, 1]\n" + kBox + "size = 2\nname = \"big\"\n");
  ASSERT_EQ(scene.objects.size(), 3U);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
  EXPECT_NE(scene.objects[0].mesh, scene.objects[2].mesh);
  EXPECT_EQ(scene.objects[2].name, "big");
}

TEST(TomlScene, places_all_objects_of_a_file_and_shares_its_meshes) {
  const Scene scene = read(R"(
[[object]]
file = "two.glb"
translate = [1, 0, 0]
[[object]]
file = "./two.glb"
name = "spare"
scale = 2
round = "none"
)");
  ASSERT_EQ(scene.objects.size(), 4U);
  EXPECT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "two/lid");
  EXPECT_EQ(scene.objects[3].name, "spare/body");
  expect_near(scene.objects[1].world_from_object.translation, {1, 0, 5});
  expect_near(scene.objects[3].world_from_object.translation, {0, 0, 10});
  EXPECT_EQ(std::get<double>(scene.objects[0].rounding->radius), 0.125);
  EXPECT_EQ(scene.objects[2].rounding->method, RoundMethod::none);
  // the file's materials follow the scene's own
  EXPECT_EQ(scene.materials.at(scene.meshes[0].triangle_materials[3].index).name, "outer");
  EXPECT_THAT(scene.notes, testing::ElementsAre("two.glb: vertex colours left out",
                                                "two.glb: its lights and cameras are left out"));
}

TEST(TomlScene, puts_the_objects_material_before_those_of_the_file) {
  const Scene scene = read(R"(
[material.red]
[[object]]
file = "two.glb"
[[object]]
file = "two.glb"
material = "red"
)");
  ASSERT_EQ(scene.objects.size(), 4U);
  EXPECT_FALSE(scene.meshes[scene.objects[0].mesh.index].triangle_materials.empty());
  EXPECT_TRUE(scene.meshes[scene.objects[2].mesh.index].triangle_materials.empty());
  EXPECT_EQ(scene.objects[2].mesh, scene.objects[3].mesh);
  EXPECT_EQ(scene.materials[scene.objects[2].material.index].name, "red");
}

TEST(TomlScene, reads_rounding_and_inherits_from_the_scene) {
  const Scene scene = read(R"(
[round]
radius = "5%"
edges = "both"
min_angle = 20
[[object]]
shape = "box"
round = { radius = 0.25 }
[[object]]
shape = "box"
round = { method = "shader", delta = 0.1, perturb = 1, divisions = 4 }
[[object]]
shape = "box"
round = "auto"
[[object]]
shape = "box"
round = { method = "mesh", subdivisions = 7, edges = "concave" }
[[object]]
shape = "box"
)");
  EXPECT_EQ(std::get<PercentOfInradius>(scene.rounding->radius).percent, 5);
  EXPECT_EQ(scene.rounding->method, RoundMethod::exact);
  const auto rounding = [&](std::size_t i) { return *scene.objects[i].rounding; };
  EXPECT_EQ(std::get<double>(rounding(0).radius), 0.25);
  EXPECT_EQ(rounding(0).edges, RoundEdges::both);
  EXPECT_DOUBLE_EQ(rounding(0).min_angle, radians(20));
  EXPECT_EQ(rounding(1).method, RoundMethod::shader);
  EXPECT_EQ(rounding(1).shader.delta, 0.1);
  EXPECT_EQ(rounding(1).shader.perturb, 1);
  EXPECT_EQ(rounding(1).shader.divisions, 4);
  EXPECT_TRUE(std::holds_alternative<AutoRadius>(rounding(2).radius));
  EXPECT_EQ(rounding(3).subdivisions, 7);
  EXPECT_EQ(rounding(3).edges, RoundEdges::concave);
  EXPECT_FALSE(scene.objects[4].rounding);
}

TEST(TomlScene, rounds_an_object_that_says_so_in_a_scene_that_does_not) {
  const Scene scene = read("round = \"none\"\n" + kBox + "round = { radius = 1 }\n" + kBox);
  EXPECT_EQ(scene.rounding->method, RoundMethod::none);
  EXPECT_EQ(scene.objects.at(0).rounding->method, RoundMethod::exact);
  EXPECT_FALSE(scene.objects.at(1).rounding);
}

TEST(TomlScene, keeps_the_scenes_method_when_an_object_gives_a_radius_alone) {
  const Scene scene =
      read("round = { method = \"mesh\", subdivisions = 5 }\n" + kBox + "round = 0.5\n");
  EXPECT_EQ(scene.objects.at(0).rounding->method, RoundMethod::mesh);
  EXPECT_EQ(scene.objects.at(0).rounding->subdivisions, 5);
  EXPECT_EQ(std::get<double>(scene.objects.at(0).rounding->radius), 0.5);
}

TEST(TomlScene, reads_the_example_of_its_document) {
  std::ifstream file(std::filesystem::path(ARRIS_SOURCE_DIR) / "docs/scene-format.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("```toml\n") + 8;
  ASSERT_GT(begin, 8U);
  const Scene scene =
      read_toml_scene(text.substr(begin, text.find("```", begin) - begin), "example.toml",
                      "/nonexistent", [](const std::filesystem::path& path) {
                        EXPECT_EQ(path.filename(), "bracket.stl");
                        return two_part_model();
                      });
  EXPECT_EQ(test::problem_of(scene), "");
  EXPECT_EQ(scene.objects.size(), 4U);
  EXPECT_EQ(scene.objects[2].name, "plinth");
  EXPECT_EQ(scene.materials[scene.objects[0].material.index].name, "brass");
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_TRUE(scene.camera && scene.environment && scene.rounding);
}

// ------------------------------------------------------------------------------------------- errors

TEST(TomlScene, names_the_nearest_key_for_an_unknown_one) {
  EXPECT_THAT(
      refusal("[camera]\nposition = [1, 2, 3]\nfovv = 3\n" + kBox),
      AllOf(StartsWith("s.toml:3:1: "), HasSubstr("\"fovv\""), HasSubstr("did you mean \"fov\"?")));
  EXPECT_THAT(refusal("[cammera]\n" + kBox),
              AllOf(StartsWith("s.toml:1:"), HasSubstr("\"camera\"")));
  EXPECT_THAT(refusal("[[object]]\nshape = \"boks\"\n"), HasSubstr("did you mean \"box\"?"));
  EXPECT_THAT(refusal("[material.brass]\n" + kBox + "material = \"bras\"\n"),
              AllOf(StartsWith("s.toml:4:12: "), HasSubstr("did you mean \"brass\"?")));
}

TEST(TomlScene, lists_every_problem_in_the_files_order) {
  const std::string text = refusal(R"([image]
size = [0, 480]
samples = 1.5
[camera]
position = "here"
[material.a]
roughness = 2
metallic = nan
ior = true
[[object]]
shape = "box"
scale = 0
[[object]]
file = "gone.stl"
[[object]]
)");
  std::istringstream lines(text);
  std::vector<std::string> starts;
  for (std::string line; std::getline(lines, line);)
    starts.push_back(line.substr(0, line.find(": ")));
  EXPECT_THAT(starts, testing::ElementsAre("s.toml:2:9", "s.toml:3:11", "s.toml:5:12",
                                           "s.toml:7:13", "s.toml:8:12", "s.toml:9:7",
                                           "s.toml:12:9", "s.toml:14:8", "s.toml:15:1"));
  EXPECT_THAT(text,
              AllOf(HasSubstr("[image] size: is 0; use 1 to 65535"),
                    HasSubstr("must be a whole number"), HasSubstr("roughness: is 2; use 0 to 1"),
                    HasSubstr("not a boolean"), HasSubstr("flattens the object"),
                    HasSubstr("no such file"), HasSubstr("give either \"file\" or \"shape\"")));
}

TEST(TomlScene, picture_sizes_have_the_limits_of_the_command_line) {
  // An array of several wrong numbers is reported once.
  EXPECT_EQ(refusal("[image]\nsize = [0, 0]\n" + kBox),
            "s.toml:2:9: [image] size: is 0; use 1 to 65535");
  EXPECT_EQ(read("[image]\nsize = [65535, 2]\n" + kBox).image.width_px, 65535);
  EXPECT_THAT(refusal("[image]\nsize = [65536, 1]\n" + kBox), HasSubstr("use 1 to 65535"));
  EXPECT_THAT(refusal("[image]\nsize = [65535, 65535]\n" + kBox),
              HasSubstr("use at most 134217728 pixels in all"));
}

TEST(TomlScene, reads_short_forms_of_the_scenes_rounding) {
  EXPECT_EQ(std::get<double>(read("round = 0.25\n" + kBox).rounding->radius), 0.25);
  EXPECT_EQ(std::get<PercentOfInradius>(read("round = \"8%\"\n" + kBox).rounding->radius).percent,
            8);
}

TEST(TomlScene, takes_a_minimum_angle_of_zero) {
  EXPECT_EQ(read("[round]\nmin_angle = 0\n" + kBox).rounding->min_angle, 0);
  EXPECT_THAT(refusal("[round]\nmin_angle = -1\n" + kBox), HasSubstr("use 0 to 180"));
}

TEST(TomlScene, refuses_what_contradicts_itself) {
  EXPECT_THAT(refusal("[camera]\nposition = [1, 2, 3]\ntarget = [1, 2, 3]\n" + kBox),
              HasSubstr("is the target"));
  EXPECT_THAT(refusal("[camera]\nposition = [0, 0, 3]\n" + kBox), HasSubstr("along the view"));
  EXPECT_THAT(refusal(kBox + "scale = 2\nmatrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n"),
              HasSubstr("give it alone"));
  EXPECT_THAT(refusal(kBox + "matrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]\n"),
              HasSubstr("last row"));
  EXPECT_THAT(refusal("[[light]]\ntype = \"spot\"\nposition = [0,0,1]\n" + kBox),
              HasSubstr("either \"direction\" or \"target\""));
  EXPECT_THAT(
      refusal("[[light]]\ntype = \"area\"\ncorner = [0,0,0]\nedge_u = [1,0,0]\nedge_v = [2,0,0]\n" +
              kBox),
      HasSubstr("spans no area"));
  EXPECT_THAT(refusal("up = [0, 0, 0]\n" + kBox), HasSubstr("direction"));
  EXPECT_THAT(refusal(kBox + "round = -1\n"), HasSubstr("not a rounding"));
  EXPECT_THAT(refusal(kBox + "round = { radius = 0 }\n"), HasSubstr("above 0"));
  EXPECT_THAT(refusal("[environment]\nstrength = 1\n" + kBox), HasSubstr("\"type\" is missing"));
  EXPECT_THAT(refusal(""), HasSubstr("add an [[object]]"));
  EXPECT_THAT(refusal("object = []"), HasSubstr("add an [[object]]"));
  EXPECT_THAT(refusal("object = 3"), HasSubstr("array of tables"));
}

TEST(TomlScene, refuses_scene_files_as_objects) {
  EXPECT_THAT(refusal("[[object]]\nfile = \"s.toml\"\n"),
              HasSubstr("can't hold other scene files"));
  EXPECT_THAT(refusal("[[object]]\nfile = \"sub/../S.TOML\"\n"),
              HasSubstr("can't hold other scene files"));
}

TEST(TomlScene, refuses_text_that_is_not_toml) {
  EXPECT_THAT(refusal("[camera\n"), StartsWith("s.toml:1:"));
  EXPECT_THAT(refusal("a = 1\na = 2\n"), StartsWith("s.toml:2:"));
  EXPECT_THAT(refusal("[=]\n"), StartsWith("s.toml:1:2: "));
  EXPECT_THAT(refusal(std::string("[\0camera]\n", 10)), StartsWith("s.toml:1:2: "));
  EXPECT_THAT(refusal("up = 1\n \u02DEa = 1\n"),
              AllOf(StartsWith("s.toml:2:2: "), HasSubstr("quote it")));
  EXPECT_THAT(refusal("a = 'x\x01'\n"), StartsWith("s.toml:1:7: "));
  EXPECT_THAT(refusal("a = \"\xFF\"\n"), HasSubstr("UTF-8"));
}

TEST(TomlScene, takes_every_kind_of_string_and_a_byte_order_mark) {
  const Scene scene = read("\xEF\xBB\xBF" + kBox +
                           "name = \"\"\"\"Bo\\u00DF\\\"...................\"\"\"\"\" # \u00FC\n" +
                           kBox + "name = '''a'b\u00E4\nc'''''\n");
  EXPECT_EQ(scene.objects.at(0).name, "\"Bo\u00DF\"...................\"\"");
  EXPECT_EQ(scene.objects.at(1).name, "a'b\u00E4\nc''");
}

TEST(TomlScene, refuses_more_triangles_than_a_short_file_should_make) {
  std::string text;
  for (int i = 0; i < 100; ++i) {
    text +=
        "[[object]]\nshape = \"sphere\"\nsegments = 512\nradius = " + std::to_string(i + 1) + "\n";
  }
  EXPECT_THAT(refusal(text), HasSubstr("shapes have more than"));
}

TEST(TomlScene, stays_sound_when_cut_at_every_byte_or_changed) {
  const std::string text = R"(up=[0,0,1]
[image]
size=[64,48]
[camera]
position=[3,-4,2.5]
[environment]
type="sky"
[[light]]
type="area"
position=[0,0,5]
target=[0,0,0]
[material.a]
ior=1.4
[[object]]
file="two.glb"
material="a"
[[object]]
shape="prism"
sides=5
round={radius="5%"}
)";
  // A list of problems has a line for each; the harness asks for one line.
  const auto read_bytes = [](std::span<const std::uint8_t> bytes) {
    try {
      return read(std::string(bytes.begin(), bytes.end()));
    } catch (const Error& error) {
      std::string what = error.what();
      std::ranges::replace(what, '\n', ' ');
      throw Error(error.kind(), error.where(), what);
    }
  };
  test::cut_every_byte(test::bytes_of(text), read_bytes);
  test::change_every_byte(test::bytes_of(text), read_bytes);
}

// ------------------------------------------------------------------------------------------ keys

TEST(TomlKeys, of_camera_object_and_light_keep_what_they_leave_out) {
  const Scene scene = read(R"(
[animation]
interpolation = "linear"
[camera]
position = [1, 2, 3]
fov = 20
[[camera.key]]
frame = -1.5
[[camera.key]]
frame = 10
position = [5, 2, 3]
fov = 40
[[light]]
type = "spot"
position = [0, 0, 5]
target = [0, 0, 0]
intensity = 2
[[light.key]]
frame = 0
[[light.key]]
frame = 4
intensity = 6
color = [1, 0.5, 0]
[[object]]
shape = "box"
translate = [1, 0, 0]
[[object.key]]
frame = 0
[[object.key]]
frame = 2
rotate = [0, 0, 90]
scale = 2
)");
  EXPECT_EQ(scene.animation.interpolation, Interpolation::linear);
  ASSERT_EQ(scene.animation.camera.size(), 2U);
  EXPECT_EQ(scene.animation.camera[0].camera.position, Vec3d(1, 2, 3));
  EXPECT_EQ(scene.animation.camera[1].frame, 10);
  EXPECT_EQ(scene_at(scene, 4.25).camera->position, Vec3d(3, 2, 3));
  EXPECT_EQ(scene_at(scene, 4.25).camera->fov_deg, 30);
  EXPECT_EQ(scene_at(scene, -100).camera->fov_deg, 20);
  const auto spot = std::get<SpotLight>(scene_at(scene, 2).lights[0]);
  EXPECT_EQ(spot.intensity, Rgb(4, 3, 2));
  EXPECT_EQ(spot.direction, Vec3d(0, 0, -5));
  EXPECT_EQ(scene_at(scene, 0).objects[0].world_from_object, scene.objects[0].world_from_object);
  const Affine3d at_end = scene_at(scene, 3).objects[0].world_from_object;
  expect_near(at_end.linear.x, {0, 2, 0});
  expect_near(at_end.translation, {1, 0, 0});
}

TEST(TomlKeys, move_all_parts_of_a_file) {
  const Scene scene = read(R"([[object]]
file = "two.glb"
[[object.key]]
frame = 0
translate = [0, 1, 0]
)");
  expect_near(scene.objects[0].world_from_object.translation, {0, 1, 0});
  expect_near(scene.objects[1].world_from_object.translation, {0, 1, 5});
}

TEST(TomlKeys, a_scene_is_that_of_frame_0) {
  const Scene scene = read(kBox +
                           "[[object.key]]\nframe = -1\ntranslate = [0, 0, 0]\n"
                           "[[object.key]]\nframe = 1\ntranslate = [4, 0, 0]\n");
  expect_near(scene.objects[0].world_from_object.translation, {2, 0, 0});
}

TEST(TomlKeys, that_make_no_scene_of_frame_0_are_refused) {
  EXPECT_EQ(refusal(kBox + "[[light]]\ntype = \"directional\"\ndirection = [0, 0, 1]\n"
                           "[[light.key]]\nframe = -1\n"
                           "[[light.key]]\nframe = 1\ndirection = [0, 0, -1]\n"),
            "s.toml: frame 0: light 1: direction is (0, 0, 0); give a vector other than 0; move "
            "the keys around it");
}

TEST(TomlKeys, that_lead_a_light_through_its_target_are_refused_in_words) {
  EXPECT_EQ(refusal(kBox + "[[light]]\ntype = \"area\"\nposition = [0, 0, 3]\n"
                           "target = [0, 0, 0]\nsize = 1\nradiance = 1\n"
                           "[[light.key]]\nframe = -1\nposition = [0, 0, 3]\n"
                           "[[light.key]]\nframe = 1\nposition = [0, 0, -3]\n"),
            "s.toml: frame 0: light 1: has no size, or lies in its own target; move the keys "
            "around it");
}

TEST(TomlKeys, wrong_ones_are_refused_with_their_place) {
  const auto of_box = [](const std::string& text) { return refusal(kBox + text); };
  const std::string camera = kBox + "[camera]\nposition = [1, 2, 3]\n";
  EXPECT_THAT(of_box("[[object.key]]\ntranslate = [1, 2, 3]\n"),
              HasSubstr("s.toml:3:1: object 1 key 1: \"frame\" is missing"));
  EXPECT_THAT(
      of_box("[[object.key]]\nframe = 1\n[[object.key]]\nframe = 1\n"),
      HasSubstr("s.toml:6:9: object 1 key 2 frame: is 1, after 1; use at least 0.001 more"));
  EXPECT_THAT(of_box("[[object.key]]\nframe = 2000000\n"),
              HasSubstr("object 1 key 1 frame: is 2000000; use -1e+06 to 1e+06"));
  EXPECT_THAT(of_box("[[object.key]]\nframe = nan\n"), HasSubstr("object 1 key 1 frame"));
  EXPECT_THAT(of_box("[[object.key]]\nframe = 0\nscale = [1, 0, 1]\n"),
              HasSubstr("object 1 key 1 scale: flattens the object"));
  EXPECT_THAT(of_box("[[object.key]]\nframe = 0\ntranslat = [1, 0, 1]\n"),
              HasSubstr("object 1 key 1: unknown key \"translat\"; did you mean \"translate\"?"));
  EXPECT_THAT(of_box("key = 3\n"), HasSubstr("key: must be an array of tables"));
  EXPECT_THAT(of_box("key = [1]\n"), HasSubstr("key 1: must be a table with a frame"));
  EXPECT_THAT(
      of_box("matrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n[[object.key]]\nframe = 0\n"),
      HasSubstr("an object with \"matrix\" can't have keys; use translate, rotate and scale"));
  EXPECT_THAT(refusal(camera + "[[camera.key]]\nframe = 0\nposition = [0, 0, 0]\n"),
              HasSubstr("[camera] key 1 position: is the target"));
  EXPECT_THAT(refusal(camera + "[[camera.key]]\nframe = 0\nfov = 179\n"),
              HasSubstr("[camera] key 1 fov: is 179"));
  EXPECT_THAT(refusal(kBox + "[[light]]\ntype = \"point\"\nposition = [0, 0, 1]\n[[light.key]]\n"
                             "frame = 0\ntarget = [1, 2, 3]\n"),
              HasSubstr("light 1 key 1: unknown key \"target\""));
  EXPECT_THAT(refusal(kBox + "[[light]]\ntype = \"area\"\ncorner = [0, 0, 1]\nedge_u = [1, 0, 0]\n"
                             "edge_v = [0, 1, 0]\n[[light.key]]\nframe = 0\n"),
              HasSubstr("a light with \"corner\" can't have keys"));
  EXPECT_THAT(refusal(kBox + "[animation]\ninterpolation = \"smoth\"\n"),
              HasSubstr("did you mean \"smooth\"?"));
}

}  // namespace
}  // namespace arris
