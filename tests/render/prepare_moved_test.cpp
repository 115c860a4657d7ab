// A moved scene is what it would be if it were prepared anew, and leaves the one before as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "arris/error.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "scene/placement.h"
#include "support/convex_solids.h"
#include "support/csg_oracle.h"
#include "support/error_message.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

using oracle::Random;
using oracle::uniform;
using testing::HasSubstr;

constexpr PrepareOptions kMovable{.placement = Placement::movable};

Affine3d random_place(Random& random, Vec3d scale) {
  const auto turn = [&] { return uniform(random, -180, 180); };
  return make_placement(
      {uniform(random, -1.5, 1.5), uniform(random, -1.5, 1.5), uniform(random, -0.5, 1)},
      {turn(), turn(), turn()}, scale);
}

Material textured(Scene& scene) {
  Texture texture;
  texture.width_px = texture.height_px = 2;
  texture.texels = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 120}};
  scene.textures.push_back(texture);
  Material material = make_lambert(0.8F);
  material.base_color_texture = TextureId{0};
  return material;
}

// Rounded boxes that reach into each other, two of one mesh, one sheared; a lamp, a translucent picture, CSG.
Scene random_scene(Random& random) {
  Camera camera;
  camera.position = {3, -5, 3};
  Scene scene = make_empty_scene(camera);
  scene.image.width_px = 24;
  scene.image.height_px = 18;
  scene.environment = SkyEnvironment{};
  scene.lights = {PointLight{{2, -3, 4}, Rgb(8)}, AreaLight{{-1, -2, 3}, {1, 0, 0}, {0, -1, 0}}};
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = 0.1;
  scene.rounding = rounding;
  add_object(scene, make_box_mesh({0.7, 0.5, 0.6}), make_lambert(0.6F),
             random_place(random, Vec3d(1)));
  Object second = scene.objects[0];
  second.world_from_object = random_place(random, Vec3d(0.8));
  scene.objects.push_back(second);
  rounding.radius = PercentOfInradius{30};
  add_object(scene, make_box_mesh({0.5, 0.5, 0.5}), make_lambert(0.4F),
             random_place(random, {1, 0.6, 1.2}))
      .rounding = rounding;
  add_object(scene, make_box_mesh({0.4, 0.6, 0.5}), make_lambert(0.3F),
             random_place(random, Vec3d(1)))
      .rounding = rounding;
  Material lamp = make_lambert(0);
  lamp.emission = {3, 2, 1};
  add_object(scene, make_sphere_mesh(1), lamp, random_place(random, Vec3d(0.2))).rounding =
      RoundingSettings{};
  const Material material = textured(scene);
  add_object(scene, make_square_mesh(0.8F), material, random_place(random, Vec3d(1)));
  add_object(scene, make_square_mesh(6), make_lambert(0.5F), translation({0, 0, -1}));
  for (int i = 0; i < 2; ++i) {
    Object solid;
    solid.name = "drilled";
    solid.csg = CsgId{0};
    solid.world_from_object = random_place(random, Vec3d(0.4));
    scene.objects.push_back(solid);
  }
  scene.csg_trees = {flat_tree(CsgOperation::subtract, {{CsgBox{Vec3d(-1), Vec3d(1)}, {}, {0}},
                                                        {CsgCone{-2, 2, 0.5, 0.5}, {}, {1}}})};
  return scene;
}

// Some objects are elsewhere, not all of the same scale as before.
void move_some(Scene& scene, Random& random) {
  constexpr double kScales[] = {1, 0.8, 1, 1, 0.2, 1};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (uniform(random, 0, 1) < 0.4 || i == 6) continue;
    const double scale = i < 6 ? kScales[i] : 0.4;
    scene.objects[i].world_from_object =
        random_place(random, uniform(random, 0, 1) < 0.2 ? Vec3d(1.1 * scale) : Vec3d(scale));
  }
  std::get<PointLight>(scene.lights[0]).position.x = uniform(random, -3, 3);
  scene.camera->position.x = uniform(random, -4, 4);
}

std::vector<float> picture_of(const PreparedScene& scene) {
  RenderOptions options;
  options.samples = {0, 4};
  return make_path_renderer()->render(scene, options).picture.color.values;
}

// Of pixels that differ by more than float noise.
double differing(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    count += std::abs(a[i] - b[i]) > 1e-3F * (1 + std::abs(a[i])) ? 1U : 0U;
  }
  return double(count) / double(a.size());
}

TEST(prepare_moved, equals_preparing_anew) {
  Random random(1);
  for (int run = 0; run < 8; ++run) {
    Scene scene = random_scene(random);
    auto prepared = prepare_scene(scene, kMovable);
    for (int step = 0; step < 4; ++step) {
      move_some(scene, random);
      prepared = prepare_moved(*prepared, scene, kMovable);
      const std::vector<float> moved = picture_of(*prepared);
      EXPECT_EQ(moved, picture_of(*prepare_scene(scene, kMovable))) << run << " " << step;
      // Rays are rounded otherwise in an object's own space: a path now and then goes another way.
      EXPECT_LT(differing(moved, picture_of(*prepare_scene(scene))), 0.02) << run << " " << step;
      const PrepareStats stats = prepare_stats(*prepared);
      const PrepareStats fresh = prepare_stats(*prepare_scene(scene, kMovable));
      EXPECT_EQ(stats.rounded_edges, fresh.rounded_edges);
      EXPECT_EQ(stats.rounding_bytes, fresh.rounding_bytes);
    }
  }
}

