#include "render/edge_denoiser.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

#include "arris/render.h"
#include "render/film.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// A box on a checkered floor, in the light of a lamp of some size and of the sky.
Scene make_lit_scene() {
  Camera camera;
  camera.position = {3, -6, 4};
  camera.target = {0, 0, 0.5};
  camera.fov_deg = 32;
  Scene scene = make_empty_scene(camera);
  scene.image.width_px = scene.image.height_px = 64;
  scene.image.max_depth = 3;
  scene.environment = ConstantEnvironment{Rgb(0.3F)};
  add_object(scene, make_square_mesh(6), make_lambert(0.8F));
  Texture checker;
  checker.width_px = checker.height_px = 24;
  for (int i = 0; i < 24 * 24; ++i) {
    const bool white = (i % 24 + i / 24) % 2 == 0;
    checker.texels.push_back(white ? std::array<std::uint8_t, 4>{255, 255, 255, 255}
                                   : std::array<std::uint8_t, 4>{20, 30, 80, 255});
  }
  scene.textures.push_back(std::move(checker));
  Material floor = scene.materials[0];
  floor.base_color_texture = TextureId{0};
  scene.materials[0] = floor;
  add_object(scene, make_box_mesh({0.6, 0.6, 0.8}), make_lambert(0.6F), translation({0, 0, 0.8}));
  AreaLight lamp;
  lamp.corner = {2, -3, 5};
  lamp.edge_u = {0, 1, 0};
  lamp.edge_v = {1, 0, 0};
  lamp.radiance = Rgb(15);
  scene.lights.push_back(lamp);
  return scene;
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double d = double(a.values[i]) - double(b.values[i]);
    sum += d * d;
  }
  return std::sqrt(sum / double(a.values.size()));
}

Image render_plain(const Scene& scene, std::uint32_t samples, std::uint32_t seed) {
  RenderOptions options;
  options.seed = seed;
  return render_path(scene, samples, options).picture.color;
}

Image render_denoised(Scene scene, std::uint32_t samples, int threads = 0) {
  const ImageSettings::Filter filter = scene.image.filter;
  scene.image.filter = ImageSettings::Filter::box;
  const auto prepared = prepare_scene(std::move(scene));
  RenderOptions options;
  options.samples = {0, samples};
  options.aovs = {kSquaresLayer};
  const Picture noisy = make_path_renderer()->render(*prepared, options).picture;
  return denoise_within_edges(*prepared, noisy.color, noisy.layers.at(0).image,
                              {samples, filter, 0, threads});
}

TEST(EdgeDenoiser, takes_most_of_the_noise_and_leaves_textures) {
  Scene scene = make_lit_scene();
  scene.image.filter = ImageSettings::Filter::blackman_harris;
  const Image reference = render_plain(scene, 256, 1);
  const double noisy = rmse(render_plain(scene, 8, 0), reference);
  const double denoised = rmse(render_denoised(scene, 8), reference);
  EXPECT_LT(denoised, 0.4 * noisy) << denoised << " and " << noisy;
}

TEST(EdgeDenoiser, tends_to_the_path_traced_picture) {
  Scene scene = make_lit_scene();
  scene.image.width_px = scene.image.height_px = 40;
  const Image reference = render_plain(scene, 1024, 1);
  const double few = rmse(render_denoised(scene, 8), reference);
  const double many = rmse(render_denoised(scene, 256), reference);
  EXPECT_LT(many, 0.4 * few) << many << " and " << few;
}

TEST(EdgeDenoiser, is_the_same_at_any_number_of_threads) {
  Scene scene = make_lit_scene();
  scene.image.width_px = 70;
  EXPECT_EQ(render_denoised(scene, 4, 1).values, render_denoised(scene, 4, 2).values);
}

// Lit 2^k times as brightly and exposed by as much less, the picture is the same.
TEST(EdgeDenoiser, does_as_well_however_bright_the_scene_is) {
  Scene scene = make_lit_scene();
  scene.image.width_px = scene.image.height_px = 40;
  const Image plain = render_denoised(scene, 8);
  for (const int stops : {-26, 20}) {
    Scene other = scene;
    const auto factor = float(std::exp2(stops));
    other.image.exposure = -stops;
    other.environment = ConstantEnvironment{Rgb(0.3F * factor)};
    std::get<AreaLight>(other.lights[0]).radiance *= factor;
    Image picture = render_denoised(other, 8);
    for (float& value : picture.values) value /= factor;
    EXPECT_LT(rmse(picture, plain), 1e-3) << stops;
  }
}

// A black box and floor under a white sky: all that there is are outlines.
TEST(EdgeDenoiser, leaves_outlines_where_they_are) {
  Scene scene = make_lit_scene();
  scene.lights.clear();
  scene.environment = ConstantEnvironment{Rgb(1)};
  scene.image.max_depth = 0;
  const Image plain = render_plain(scene, 16, 0);
  EXPECT_LT(rmse(render_denoised(scene, 16), plain), 0.02);
}

// A rounded box stands on a floor: between its outline and its shadow's the floor shows in less than a pixel.
TEST(EdgeDenoiser, gaps_of_less_than_a_pixel_are_averaged_along_them) {
  Camera camera;
  camera.position = {0, -6, 3};
  camera.target = {0, -0.5, 0};
  camera.fov_deg = 24;
  Scene scene = make_empty_scene(camera);
  scene.image.width_px = scene.image.height_px = 64;
  scene.image.max_depth = 3;
  scene.environment = ConstantEnvironment{Rgb(0.3F)};
  add_object(scene, make_square_mesh(6), make_lambert(0.8F));
  Object& box = add_object(scene, make_box_mesh({0.7, 0.5, 0.5}), make_lambert(0.6F),
                           translation({0, 0, 0.5}));
  box.rounding.emplace();
  box.rounding->method = RoundMethod::exact;
  box.rounding->radius = 0.22;
  scene.lights.emplace_back(PointLight{{-1, -3, 4}, Rgb(30)});
  const auto contact = [](const Image& picture) {
    Image rows(20, 2, 3);
    for (int y = 0; y < rows.height_px; ++y) {
      for (int x = 0; x < rows.width_px; ++x) {
        for (int c = 0; c < 3; ++c) rows.at(x, y, c) = picture.at(22 + x, 30 + y, c);
      }
    }
    return rows;
  };
  const Image reference = contact(render_plain(scene, 256, 1));
  const double noisy = rmse(contact(render_plain(scene, 4, 0)), reference);
  const double denoised = rmse(contact(render_denoised(scene, 4)), reference);
  EXPECT_LT(denoised, 0.75 * noisy) << denoised << " and " << noisy;
}

}  // namespace
}  // namespace arris::test
