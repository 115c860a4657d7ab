// The edge-and-point engine against the path tracer.
#include "arris/edge_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "arris/error.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// Boxes and a ball over a floor, under a point light and a dim sky.
Scene make_scene(int size_px) {
  Camera camera;
  camera.position = {3, -6, 4};
  camera.target = {0, 0, 0.6};
  camera.fov_deg = 32;
  Scene scene = make_empty_scene(camera);
  scene.image.width_px = scene.image.height_px = size_px;
  scene.image.max_depth = 3;
  scene.environment = ConstantEnvironment{Rgb(0.15F)};
  add_object(scene, make_square_mesh(6), make_lambert(0.6F));
  Material red = make_lambert(0.7F);
  red.base_color = {0.8F, 0.15F, 0.1F};
  add_object(scene, make_box_mesh({0.6, 0.6, 0.8}), red, translation({-0.9, 0.2, 0.8}));
  Material blue = make_lambert(0.5F);
  blue.base_color = {0.1F, 0.2F, 0.8F};
  add_object(scene, make_box_mesh({0.5, 0.4, 0.5}), blue, translation({0.9, -0.6, 0.5}));
  scene.lights.push_back(PointLight{{2.5, -3, 5}, Rgb(60)});
  return scene;
}

Image path_picture(const std::shared_ptr<const PreparedScene>& scene, std::uint32_t samples) {
  RenderOptions options;
  options.samples = {0, samples};
  return make_path_renderer()->render(*scene, options).picture.color;
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double d = double(a.values[i]) - double(b.values[i]);
    sum += d * d;
  }
  return std::sqrt(sum / double(a.values.size()));
}

EdgePointSettings synchronous(EdgePointShader shader = EdgePointShader::gi) {
  EdgePointSettings settings;
  settings.synchronous = true;
  settings.shader = shader;
  return settings;
}

TEST(EdgePoint, a_still_view_converges_to_the_path_traced_picture) {
  const auto scene = prepare_scene(make_scene(64));
  const Image reference = path_picture(scene, 1024);
  EdgePointSettings settings = synchronous();
  settings.density = 1;
  EdgePointEngine engine(scene, settings);
  std::vector<double> errors;
  for (const std::uint32_t paths : {32U, 128U, 512U}) {
    const Image* picture = &engine.next_frame();
    while (engine.stats().still_paths < paths) picture = &engine.next_frame();
    errors.push_back(rmse(*picture, reference));
  }
  EXPECT_LT(errors[1], 0.75 * errors[0]);
  EXPECT_LT(errors[2], 0.75 * errors[1]);
  // As good as the path tracer with as many paths.
  const double of_paths = rmse(path_picture(scene, 512), reference);
  EXPECT_LT(errors[2], 1.5 * of_paths);
}

// As viewers have it: the threads that shade points stand aside.
TEST(EdgePoint, a_still_view_is_traced_where_it_may_be) {
  const auto scene = prepare_scene(make_scene(32));
  const Image reference = path_picture(scene, 512);
  std::atomic<bool> hurry = true;
  EdgePointSettings settings;
  settings.trace_still_ms = 1e-6;
  settings.hurry = &hurry;
  EdgePointEngine engine(scene, settings);
  // Points that were asked for before may still come in.
  for (int i = 0; i < 3 || (engine.stats().new_points > 0 && i < 1000); ++i) engine.next_frame();
  EXPECT_TRUE(engine.stats().traced_still);
  EXPECT_EQ(engine.stats().new_points, 0U) << "there was no time for it";
  hurry = false;
  const Image* picture = &engine.next_frame();
  EXPECT_GT(engine.stats().new_points, 0U);
  while (engine.stats().still_paths < 256) picture = &engine.next_frame();
  EXPECT_LT(rmse(*picture, reference), 1.5 * rmse(path_picture(scene, 256), reference));
  Camera camera = *scene_of(*scene).camera;
  camera.position.x += 0.1;
  engine.set_camera(camera);
  engine.next_frame();
  EXPECT_FALSE(engine.stats().traced_still);
  EXPECT_EQ(engine.stats().still_paths, 0U);
}

