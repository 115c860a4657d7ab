// Every light of the table: its sampler draws what the pdf says; and radiance against closed forms.
#include "shading/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "base/sobol.h"
#include "support/chi_squared.h"

namespace arris::test {
namespace {

struct LightCase {
  std::string name;
  std::vector<Light> lights;
  Environment environment = ConstantEnvironment{};
  std::vector<EmissiveTriangle> triangles;
};

// The name is GoogleTest's.
void PrintTo(const LightCase& c, std::ostream* out) {  // NOLINT(readability-identifier-naming)
  *out << c.name;
}

AreaLight area_light(Vec3d corner, Vec3d edge_u, Vec3d edge_v) {
  return {corner, edge_u, edge_v, {1, 2, 3}, true};
}

// Bright spots, gradients, a black half, and one single lit texel in the dark.
HdrEnvironment spotted_map() {
  HdrEnvironment map;
  map.width_px = 24;
  map.height_px = 12;
  map.radiance.edit().assign(24 * 12, Rgb(0.0F));
  for (std::size_t i = 0; i < 24 * 6; ++i) {
    map.radiance[i] = Rgb(0.1F + float(i % 24) / 24.0F);
  }
  map.radiance[24 * 3 + 5] = {20, 30, 10};
  map.radiance[24 * 9 + 20] = {5, 5, 5};
  return map;
}

HdrEnvironment turned(HdrEnvironment map) {
  map.up = {0.3, -1, 0.2};
  map.rotation = 0.7;
  map.strength = 2;
  return map;
}

// All are seen from kPoint. Delta lights are tested below, in closed form.
constexpr Vec3f kPoint{0.1F, -0.2F, 0.3F};

std::vector<LightCase> light_cases() {
  const AreaLight near = area_light({-1, -1, 1}, {0, 3, 0}, {2, 0, 0});
  const AreaLight grazing = area_light({1, -4, 0.2}, {0, 0, 1}, {0, 8, 0});
  const AreaLight far = area_light({3, 3, 4}, {0, -1.5, 0}, {-1.5, 0, 1});
  const AreaLight skew = area_light({2, -1, 1}, {-1.2, -0.4, 2}, {-1, 2, 0.5});
  const EmissiveTriangle front{{2, -1, 0}, {2, -1, 2}, {2, 2, 0}, {1, 1, 1}, false};
  const EmissiveTriangle back{{2, -1, 0}, {2, 2, 0}, {2, -1, 2}, {1, 1, 1}, true};
  return {
      {"near_rectangle", {near}, {}, {}},
      {"grazing_rectangle", {grazing}, {}, {}},
      {"far_rectangle", {far}, {}, {}},
      {"skew_rectangle", {skew}, {}, {}},
      {"two_rectangles", {near, far}, {}, {}},
      {"triangle", {}, {}, {front}},
      {"triangle_from_behind", {}, {}, {back}},
      {"triangle_and_rectangle", {near}, {}, {front}},
      {"studio", {}, StudioEnvironment{}, {}},
      {"sky_without_sun", {}, SkyEnvironment{.sun = false}, {}},
      {"spotted_map", {}, spotted_map(), {}},
      {"turned_map", {}, turned(spotted_map()), {}},
      {"map_and_rectangle", {far}, spotted_map(), {}},
  };
}

LightSet make_lights(const LightCase& c) {
  return make_light_set(c.lights, c.environment, c.triangles, {{0, 0, 0}, 2});
}

// Möller and Trumbore; the triangle's distance from kPoint, from either side.
std::optional<float> intersect_triangle(const TriangleEmitter& light, Vec3f wi) {
  const Vec3f p = cross(wi, light.edge_c);
  const float inverse = 1.0F / dot(light.edge_b, p);
  const Vec3f s = kPoint - light.a;
  const float b = dot(s, p) * inverse;
  const Vec3f q = cross(s, light.edge_b);
  const float c = dot(wi, q) * inverse;
  const float t = dot(light.edge_c, q) * inverse;
  return b >= 0 && c >= 0 && b + c <= 1 && t > 0 ? std::optional(t) : std::nullopt;
}

double mean(Rgb c) {
  return double(c.x + c.y + c.z) / 3.0;
}

// What a ray meets, summed over all emitters as if none hid another.
struct Along {
  double pdf = 0;  // with which sample_light() draws it
  double radiance = 0;
};
Along look_along(const LightSet& lights, Vec3f wi) {
  const EnvironmentValue far = eval_environment_with_pdf(lights, wi);
  Along along{double(far.pdf), mean(far.radiance)};
  for (std::uint32_t i = 0; i < lights.rectangles.size(); ++i) {
    if (const auto t = intersect_rectangle(lights.rectangles[i], kPoint, wi, 1e30F)) {
      along.pdf += double(pdf_area_light(lights, i, kPoint, wi, *t));
      along.radiance += mean(lights.rectangles[i].radiance);
    }
  }
  for (std::uint32_t i = 0; i < lights.triangles.size(); ++i) {
    const TriangleEmitter& light = lights.triangles[i];
    const auto t = intersect_triangle(light, wi);
    if (t && (light.both_sides || dot(wi, light.normal) < 0)) {
      along.pdf += double(pdf_emissive_triangle(lights, i, wi, *t));
      along.radiance += mean(light.radiance);
    }
  }
  return along;
}

class EveryLight : public testing::TestWithParam<LightCase> {};

INSTANTIATE_TEST_SUITE_P(Lights, EveryLight, testing::ValuesIn(light_cases()),
                         [](const auto& light) { return light.param.name; });

TEST_P(EveryLight, samples_follow_their_pdf) {
  const LightSet lights = make_lights(GetParam());
  ChiSquaredSettings settings;
  settings.tests = int(light_cases().size());
  const auto draw = [&](std::mt19937& random) -> std::optional<Vec3f> {
    const float u_select = uniform(random);
    const auto sample = sample_light(lights, kPoint, u_select, uniform_2d(random));
    return sample ? std::optional(sample->wi) : std::nullopt;
  };
  const auto result = chi_squared_test(
      draw, [&](Vec3f wi) { return look_along(lights, wi).pdf; }, settings);
  EXPECT_TRUE(result.passed) << "p " << result.p_value << ", ∫pdf " << result.pdf_integral;
  EXPECT_NEAR(result.pdf_integral, 1.0, 5e-3);
}

TEST_P(EveryLight, samples_agree_with_eval_and_pdf) {
  const LightSet lights = make_lights(GetParam());
  std::mt19937 random(5);
  int drawn = 0;
  for (int i = 0; i < 3000; ++i) {
    const float u_select = uniform(random);
    const auto sample = sample_light(lights, kPoint, u_select, uniform_2d(random));
    if (!sample) {
      continue;
    }
    ++drawn;
    ASSERT_NEAR(length(sample->wi), 1.0F, 1e-5F);
    ASSERT_FALSE(sample->is_delta);
    switch (sample->kind) {
      case EmitterKind::rectangle: {
        const RectangleEmitter& light = lights.rectangles[sample->index];
        const float distance = sample->distance;
        ASSERT_NEAR(pdf_area_light(lights, sample->index, kPoint, sample->wi, distance),
                    sample->pdf, 2e-4F * sample->pdf);
        ASSERT_EQ(sample->radiance, light.radiance);
        const Vec3f p = kPoint + sample->wi * distance - light.corner;
        ASSERT_NEAR(dot(p, light.normal), 0.0F, 1e-4F);
        break;
      }
      case EmitterKind::triangle: {
        const TriangleEmitter& light = lights.triangles[sample->index];
        const Vec3f p =
            light.a + light.edge_b * sample->barycentric.x + light.edge_c * sample->barycentric.y;
        ASSERT_LT(length(kPoint + sample->wi * sample->distance - p), 1e-4F);
        ASSERT_FLOAT_EQ(pdf_emissive_triangle(lights, sample->index, sample->wi, sample->distance),
                        sample->pdf);
        break;
      }
      default: {
        // The direction goes through the map's coordinates and back: cells differ at their edges only.
        const EnvironmentValue value = eval_environment_with_pdf(lights, sample->wi);
        ASSERT_NEAR(value.radiance.x, sample->radiance.x, 2e-3F * (1.0F + sample->radiance.x));
        ASSERT_TRUE(std::isinf(sample->distance));
        break;
      }
    }
  }
  EXPECT_GT(drawn, 2900);
}

// Irradiance at kPoint by light samples, mean of RGB.
double sampled_irradiance(const LightSet& lights, Vec3f normal, std::uint32_t samples) {
  double sum = 0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    Sampler sampler(3, 1, 4, i);
    const float u_select = sampler.next_1d();
    const auto s = sample_light(lights, kPoint, u_select, sampler.next_2d());
    if (s) {
      sum += mean(s->radiance) * std::fmax(0.0, double(dot(s->wi, normal))) / double(s->pdf);
    }
  }
  return sum / samples;
}

// The same by looking everywhere: what BSDF samples would find.
double seen_irradiance(const LightSet& lights, Vec3f normal) {
  return integrate_sphere(
      [&](Vec3f wi) {
        const double cosine = double(dot(wi, normal));
        return cosine > 0 ? look_along(lights, wi).radiance * cosine : 0.0;
      },
      2e-5);
}

TEST_P(EveryLight, sampled_irradiance_is_what_is_seen) {
  const LightSet lights = make_lights(GetParam());
  for (const Vec3f normal : {Vec3f{0, 0, 1}, normalize(Vec3f{1, -2, 0.5F})}) {
    const double seen = seen_irradiance(lights, normal);
    EXPECT_NEAR(sampled_irradiance(lights, normal, 1U << 17U), seen, 0.01 * seen + 1e-4);
  }
}

// Form factor of a rectangle a × b, parallel to the receiver at height 1 above its corner.
double corner_form_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a);
  const double rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * kPi);
}

