// Renders in parts: threads, sample ranges, stops and limits.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "arris/error.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

Scene make_still_life(int side_px) {
  Camera camera;
  camera.position = {3, -4, 2.5};
  Scene scene = make_empty_scene(camera);
  scene.image.width_px = side_px + 5;  // not a whole number of tiles
  scene.image.height_px = side_px;
  scene.image.filter = ImageSettings::Filter::blackman_harris;
  scene.environment = SkyEnvironment{};
  Material plastic;
  plastic.base_color = {0.7F, 0.2F, 0.1F};
  Material glass;
  glass.transmission = 1;
  glass.roughness = 0.1F;
  add_object(scene, make_square_mesh(4), make_lambert(0.5F), translation({0, 0, -0.6}));
  add_object(scene, make_box_mesh({0.5, 0.5, 0.5}), plastic);
  add_object(scene, make_sphere_mesh(3), glass, translation({1.2, -1, 0.4}));
  return scene;
}

const std::vector<std::string> kAllAovs = {"albedo", "normal",  "depth",
                                           "object", "rounded", "bevel_fac"};

RenderResult render_range(const PreparedScene& scene, SampleRange samples, int threads = 0) {
  RenderOptions options;
  options.samples = samples;
  options.threads = threads;
  options.aovs = kAllAovs;
  return make_path_renderer()->render(scene, options);
}

void expect_same_bytes(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.color.values, b.color.values);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(a.layers[i].image.values, b.layers[i].image.values) << a.layers[i].name;
  }
}

TEST(progress, any_number_of_threads_gives_the_same_bytes) {
  const auto scene = prepare_scene(make_still_life(60));
  const RenderResult one = render_range(*scene, {0, 7}, 1);
  expect_same_bytes(one.picture, render_range(*scene, {0, 7}, 2).picture);
  expect_same_bytes(one.picture, render_range(*scene, {0, 7}, 5).picture);
  EXPECT_GT(mean_of(one.picture.color), 0.01);
}

TEST(progress, parts_of_the_sequence_average_to_the_whole) {
  const auto scene = prepare_scene(make_still_life(40));
  const Image whole = render_range(*scene, {3, 19}).picture.color;
  const Image first = render_range(*scene, {3, 8}).picture.color;
  const Image second = render_range(*scene, {8, 19}).picture.color;
  for (std::size_t i = 0; i < whole.values.size(); ++i) {
    const double mean = (5.0 * double(first.values[i]) + 11.0 * double(second.values[i])) / 16.0;
    ASSERT_NEAR(mean, whole.values[i], 1e-6 * (1 + whole.values[i]));
  }
  EXPECT_NE(first.values, second.values);
}

TEST(progress, another_seed_gives_another_picture) {
  const auto scene = prepare_scene(make_still_life(20));
  RenderOptions options;
  options.samples = {0, 2};
  const Image a = make_path_renderer()->render(*scene, options).picture.color;
  options.seed = 1;
  EXPECT_NE(a.values, make_path_renderer()->render(*scene, options).picture.color.values);
}