// Sticks far thinner than a pixel before nothing: points on them are hidden, or make those around them so, as often as
// they are asked for.
TEST(EdgePoint, a_still_view_gives_every_pixel_paths) {
  Camera camera;
  camera.position = {3, -4, 2.5};
  camera.target = {0, 0, 0};
  camera.fov_deg = 60;
  Scene described = make_empty_scene(camera);
  described.image.width_px = described.image.height_px = 48;
  described.environment = ConstantEnvironment{Rgb(0.3F)};
  for (int i = 0; i < 10; ++i) {
    const Vec3d z = normalize(Vec3d{std::cos(2.4 * i), std::sin(2.4 * i), 0.17 * i - 0.8});
    const Vec3d x = normalize(cross(z, {0, 0, 1}));
    const Affine3d turned{Mat3d{x, cross(z, x), z}, {0.2 * i - 1, 0.3 * (i % 4) - 0.5, 0.1 * i}};
    add_object(described, make_box_mesh({0.005, 0.005, 1}), make_lambert(0.5F), turned);
  }
  EdgePointSettings settings = synchronous();
  settings.density = 1;
  EdgePointEngine engine(prepare_scene(described), settings);
  int frames = 0;
  while (engine.stats().still_paths == 0 && frames < 200) {
    engine.next_frame();
    ++frames;
  }
  EXPECT_LT(frames, 200);
}

TEST(EdgePoint, ends_within_a_frame_when_asked_to) {
  const auto scene = prepare_scene(make_scene(64));
  for (const double trace_below_ms : {0.0, 1e6}) {
    std::atomic<int> asked = 0;
    bool ends_before_picture = true;
    EdgePointSettings settings = synchronous();
    settings.density = 1;
    settings.trace_below_ms = trace_below_ms;
    settings.threads = 1;
    settings.must_end = [&](bool has_picture) {
      ++asked;
      return has_picture || ends_before_picture;
    };
    EdgePointEngine engine(scene, settings);
    EXPECT_THROW(engine.next_frame(), Error);
    EXPECT_EQ(asked, 1);  // and no more is shaded
    ends_before_picture = false;
    engine.next_frame();
    asked = 0;
    const Image before = engine.next_frame();
    const std::uint64_t paths = engine.stats().still_paths;
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(engine.stats().new_points, 0U);
    EXPECT_EQ(engine.next_frame().values, before.values);
    EXPECT_EQ(engine.stats().still_paths, paths);
  }
}

// The eye on the floor: where it looks along it no point can be projected.
TEST(EdgePoint, a_frame_of_which_no_point_is_seen_is_traced) {
  Scene described = make_scene(16);
  described.camera->position = {3, -4, 0};
  described.camera->target = {0, 0, -1};
  EdgePointEngine engine(prepare_scene(described), synchronous());
  const Image& frame = engine.next_frame();
  EXPECT_TRUE(engine.stats().traced || engine.stats().unresolved < 16 * 16);
  EXPECT_GT(*std::max_element(frame.values.begin(), frame.values.end()), 0.0F);
}

TEST(EdgePoint, frames_are_the_same_at_any_number_of_threads) {
  const auto scene = prepare_scene(make_scene(70));
  std::vector<Image> last;
  for (const int threads : {1, 2}) {
    EdgePointSettings settings = synchronous();
    settings.threads = threads;
    EdgePointEngine engine(scene, settings);
    Camera camera = *scene_of(*scene).camera;
    for (int i = 0; i < 5; ++i) {
      camera.position.x += 0.05;
      engine.set_camera(camera);
      engine.next_frame();
    }
    last.push_back(engine.next_frame());
  }
  EXPECT_EQ(last[0].values, last[1].values);
}