// Voids of rounded edges are crossed in one step only where nothing is: not so after something came.
TEST(prepare_moved, knows_what_has_come_into_the_void_of_an_edge) {
  Camera camera;
  camera.position = {2.6, -2.4, 2.2};
  Scene scene = make_empty_scene(camera);
  scene.environment = ConstantEnvironment{Rgb(1)};
  scene.image.width_px = scene.image.height_px = 48;
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = 0.3;
  scene.rounding = rounding;
  add_object(scene, make_box_mesh(Vec3d(1)), make_lambert(0.5F));
  add_object(scene, make_box_mesh(Vec3d(0.15)), make_lambert(0.9F), translation({9, 9, 9}))
      .rounding = RoundingSettings{};
  const auto far = prepare_scene(scene, kMovable);
  scene.objects[1].world_from_object = translation({0.9, -0.9, 0.2});
  const auto near = prepare_moved(*far, scene, kMovable);
  EXPECT_EQ(far->rounding().geometries[0].neighbors, nullptr);
  ASSERT_NE(near->rounding().geometries[0].neighbors, nullptr);
  EXPECT_EQ(near->rounding().neighbors, prepare_scene(scene, kMovable)->rounding().neighbors);
  EXPECT_EQ(near->rounding().geometries[0].rounding, far->rounding().geometries[0].rounding);
  EXPECT_NE(picture_of(*near), picture_of(*far));
}

TEST(prepare_moved, shares_all_geometry_if_only_camera_and_lights_move) {
  Random random(2);
  for (const Placement placement : {Placement::baked, Placement::movable}) {
    Scene scene = random_scene(random);
    const auto before = prepare_scene(scene, {.placement = placement});
    scene.camera->position = {1, -6, 2};
    scene.lights.pop_back();
    const auto after = prepare_moved(*before, scene, {.placement = placement});
    EXPECT_EQ(&after->geometry().embree, &before->geometry().embree);
    EXPECT_EQ(&after->rounding(), &before->rounding());
    EXPECT_EQ(after->geometry().lights.environment, before->geometry().lights.environment);
    EXPECT_EQ(picture_of(*after), picture_of(*prepare_scene(scene, {.placement = placement})));
  }
}

TEST(prepare_moved, bakes_anew_what_was_baked) {
  Random random(3);
  Scene scene = random_scene(random);
  const auto before = prepare_scene(scene);
  move_some(scene, random);
  EXPECT_EQ(picture_of(*prepare_moved(*before, scene)), picture_of(*prepare_scene(scene)));
}

TEST(prepare_moved, leaves_the_scene_before_to_those_who_use_it) {
  Random random(4);
  Scene scene = random_scene(random);
  auto before = prepare_scene(scene, kMovable);
  const std::vector<float> expected = picture_of(*before);
  std::atomic<bool> differs = false;
  std::thread user([&, before] {
    for (int i = 0; i < 6; ++i) differs = differs || picture_of(*before) != expected;
  });
  auto moved = before;
  for (int i = 0; i < 6; ++i) {
    move_some(scene, random);
    moved = prepare_moved(*moved, scene, kMovable);
  }
  user.join();
  EXPECT_FALSE(differs);
  before.reset();
  EXPECT_EQ(picture_of(*moved), picture_of(*prepare_scene(scene, kMovable)));
}

TEST(prepare_moved, keeps_automatic_radii_and_the_default_of_the_scene_before) {
  Random random(5);
  Scene scene = random_scene(random);
  scene.rounding->radius = AutoRadius{};
  auto prepared = prepare_scene(scene, kMovable);
  const double radius = prepare_stats(*prepared).rounding[0].radius;
  scene.camera->position = {0.5, -2, 1};
  scene.objects[0].world_from_object.translation.z += 0.5;
  prepared = prepare_moved(*prepared, scene, kMovable);
  EXPECT_EQ(prepare_stats(*prepared).rounding[0].radius, radius);
  RoundingSettings other = *scene.rounding;
  other.radius = 0.03;
  prepared = prepare_again(*prepared, other, kMovable);
  scene.objects[0].world_from_object.translation.z += 0.5;
  prepared = prepare_moved(*prepared, scene, kMovable);
  EXPECT_NEAR(prepare_stats(*prepared).rounding[0].radius, 0.03, 1e-7);
}

TEST(prepare_moved, meshes_bevels_anew) {
  Random random(6);
  Scene scene = random_scene(random);
  scene.rounding->method = RoundMethod::mesh;
  const auto before = prepare_scene(scene, kMovable);
  move_some(scene, random);
  EXPECT_EQ(picture_of(*prepare_moved(*before, scene, kMovable)),
            picture_of(*prepare_scene(scene, kMovable)));
}

TEST(prepare_moved, refuses_another_scene) {
  Random random(7);
  const Scene scene = random_scene(random);
  const auto prepared = prepare_scene(scene, kMovable);
  const auto problem = [&](const auto& change) {
    Scene moved = scene;
    change(moved);
    return error_message([&](const Scene& s) { prepare_moved(*prepared, s, kMovable); }, moved);
  };
  EXPECT_EQ(problem([](Scene&) {}), "no error");
  const char* const other = "a moved scene has other meshes";
  EXPECT_THAT(problem([](Scene& s) { s.meshes[0].positions[0].x = 2; }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.materials[0].roughness = 1; }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.objects.pop_back(); }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.objects[1].mesh.index = 1; }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.objects[0].rounding.emplace(); }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.environment = StudioEnvironment{}; }), HasSubstr(other));
  EXPECT_THAT(problem([](Scene& s) { s.objects[0].world_from_object.linear.x = {}; }),
              HasSubstr("its transform flattens it"));
  EXPECT_THAT(problem([](Scene& s) { s.objects[0].world_from_object.translation.x = 1e9; }),
              HasSubstr("reaches out to"));
  EXPECT_THAT(problem([](Scene& s) { s.camera->target = s.camera->position; }),
              HasSubstr("camera: position and target"));
}

}  // namespace
}  // namespace arris::test
