#include "shading/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shading/lights.h"
#include "support/chi_squared.h"

namespace arris::test {
namespace {

LightSet environment_only(const Environment& environment) {
  return make_light_set({}, environment, {}, {});
}

// A map with one bright texel per direction to look along.
HdrEnvironment marked_map(int column, int row) {
  HdrEnvironment map;
  map.width_px = 16;
  map.height_px = 8;
  map.radiance.edit().assign(16 * 8, Rgb(0.0F));
  map.radiance[std::size_t(row * 16 + column)] = Rgb(1.0F);
  return map;
}

// The texel's centre lies half a texel (π/16) from the axis that is meant.
Vec3f centre_of(int column, int row) {
  const double azimuth = kPi - 2 * kPi * (column + 0.5) / 16;
  const double theta = kPi * (row + 0.5) / 8;
  return {float(std::sin(theta) * std::cos(azimuth)), float(std::sin(theta) * std::sin(azimuth)),
          float(std::cos(theta))};
}

TEST(Environment, map_has_its_middle_along_x_and_runs_clockwise) {
  // Column 8 starts in the middle; its centre is just to the right, towards -y.
  const Vec3f middle = centre_of(8, 3);
  EXPECT_GT(middle.x, 0.9F);
  EXPECT_LT(middle.y, 0.0F);
  for (const auto& [column, row] : {std::pair(8, 3), {12, 3}, {0, 5}, {3, 1}}) {
    const LightSet lights = environment_only(marked_map(column, row));
    EXPECT_NEAR(eval_environment(lights, centre_of(column, row)).x, 1.0F, 1e-4F);
    EXPECT_NEAR(eval_environment(lights, -centre_of(column, row)).x, 0.0F, 1e-4F);
  }
}

TEST(Environment, map_turns_about_up) {
  HdrEnvironment map = marked_map(8, 3);
  map.rotation = kPi / 2;
  const Vec3f c = centre_of(8, 3);
  EXPECT_NEAR(eval_environment(environment_only(map), {-c.y, c.x, c.z}).x, 1.0F, 1e-4F);
  map.rotation = 0;
  map.up = {0, 1, 0};  // glTF: z goes to y, y to -z
  EXPECT_NEAR(eval_environment(environment_only(map), {c.x, c.z, -c.y}).x, 1.0F, 1e-4F);
  map.up = {0, 0, -1};
  EXPECT_NEAR(eval_environment(environment_only(map), {c.x, -c.y, -c.z}).x, 1.0F, 1e-4F);
}

TEST(Environment, density_is_positive_wherever_there_is_light) {
  const LightSet lights = environment_only(marked_map(0, 4));
  std::mt19937 random(2);
  int lit = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec2f u = uniform_2d(random);
    const Vec3f wi = sphere_direction(2.0 * double(u.x) - 1.0, 2.0 * kPi * double(u.y));
    const EnvironmentValue value = eval_environment_with_pdf(lights, wi);
    if (value.radiance.x > 0.0F) {
      ++lit;
      ASSERT_GT(value.pdf, 0.0F);
    }
  }
  EXPECT_GT(lit, 50);
}

TEST(Environment, black_map_is_no_emitter) {
  HdrEnvironment map = marked_map(0, 0);
  map.strength = 0;
  const LightSet lights = environment_only(map);
  EXPECT_FALSE(has_emitters(lights));
  EXPECT_EQ(pdf_environment(lights, {0, 0, 1}), 0.0F);
}

TEST(Environment, sun_samples_fill_its_disc_uniformly) {
  const LightSet lights = environment_only(SkyEnvironment{});
  ASSERT_EQ(lights.environment->suns.size(), 1U);
  const SunDisc& sun = lights.environment->suns.front();
  std::mt19937 random(4);
  constexpr int kSamples = 20000;
  constexpr int kRings = 10;
  std::vector<double> observed(kRings);
  Vec3f mean;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3f wi = sample_sun(sun, uniform_2d(random));
    ASSERT_NEAR(length(wi), 1.0F, 1e-6F);
    mean += (wi - sun.direction) * (1.0F / kSamples);
    // Equal areas: in the squared sine. Directions resolve 6e-8 of a radius of 5e-3.
    const Vec3f across = wi - sun.direction * dot(wi, sun.direction);
    const double squared =
        double(length_squared(across)) / (1.0 - std::pow(double(sun.cos_radius), 2));
    ++observed[std::size_t(std::min(int(squared * kRings), kRings - 1))];
  }
  EXPECT_GT(compare_counts(std::vector<double>(kRings, double(kSamples) / kRings), observed), 1e-3);
  EXPECT_LT(length(mean), 1e-4F);
}