// From the same samples, a fifth of the pixels, the error with edges is at most half of that without (§7.3, Fig. 11).
TEST(EdgePoint, edges_halve_the_error) {
  const auto scene = prepare_scene(make_scene(160));
  const Image reference = path_picture(scene, 256);
  std::vector<double> errors;
  for (const bool edges : {true, false}) {
    EdgePointSettings settings = synchronous();
    settings.first_density = 0.2;
    settings.density = 0.01;
    settings.paths_per_point = 64;
    settings.use_edges = edges;
    EdgePointEngine engine(scene, settings);
    // Shadows are found once the first points have told of them.
    engine.next_frame();
    errors.push_back(rmse(engine.next_frame(), reference));
  }
  EXPECT_LT(errors[0], 0.5 * errors[1]) << errors[0] << " with edges, " << errors[1] << " without";
}

// The outline of a rounded box is its rounding's: the picture agrees with the path tracer's along it.
TEST(EdgePoint, rounded_outlines_are_found) {
  Scene described = make_scene(128);
  described.lights.clear();
  described.environment = ConstantEnvironment{Rgb(1)};
  described.image.max_depth = 1;
  for (std::uint32_t i = 1; i < 3; ++i) {
    RoundingSettings rounding;
    rounding.method = RoundMethod::exact;
    rounding.radius = 0.25;
    described.objects[i].rounding = rounding;
  }
  const auto scene = prepare_scene(described);
  const Image reference = path_picture(scene, 256);
  EdgePointSettings settings = synchronous(EdgePointShader::direct);
  settings.first_density = 1;
  settings.paths_per_point = 32;
  EdgePointEngine engine(scene, settings);
  const double error = rmse(engine.next_frame(), reference);
  EXPECT_GT(engine.stats().edges.silhouette, 50U);
  settings.use_edges = false;
  EdgePointEngine without(scene, settings);
  EXPECT_LT(error, 0.4 * rmse(without.next_frame(), reference)) << error;
}

TEST(EdgePoint, moved_objects_and_lights_show_where_they_are) {
  const auto scene = prepare_scene(make_scene(64), {.placement = Placement::movable});
  EdgePointSettings settings = synchronous(EdgePointShader::direct);
  settings.density = 0.3;
  settings.first_density = 1;
  settings.paths_per_point = 16;
  EdgePointEngine engine(scene, settings);
  engine.next_frame();
  const Image before = engine.next_frame();
  engine.move_object(1, translation({-0.4, -0.3, 0.8}));
  engine.set_light(0, PointLight{{-2.5, -3, 5}, Rgb(60)});
  for (int i = 0; i < 24; ++i) engine.next_frame();
  const Image after = engine.next_frame();
  RenderOptions options;
  options.samples = {0, 256};
  Scene moved = make_scene(64);
  moved.image.max_depth = 1;
  moved.objects[1].world_from_object = translation({-0.4, -0.3, 0.8});
  moved.lights[0] = PointLight{{-2.5, -3, 5}, Rgb(60)};
  const Image reference = render_path(moved, 256).picture.color;
  EXPECT_LT(rmse(after, reference), 0.15 * rmse(before, reference));
}

// Vertex normals make a mesh smooth: its facets show no edges.
// A light and an object that move in every frame: the picture is about as good as one of as many points that are all
// new, as old ones don't count beside those.
TEST(EdgePoint, what_moves_in_every_frame_does_not_lag) {
  Scene described = make_scene(96);
  described.image.max_depth = 1;
  EdgePointSettings settings = synchronous(EdgePointShader::direct);
  settings.most_density = 0.2;
  EdgePointEngine engine(prepare_scene(described, {.placement = Placement::movable}), settings);
  const Image* picture = nullptr;
  for (int i = 0; i < 8; ++i) {
    described.objects[1].world_from_object = translation({-0.4 - 0.1 * i, -0.3, 0.8});
    described.lights[0] = PointLight{{2.5 - 0.5 * i, -3, 5}, Rgb(60)};
    engine.move_object(1, described.objects[1].world_from_object);
    engine.set_light(0, described.lights[0]);
    picture = &engine.next_frame();
  }
  const auto last = prepare_scene(described);
  const Image reference = render_path(described, 256).picture.color;
  EdgePointEngine anew(last, settings);
  EXPECT_LT(rmse(*picture, reference), 1.5 * rmse(anew.next_frame(), reference));
}