TEST(Lights, rectangle_irradiance_matches_the_form_factor) {
  const Vec3d p(kPoint);
  for (const double height : {0.2, 1.0, 3.0, 20.0}) {
    const AreaLight light = area_light(p + Vec3d{0, 0, height}, {0, 2, 0}, {1.5, 0, 0});
    const LightSet lights =
        make_light_set(std::vector<Light>{light}, ConstantEnvironment{}, {}, {});
    const double expected = kPi * 2.0 * corner_form_factor(1.5 / height, 2 / height);
    EXPECT_NEAR(sampled_irradiance(lights, {0, 0, 1}, 1U << 14U), expected, 2e-3 * expected);
  }
}

// By power alone a directional light over a wide floor would leave a lamp without samples.
TEST(Lights, far_and_near_lights_are_drawn_equally_often_in_a_scene_of_any_size) {
  const std::vector<Light> lights = {PointLight{{0, 0, 1}, {1, 1, 1}},
                                     PointLight{{0, 0, 2}, {3, 3, 3}},
                                     DirectionalLight{{0, 0, -1}, {1, 1, 1}}};
  for (const float radius : {0.01F, 1.0F, 1e4F}) {
    const LightSet set = make_light_set(lights, ConstantEnvironment{}, {}, {{0, 0, 0}, radius});
    ASSERT_EQ(set.emitters.size(), 3U);
    EXPECT_NEAR(set.selection.probability[0], 0.125F, 1e-6F) << radius;
    EXPECT_NEAR(set.selection.probability[1], 0.375F, 1e-6F) << radius;
    EXPECT_NEAR(set.selection.probability[2], 0.5F, 1e-6F) << radius;
  }
}