TEST(Environment, sun_is_seen_as_bright_as_it_shines) {
  const SkyEnvironment sky{.sun_direction = {0, 0, 2}};
  const LightSet lights = environment_only(sky);
  const SunDisc& sun = lights.environment->suns.front();
  const float in_sun = eval_environment(lights, {0, 0, 1}).x;
  const float beside = eval_environment(lights, sphere_direction(std::cos(radians(0.4)), 1)).x;
  EXPECT_NEAR(in_sun - beside, sun.radiance.x, 0.01F * sun.radiance.x);
  EXPECT_GT(pdf_environment(lights, {0, 0, 1}), 1000.0F);
  EXPECT_TRUE(environment_only(SkyEnvironment{.sun = false}).environment->suns.empty());
}

TEST(Environment, sky_is_blue_above_and_grey_below) {
  const LightSet lights = environment_only(SkyEnvironment{});
  const Rgb north = eval_environment(lights, normalize(Vec3f{-0.4F, 0.5F, 0.7F}));
  EXPECT_GT(north.z, 1.3F * north.x);
  const Rgb ground = eval_environment(lights, normalize(Vec3f{0.3F, 0.2F, -0.7F}));
  EXPECT_GT(ground.x, 0.05F);
  EXPECT_LT(ground.x, 0.6F);
}

TEST(Environment, sky_survives_any_sun_and_turbidity) {
  for (const double elevation : {-1.5, -0.1, 0.0, 0.001, 0.2, 1.5707}) {
    for (const double turbidity : {1.0, 2.0, 6.0, 30.0}) {
      const LightSet lights = environment_only(SkyEnvironment{
          .sun_direction = {std::cos(elevation), 0, std::sin(elevation)}, .turbidity = turbidity});
      for (const Rgb& c : lights.environment->map.radiance) {
        ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) << elevation;
      }
      EXPECT_EQ(lights.environment->suns.empty(), elevation <= 0) << elevation;
    }
  }
}

// What pictures rely on: white surfaces come out near 1 without exposure.
TEST(Environment, built_in_ones_light_a_white_floor_to_about_one) {
  for (const Environment& e : {Environment(StudioEnvironment{}), Environment(SkyEnvironment{})}) {
    const LightSet lights = environment_only(e);
    std::mt19937 random(6);
    double sum = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const float u_select = uniform(random);
      const auto s = sample_light(lights, {}, u_select, uniform_2d(random));
      if (s && s->wi.z > 0) {
        sum += double(s->radiance.y * s->wi.z / s->pdf);
      }
    }
    EXPECT_NEAR(sum / kSamples / kPi, 1.0, 0.3);
  }
}

TEST(Environment, studio_backdrop_hides_the_lamps) {
  const LightSet lights = environment_only(StudioEnvironment{});
  float brightest = 0;
  float brightest_backdrop = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f wi = sphere_direction(1.0 - 2.0 * (i + 0.5) / 2000, 2.39996 * i);
    brightest = std::max(brightest, eval_environment(lights, wi).x);
    brightest_backdrop = std::max(brightest_backdrop, eval_backdrop(lights, wi).x);
  }
  EXPECT_GT(brightest, 2.0F);
  EXPECT_LT(brightest_backdrop, 1.0F);
}

}  // namespace
}  // namespace arris::test