// A lamp before a wall has no surface of its own: its points lie on it, not on the wall, whichever way the eye moves.
TEST(EdgePoint, the_light_of_a_lamp_moves_with_it) {
  Scene described = make_scene(64);
  described.image.max_depth = 1;
  AreaLight lamp;
  lamp.corner = {-0.5, -1.5, 2};
  lamp.edge_u = {0, 0, 1};
  lamp.edge_v = {-0.5, -0.5, 0};
  lamp.radiance = Rgb(1);
  const Vec3d eye = described.camera->position;
  if (dot(cross(lamp.edge_u, lamp.edge_v), eye - lamp.corner) < 0) {
    std::swap(lamp.edge_u, lamp.edge_v);
  }
  described.lights = {lamp};
  EdgePointEngine engine(prepare_scene(described), synchronous(EdgePointShader::direct));
  const Image* picture = nullptr;
  for (int i = 0; i < 8; ++i) {
    described.camera->position = eye + Vec3d{0.12 * i, 0, 0};
    engine.set_camera(*described.camera);
    picture = &engine.next_frame();
  }
  const auto last = prepare_scene(described);
  const Image reference = render_path(described, 256).picture.color;
  EdgePointEngine anew(last, synchronous(EdgePointShader::direct));
  EXPECT_LT(rmse(*picture, reference), 1.3 * rmse(anew.next_frame(), reference));
}

TEST(EdgePoint, smooth_meshes_show_outlines_only) {
  Scene scene = make_scene(32);
  Mesh sphere = make_sphere_mesh(3);
  sphere.normals = sphere.positions;
  add_object(scene, sphere, make_lambert(0.5F), translation({0, 2, 1}));
  EdgePointSettings settings = synchronous(EdgePointShader::direct);
  EdgePointEngine without(prepare_scene(make_scene(32)), settings);
  EdgePointEngine with(prepare_scene(scene), settings);
  without.next_frame();
  with.next_frame();
  EXPECT_EQ(with.stats().edges.sharp, without.stats().edges.sharp);
  EXPECT_GT(with.stats().edges.silhouette, without.stats().edges.silhouette + 20);
}

// A sheet that is lit from above; seen from above, and then from below.
TEST(EdgePoint, light_of_one_side_is_not_seen_from_the_other) {
  Camera camera;
  camera.position = {0.4, -3, 2};
  camera.target = {0, 0, 0};
  camera.fov_deg = 40;
  Scene described = make_empty_scene(camera);
  described.image.width_px = described.image.height_px = 64;
  add_object(described, make_square_mesh(6), make_lambert(0.8F));
  described.lights.push_back(PointLight{{0, 0, 4}, Rgb(60)});
  const auto scene = prepare_scene(described);
  EdgePointEngine engine(scene, synchronous());
  const Image& above = engine.next_frame();
  EXPECT_GT(above.values[above.offset(32, 32)], 0.3F);
  camera.position.z = -2;
  engine.set_camera(camera);
  const Image& below = engine.next_frame();
  EXPECT_EQ(*std::max_element(below.values.begin(), below.values.end()), 0);
  // What was seen from above is kept.
  for (int i = 0; i < 4; ++i) engine.next_frame();
  camera.position.z = 2;
  engine.set_camera(camera);
  EXPECT_GT(engine.next_frame().values[above.offset(32, 32)], 0.3F);
}

TEST(EdgePoint, a_light_that_is_not_there_is_an_error) {
  EdgePointEngine engine(prepare_scene(make_scene(32)), synchronous());
  engine.set_light(7, PointLight{});
  EXPECT_THROW(engine.next_frame(), Error);
  engine.next_frame();
}