TEST(Lights, two_triangles_are_a_rectangle) {
  const Vec3f a{-1, -1, 2};
  const Vec3f b{-1, 2, 2};
  const Vec3f c{1, 2, 2};
  const Vec3f d{1, -1, 2};
  const std::vector<EmissiveTriangle> triangles = {{a, b, c, {1, 2, 3}}, {a, c, d, {1, 2, 3}}};
  const LightSet split = make_light_set({}, ConstantEnvironment{}, triangles, {});
  const LightSet whole =
      make_light_set(std::vector<Light>{area_light(Vec3d(a), {0, 3, 0}, {2, 0, 0})},
                     ConstantEnvironment{}, {}, {});
  const double expected = sampled_irradiance(whole, {0, 0, 1}, 1U << 14U);
  EXPECT_NEAR(sampled_irradiance(split, {0, 0, 1}, 1U << 14U), expected, 5e-3 * expected);
}

TEST(Lights, point_light_falls_with_the_square) {
  const Vec3d p(kPoint);
  const LightSet lights =
      make_light_set(std::vector<Light>{PointLight{p + Vec3d{0, 3, 4}, {10, 10, 10}}},
                     ConstantEnvironment{}, {}, {});
  const auto sample = sample_light(lights, kPoint, 0.3F, {0.2F, 0.9F});
  ASSERT_TRUE(sample && sample->is_delta);
  EXPECT_NEAR(sample->radiance.x, 10.0F / 25.0F, 1e-6F);
  EXPECT_NEAR(sample->distance, 5.0F, 1e-5F);
  EXPECT_NEAR(sample->wi.z, 0.8F, 1e-6F);
  EXPECT_EQ(sample->pdf, 1.0F);
}