TEST(progress, stop_ends_with_the_samples_done) {
  const auto scene = prepare_scene(make_still_life(60));
  std::atomic<bool> stop = false;
  RenderOptions options;
  options.samples = {0, 1'000'000};
  options.aovs = kAllAovs;
  options.stop = &stop;
  // Not within the first pass, however slow the machine is: that one would be given up.
  options.on_progress = [&](const Progress& progress) {
    if (progress.done >= 1e-6) stop = true;
  };
  const RenderResult stopped = make_path_renderer()->render(*scene, options);
  ASSERT_GT(stopped.samples.last, 0U);
  ASSERT_LT(stopped.samples.last, 100'000U);
  EXPECT_EQ(stopped.rays.camera, std::uint64_t{65} * 60 * stopped.samples.last);
  if (stopped.samples.last <= 2000) {
    expect_same_bytes(stopped.picture, render_range(*scene, stopped.samples).picture);
  }
}

TEST(progress, a_stop_before_the_start_renders_nothing) {
  const auto scene = prepare_scene(make_still_life(20));
  const std::atomic<bool> stop = true;
  RenderOptions options;
  options.stop = &stop;
  const RenderResult result = make_path_renderer()->render(*scene, options);
  EXPECT_EQ(result.samples.first, result.samples.last);
  EXPECT_EQ(result.picture.color.width_px, 0);
}

// Passes of a picture of this size take more than half a second.
constexpr int kSlowSide = 1000;

TEST(progress, a_stop_within_the_first_pass_drops_it) {
  const auto scene = prepare_scene(make_still_life(kSlowSide));
  std::atomic<bool> stop = false;
  RenderOptions options;
  options.aovs = kAllAovs;
  options.stop = &stop;
  options.on_progress = [&](const Progress&) { stop = true; };
  const RenderResult result = make_path_renderer()->render(*scene, options);
  EXPECT_EQ(result.samples.first, result.samples.last);
  EXPECT_EQ(result.rays.total, 0U);
  EXPECT_EQ(result.picture.color.width_px, 0);
}

TEST(progress, a_stop_within_a_long_pass_keeps_the_passes_before) {
  const auto scene = prepare_scene(make_still_life(kSlowSide));
  std::atomic<bool> stop = false;
  RenderOptions options;
  options.samples = {0, 3};
  options.aovs = kAllAovs;
  options.stop = &stop;
  options.on_progress = [&](const Progress& progress) { stop = progress.done > 0.35; };
  const RenderResult result = make_path_renderer()->render(*scene, options);
  ASSERT_EQ(result.samples.last, 1U);
  EXPECT_EQ(result.rays.camera, std::uint64_t{kSlowSide + 5} * kSlowSide);
  expect_same_bytes(result.picture, render_range(*scene, {0, 1}).picture);
}

TEST(progress, a_time_limit_within_the_first_pass_waits_for_the_least_samples) {
  const auto scene = prepare_scene(make_still_life(kSlowSide));
  RenderOptions options;
  options.time_limit_seconds = 0.05;
  EXPECT_EQ(make_path_renderer()->render(*scene, options).samples.last, 1U);
  options.least_samples = 0;
  EXPECT_EQ(make_path_renderer()->render(*scene, options).samples.last, 0U);
}

TEST(progress, time_limit_ends_soon_after) {
  const auto scene = prepare_scene(make_still_life(60));
  RenderOptions options;
  options.samples = {0, 100'000'000};
  options.time_limit_seconds = 0.3;
  const auto start = std::chrono::steady_clock::now();
  const RenderResult result = make_path_renderer()->render(*scene, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GE(seconds, 0.25);
  EXPECT_LT(seconds, 3.0);  // a loaded machine
  EXPECT_GT(result.samples.last, 1U);
}

TEST(progress, is_reported_rising_and_seldom) {
  const auto scene = prepare_scene(make_still_life(60));
  RenderOptions options;
  options.samples = {0, 100'000'000};
  options.time_limit_seconds = 0.5;
  std::vector<Progress> seen;
  options.on_progress = [&](const Progress& progress) { seen.push_back(progress); };
  const double seconds = make_path_renderer()->render(*scene, options).seconds;
  ASSERT_FALSE(seen.empty());
  EXPECT_LE(double(seen.size()), 10 * seconds + 1);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_GE(seen[i].done, i == 0 ? 0.0 : seen[i - 1].done);
    EXPECT_LE(seen[i].done, 1.0);
  }
}

TEST(progress, rejects_unknown_aovs) {
  const auto scene = prepare_scene(make_still_life(20));
  RenderOptions options;
  options.aovs = {"colour"};
  EXPECT_THROW(static_cast<void>(make_path_renderer()->render(*scene, options)), Error);
}

TEST(progress, aovs_show_the_first_hit) {
  Camera camera;
  camera.position = {0, 0.001, 6};
  camera.fov_deg = 30;
  Scene scene = make_empty_scene(camera);
  add_object(scene, make_square_mesh(100), make_lambert(0.25F));
  Object& box = add_object(scene, make_box_mesh({0.5, 0.5, 0.5}), make_lambert(0.75F));
  ASSERT_EQ(box.name, "box1");
  const auto prepared = prepare_scene(scene);
  const Picture picture = render_range(*prepared, {0, 16}).picture;
  const auto value = [&](std::size_t layer, int x, int y, int channel) {
    return picture.layers[layer].image.at(x, y, channel);
  };
  EXPECT_NEAR(value(0, 4, 4, 0), 0.75, 1e-6);
  EXPECT_NEAR(value(0, 0, 0, 0), 0.25, 1e-6);
  EXPECT_NEAR(value(1, 4, 4, 2), 1, 1e-6);
  EXPECT_NEAR(value(2, 4, 4, 0), 5.5, 0.05);
  EXPECT_EQ(value(3, 4, 4, 0), 2);
  EXPECT_EQ(value(3, 0, 0, 0), 1);
  EXPECT_EQ(value(4, 4, 4, 0), 0);
}

}  // namespace
}  // namespace arris::test