// Frames go on while the shader works, the scene changes and everything ends in the middle of it.
TEST(EdgePoint, shading_goes_on_beside_frames) {
  const auto scene = prepare_scene(make_scene(48), {.placement = Placement::movable});
  EdgePointSettings settings;
  settings.density = 0.2;
  EdgePointEngine engine(scene, settings);
  Camera camera = *scene_of(*scene).camera;
  std::uint64_t points = 0;
  for (int i = 0; i < 400 && (points < 4000 || i < 40); ++i) {
    camera.position.x += 0.01;
    engine.set_camera(camera);
    engine.move_object(1, translation({-0.9 + 0.01 * i, 0.2, 0.8}));
    if (i % 5 == 0) engine.set_light(0, PointLight{{2.5 - 0.02 * i, -3, 5}, Rgb(60)});
    engine.next_frame();
    points += engine.stats().new_points;
    std::this_thread::yield();
  }
  EXPECT_GT(points, 0U);
  EXPECT_GT(engine.stats().points, 0U);
}

// Camera, an object and a light move in every frame: what shows is always a state that was set, later ones after
// earlier ones, and the last one in the end.
TEST(EdgePoint, everything_moves_in_every_frame) {
  constexpr int kFrames = 200;
  const auto scene = prepare_scene(make_scene(24), {.placement = Placement::movable});
  EdgePointSettings settings;
  settings.density = 0.3;
  EdgePointEngine engine(scene, settings);
  Camera camera = *scene_of(*scene).camera;
  const double start = scene_of(*scene).objects[1].world_from_object.translation.x;
  constexpr double kStep = 1.0 / 256;
  int shown = -1;
  for (int i = 0; i < kFrames || shown < kFrames - 1; ++i) {
    if (i < kFrames) {
      camera.position.x -= kStep;
      engine.set_camera(camera);
      engine.move_object(1, translation({start + kStep * (i + 1), 0.2, 0.8}));
      engine.set_light(0, PointLight{{2.5 - kStep * (i + 1), -3, 5}, Rgb(60)});
    }
    const Image& frame = engine.next_frame();
    const Scene& now = scene_of(*engine.scene());
    const double moved = now.objects[1].world_from_object.translation.x - start;
    const int state = int(std::lround(moved / kStep)) - 1;
    ASSERT_GE(state, shown);
    ASSERT_LE(state, i);
    ASSERT_NEAR(std::get<PointLight>(now.lights[0]).position.x, 2.5 - moved, 1e-9);
    for (const float value : frame.values) ASSERT_TRUE(value >= 0 && value < 1e3F) << value;
    shown = state;
    std::this_thread::yield();
  }
  EXPECT_GT(engine.stats().points, 0U);
}

// A change that is being prepared when the scene is replaced never shows; one that is set afterwards does.
TEST(EdgePoint, a_scene_that_is_set_replaces_changes_that_do_not_show_yet) {
  const auto scene = prepare_scene(make_scene(24), {.placement = Placement::movable});
  Scene described = scene_of(*scene);
  const Affine3d wanted = translation({-0.5, 0.4, 0.8}), later = translation({0.7, -0.8, 0.5});
  described.objects[1].world_from_object = wanted;
  const auto other = prepare_moved(*scene, described, {.placement = Placement::movable});
  for (const bool beside : {true, false}) {
    EdgePointSettings settings;
    settings.synchronous = !beside;
    EdgePointEngine engine(scene, settings);
    engine.next_frame();
    engine.move_object(1, translation({9, 9, 9}));
    if (beside)
      engine.next_frame();  // it is being prepared from here on, or shows in the frame after
    engine.move_object(0, translation({0, 0, -9}));
    engine.set_light(7, PointLight{});  // an error that nobody wants to hear of any more
    engine.set_scene(other);
    engine.move_object(2, later);
    for (;;) {
      engine.next_frame();
      const std::vector<Object>& objects = scene_of(*engine.scene()).objects;
      EXPECT_EQ(objects[0].world_from_object, described.objects[0].world_from_object);
      EXPECT_EQ(objects[1].world_from_object, wanted);
      if (objects[2].world_from_object == later) break;
      std::this_thread::yield();
    }
  }
}