TEST(Lights, spot_light_fades_between_its_angles) {
  const auto irradiance_at = [](double angle) {
    SpotLight spot;
    spot.position = Vec3d(kPoint) + Vec3d{2 * std::sin(angle), 0, 2 * std::cos(angle)};
    spot.direction = {0, 0, -3};
    spot.intensity = {4, 4, 4};
    spot.inner_angle = 0.3;
    spot.outer_angle = 0.6;
    const LightSet lights = make_light_set(std::vector<Light>{spot}, ConstantEnvironment{}, {}, {});
    const auto sample = sample_light(lights, kPoint, 0.5F, {});
    return sample ? double(sample->radiance.x) : 0.0;
  };
  EXPECT_NEAR(irradiance_at(0.0), 1.0, 1e-5);
  EXPECT_NEAR(irradiance_at(0.29), 1.0, 1e-5);
  EXPECT_EQ(irradiance_at(0.61), 0.0);
  const double x = (std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
  EXPECT_NEAR(irradiance_at(0.45), x * x, 1e-4);
}

TEST(Lights, directional_light_comes_from_where_it_travels) {
  const LightSet lights = make_light_set(
      std::vector<Light>{DirectionalLight{{0, 0, -5}, {2, 2, 2}}}, ConstantEnvironment{}, {}, {});
  const auto sample = sample_light(lights, kPoint, 0.5F, {});
  ASSERT_TRUE(sample && sample->is_delta);
  EXPECT_EQ(sample->wi, (Vec3f{0, 0, 1}));
  EXPECT_EQ(sample->radiance.x, 2.0F);
  EXPECT_TRUE(std::isinf(sample->distance));
}

TEST(Lights, all_kinds_together_sum_up) {
  const Vec3d p(kPoint);
  const std::vector<Light> all = {
      PointLight{p + Vec3d{1, 0, 2}, {3, 3, 3}}, SpotLight{.position = p + Vec3d{0, 0, 3}},
      DirectionalLight{{0.2, 0.1, -1}, {1, 1, 1}}, area_light({-1, -1, 2}, {0, 2, 0}, {2, 0, 0})};
  double expected = 0;
  for (const Light& light : all) {
    expected += sampled_irradiance(
        make_light_set(std::vector<Light>{light}, ConstantEnvironment{}, {}, {}), {0, 0, 1}, 4096);
  }
  expected +=
      sampled_irradiance(make_light_set({}, SkyEnvironment{}, {}, {}), {0, 0, 1}, 1U << 15U);
  const LightSet together = make_light_set(all, SkyEnvironment{}, {}, {{}, 2});
  EXPECT_NEAR(sampled_irradiance(together, {0, 0, 1}, 1U << 17U), expected, 0.01 * expected);
}

TEST(Lights, rectangles_emit_forward_only) {
  const LightSet lights =
      make_light_set(std::vector<Light>{area_light({-1, -1, -1}, {0, 2, 0}, {2, 0, 0})},
                     ConstantEnvironment{}, {}, {});
  EXPECT_FALSE(sample_light(lights, kPoint, 0.5F, {0.5F, 0.5F}));
  EXPECT_FALSE(find_area_light(lights, kPoint, {0, 0, -1}, 10, RayKind::scattered));
  EXPECT_TRUE(find_area_light(lights, {0, 0, -3}, {0, 0, 1}, 10, RayKind::scattered));
}

TEST(Lights, finds_the_nearest_rectangle_that_the_ray_may_see) {
  AreaLight near = area_light({-1, -1, 1}, {0, 2, 0}, {2, 0, 0});
  near.visible_to_camera = false;
  const AreaLight far = area_light({-1, -1, 2}, {0, 2, 0}, {2, 0, 0});
  const LightSet lights =
      make_light_set(std::vector<Light>{far, near}, ConstantEnvironment{}, {}, {});
  const Vec3f up{0, 0, 2};
  const auto scattered = find_area_light(lights, {0, 0, 0}, up, 10, RayKind::scattered);
  const auto camera = find_area_light(lights, {0, 0, 0}, up, 10, RayKind::camera);
  ASSERT_TRUE(scattered && camera);
  EXPECT_EQ(scattered->index, 1U);
  EXPECT_FLOAT_EQ(scattered->t, 0.5F);
  EXPECT_EQ(camera->index, 0U);
  EXPECT_FALSE(find_area_light(lights, {0, 0, 0}, up, 0.4F, RayKind::scattered));
  EXPECT_FALSE(find_area_light(lights, {3, 0, 0}, up, 10, RayKind::scattered));
}

TEST(Lights, dark_and_degenerate_emitters_are_never_drawn) {
  const EmissiveTriangle line{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1, 1, 1}, true};
  const LightSet none =
      make_light_set(std::vector<Light>{PointLight{{0, 0, 1}, {0, 0, 0}}},
                     ConstantEnvironment{{1, 1, 1}}, std::vector<EmissiveTriangle>{line}, {});
  EXPECT_FALSE(has_emitters(none));
  EXPECT_FALSE(sample_light(none, kPoint, 0.5F, {0.5F, 0.5F}));
  EXPECT_EQ(eval_environment(none, {0, 0, 1}), Rgb(1.0F));
  EXPECT_EQ(pdf_environment(none, {0, 0, 1}), 0.0F);
}

}  // namespace
}  // namespace arris::test