// A floor of black and white texels, each about four pixels wide, beneath the boxes, and a box that is painted too.
Scene make_checkered_scene(int size_px) {
  Scene scene = make_scene(size_px);
  Texture checker;
  checker.width_px = checker.height_px = 96;
  for (int i = 0; i < 96 * 96; ++i) {
    const bool white = (i % 96 + i / 96) % 2 == 0;
    checker.texels.push_back(white ? std::array<std::uint8_t, 4>{255, 230, 200, 255}
                                   : std::array<std::uint8_t, 4>{0, 10, 40, 255});
  }
  scene.textures.push_back(std::move(checker));
  Material floor = scene.materials[0];
  floor.base_color = Rgb(0.8F);
  floor.base_color_texture = TextureId{0};
  scene.materials[0] = floor;
  return scene;
}

struct TextureErrors {
  double sharp = 0, blurred = 0;
};

TextureErrors texture_errors(const Scene& described) {
  const auto scene = prepare_scene(described);
  const Image reference = path_picture(scene, 128);
  TextureErrors errors;
  for (const bool sharp : {true, false}) {
    EdgePointSettings settings = synchronous();
    settings.paths_per_point = 32;
    settings.sharp_textures = sharp;
    EdgePointEngine engine(scene, settings);
    Camera camera = *scene_of(*scene).camera;
    const Vec3d end = camera.position;
    for (int i = 4; i >= 0; --i) {
      camera.position = end + Vec3d{0.03 * i, 0, 0};
      engine.set_camera(camera);
      engine.next_frame();
    }
    (sharp ? errors.sharp : errors.blurred) = rmse(engine.next_frame(), reference);
  }
  return errors;
}

// Texels stay sharp between points that are five times as far apart.
TEST(EdgePoint, textures_are_as_sharp_as_pixels) {
  const TextureErrors errors = texture_errors(make_checkered_scene(96));
  EXPECT_LT(errors.sharp, 0.35 * errors.blurred) << errors.sharp << " and " << errors.blurred;
}

TEST(EdgePoint, textures_of_glossy_surfaces_are_sharp_beneath_their_reflections) {
  Scene scene = make_checkered_scene(96);
  scene.materials[0].glossy_mix.reset();
  scene.materials[0].roughness = 0.4F;
  const TextureErrors errors = texture_errors(scene);
  EXPECT_LT(errors.sharp, 0.4 * errors.blurred) << errors.sharp << " and " << errors.blurred;
}

// Light that comes from one direction: what a surface reflects beneath its glints goes with the texture alone, however
// much it would reflect of light from all sides.
TEST(EdgePoint, dark_textures_of_glossy_surfaces_stay_dark) {
  Scene described = make_checkered_scene(64);
  described.materials[0].glossy_mix.reset();
  described.materials[0].roughness = 0.1F;
  for (std::array<std::uint8_t, 4>& texel : described.textures[0].texels) texel = {20, 20, 20, 255};
  described.lights = {DirectionalLight{{0.3, 0.8, -1}, Rgb(1)}};
  described.environment = ConstantEnvironment{};
  described.image.max_depth = 1;
  const auto scene = prepare_scene(described);
  const Image reference = path_picture(scene, 64);
  EdgePointSettings settings = synchronous(EdgePointShader::direct);
  settings.first_density = 1;
  EdgePointEngine engine(scene, settings);
  const Image& picture = engine.next_frame();
  double mean = 0, wanted = 0;
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    mean += double(picture.values[i]);
    wanted += double(reference.values[i]);
  }
  EXPECT_NEAR(mean, wanted, 0.05 * wanted);
}

TEST(EdgePoint, without_textures_points_keep_their_colours) {
  const auto scene = prepare_scene(make_scene(48));
  std::vector<Image> pictures;
  for (const bool sharp : {true, false}) {
    EdgePointSettings settings = synchronous();
    settings.sharp_textures = sharp;
    EdgePointEngine engine(scene, settings);
    engine.next_frame();
    pictures.push_back(engine.next_frame());
  }
  EXPECT_EQ(pictures[0].values, pictures[1].values);
}

TEST(EdgePoint, a_still_view_of_a_texture_converges_to_the_path_traced_picture) {
  const auto scene = prepare_scene(make_checkered_scene(24));
  EdgePointSettings settings = synchronous();
  settings.density = 1;
  EdgePointEngine engine(scene, settings);
  const Image* picture = &engine.next_frame();
  while (engine.stats().still_paths < 256) picture = &engine.next_frame();
  const Image reference = path_picture(scene, 1024);
  EXPECT_LT(rmse(*picture, reference), 1.5 * rmse(path_picture(scene, 256), reference));
}

// Whatever the unit of light is: scenes that an exposure makes the same.
TEST(EdgePoint, lights_of_any_power_make_the_same_picture_by_their_exposure) {
  const auto pictures_at = [](int stops) {
    const float power = std::ldexp(1.0F, stops);
    Scene described = make_checkered_scene(48);
    described.image.exposure = -stops;
    described.environment = ConstantEnvironment{Rgb(0.15F * power)};
    described.lights[0] = PointLight{{2.5, -3, 5}, Rgb(60 * power)};
    EdgePointEngine engine(prepare_scene(described), synchronous());
    Camera camera = *described.camera;
    std::vector<float> values;
    for (int i = 0; i < 4; ++i) {
      if (i < 3) camera.position.x += 0.05;
      engine.set_camera(camera);
      for (const float v : engine.next_frame().values) values.push_back(v / power);
    }
    return values;
  };
  const std::vector<float> expected = pictures_at(0);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.3F);
  for (const int stops : {-40, -17, 17, 40}) EXPECT_EQ(pictures_at(stops), expected) << stops;
}

TEST(EdgePoint, cheap_frames_are_traced) {
  const auto scene = prepare_scene(make_scene(40));
  EdgePointSettings settings = synchronous();
  settings.trace_below_ms = 1e6;
  settings.paths_per_point = 8;
  EdgePointEngine engine(scene, settings);
  Camera camera = *scene_of(*scene).camera;
  const Vec3d end = camera.position;
  for (int i = 1; i >= 0; --i) {
    camera.position = end + Vec3d{0.03 * i, 0, 0};
    engine.set_camera(camera);
    const Image& frame = engine.next_frame();
    EXPECT_TRUE(engine.stats().traced);
    if (i == 0) {
      EXPECT_LT(rmse(frame, path_picture(scene, 8)), 1e-6);
    }
  }
  // Paths add up while the view stands still.
  EXPECT_LT(rmse(engine.next_frame(), path_picture(scene, 16)), 1e-6);
}

TEST(EdgePoint, dear_frames_are_not_traced) {
  const auto scene = prepare_scene(make_scene(40));
  std::vector<Image> pictures;
  for (const double below_ms : {0.0, 1.0}) {
    EdgePointSettings settings = synchronous();
    settings.trace_below_ms = below_ms;
    EdgePointEngine engine(scene, settings);
    engine.next_frame();
    pictures.push_back(engine.next_frame());
    EXPECT_FALSE(engine.stats().traced);
  }
  EXPECT_EQ(pictures[0].values, pictures[1].values);
}

TEST(EdgePoint, what_shading_costs_decides_beside_frames_too) {
  EdgePointSettings settings;
  settings.trace_below_ms = 1e9;
  EdgePointEngine engine(prepare_scene(make_scene(24)), settings);
  while (!engine.stats().traced) {
    engine.next_frame();
    std::this_thread::yield();
  }
  EXPECT_EQ(engine.stats().edges.silhouette, 0U);
}

TEST(EdgePoint, bad_settings_and_cameras_are_errors) {
  const auto scene = prepare_scene(make_scene(24));
  EdgePointSettings settings = synchronous();
  settings.density = 0;
  EXPECT_THROW(EdgePointEngine(scene, settings), Error);
  EdgePointEngine engine(scene, synchronous());
  Camera camera = *scene_of(*scene).camera;
  camera.target = camera.position;
  engine.set_camera(camera);
  EXPECT_THROW(engine.next_frame(), Error);
}

}  // namespace
}  // namespace arris::test
