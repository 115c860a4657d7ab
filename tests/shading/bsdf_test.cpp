// Every material of the table: the sampler draws what the pdf says, and eval, pdf and sample agree.
#include "shading/bsdf.h"

#include <gtest/gtest.h>

#include <random>

#include "shading/material_table.h"
#include "support/chi_squared.h"

namespace arris::test {
namespace {

class EveryMaterial : public testing::TestWithParam<MaterialCase> {};

INSTANTIATE_TEST_SUITE_P(Bsdf, EveryMaterial, testing::ValuesIn(material_cases()),
                         [](const auto& material) { return material.param.name; });

std::vector<Bsdf> bsdfs_of(const MaterialCase& c) {
  std::vector<Bsdf> bsdfs;
  float phi = 0.3F;
  for (const float cosine : outgoing_cosines()) {
    bsdfs.push_back(make_bsdf(c.material, direction_of(cosine, phi), c.side));
    phi += 1.1F;
  }
  return bsdfs;
}

// The share of samples that delta lobes take away from the density.
float delta_share(const Bsdf& b) {
  return (b.alpha == 0.0F ? b.share_specular : 0.0F) +
         (b.coat_alpha == 0.0F ? b.share_coat : 0.0F) +
         (b.glass_alpha == 0.0F ? b.share_glass : 0.0F);
}

TEST_P(EveryMaterial, samples_follow_their_pdf) {
  ChiSquaredSettings settings;
  settings.tests = int(material_cases().size() * outgoing_cosines().size());
  for (const Bsdf& bsdf : bsdfs_of(GetParam())) {
    if (is_delta_only(bsdf)) {
      continue;
    }
    const auto draw = [&](std::mt19937& random) -> std::optional<Vec3f> {
      const float u_lobe = uniform(random);
      const auto sample = sample_bsdf(bsdf, u_lobe, uniform_2d(random));
      return sample && !sample->is_delta ? std::optional(sample->wi) : std::nullopt;
    };
    const auto result = chi_squared_test(
        draw, [&](Vec3f wi) { return pdf_bsdf(bsdf, wi); }, settings);
    EXPECT_TRUE(result.passed) << "cos_o " << bsdf.wo.z << ", p " << result.p_value << ", ∫pdf "
                               << result.pdf_integral;
    EXPECT_LT(result.pdf_integral, 1.0 - double(delta_share(bsdf)) + 2e-3) << bsdf.wo.z;
  }
}

TEST_P(EveryMaterial, samples_agree_with_eval_and_pdf) {
  std::mt19937 random(7);
  for (const Bsdf& bsdf : bsdfs_of(GetParam())) {
    for (int i = 0; i < 2000; ++i) {
      const float u_lobe = uniform(random);
      const auto sample = sample_bsdf(bsdf, u_lobe, uniform_2d(random));
      if (!sample) {
        continue;
      }
      ASSERT_NEAR(length(sample->wi), 1.0F, 1e-4F);
      ASSERT_EQ(sample->is_transmission, sample->wi.z < 0.0F);
      ASSERT_GT(sample->pdf, 0.0F);
      if (!sample->is_delta) {
        const Rgb value = eval_bsdf(bsdf, sample->wi);
        ASSERT_FLOAT_EQ(sample->pdf, pdf_bsdf(bsdf, sample->wi));
        ASSERT_NEAR(sample->weight.x * sample->pdf, value.x, 1e-4F * value.x);
      }
    }
  }
}

// Where there is light there are samples: otherwise the estimate would miss some.
TEST_P(EveryMaterial, pdf_is_positive_where_eval_is) {
  std::mt19937 random(9);
  for (const Bsdf& bsdf : bsdfs_of(GetParam())) {
    for (int i = 0; i < 5000; ++i) {
      const Vec2f u = uniform_2d(random);
      const Vec3f wi = sphere_direction(2.0 * double(u.x) - 1.0, 2.0 * kPi * double(u.y));
      const BsdfValue f = eval_bsdf_with_pdf(bsdf, wi);
      ASSERT_TRUE(std::isfinite(f.value.x) && std::isfinite(f.pdf) && f.value.x >= 0.0F);
      ASSERT_EQ(f.value.x > 0.0F, f.pdf > 0.0F) << wi.x << " " << wi.y << " " << wi.z;
    }
  }
}

TEST(Bsdf, is_reciprocal_without_layers) {
  std::mt19937 random(3);
  for (const MaterialCase& c : material_cases()) {
    if (!c.material.is_mix) {
      continue;
    }
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u = uniform_2d(random);
      const Vec2f v = uniform_2d(random);
      const Vec3f a = direction_of(0.02F + 0.97F * u.x, 6.28F * u.y);
      const Vec3f b = direction_of(0.02F + 0.97F * v.x, 6.28F * v.y);
      const float ab = eval_bsdf(make_bsdf(c.material, a), b).x / b.z;
      const float ba = eval_bsdf(make_bsdf(c.material, b), a).x / a.z;
      ASSERT_NEAR(ab, ba, 1e-3F * ab) << c.name;
    }
  }
}

TEST(Bsdf, lambert_is_albedo_over_pi) {
  SurfaceMaterial m;
  m.is_mix = true;
  m.base_color = {0.2F, 0.5F, 0.8F};
  const Bsdf bsdf = make_bsdf(m, direction_of(0.3F, 1));
  const BsdfValue f = eval_bsdf_with_pdf(bsdf, direction_of(0.6F, 4));
  EXPECT_NEAR(f.value.y, 0.5F / kPiF * 0.6F, 1e-6F);
  EXPECT_NEAR(f.pdf, 0.6F / kPiF, 1e-6F);
  EXPECT_EQ(eval_bsdf(bsdf, direction_of(-0.6F, 4)).y, 0.0F);
}

TEST(Bsdf, clear_glass_reflects_and_bends_as_fresnel_and_snell_say) {
  SurfaceMaterial m;
  m.base_color = Rgb(1.0F);
  m.transmission = 1;
  m.roughness = 0;
  const Vec3f wo = direction_of(std::cos(0.6F), 0);
  const Bsdf bsdf = make_bsdf(m, wo);
  EXPECT_TRUE(is_delta_only(bsdf));
  const auto reflected = sample_bsdf(bsdf, 0.0F, {0.5F, 0.5F});
  const auto refracted = sample_bsdf(bsdf, 0.999F, {0.5F, 0.5F});
  ASSERT_TRUE(reflected && refracted);
  EXPECT_NEAR(reflected->wi.x, -wo.x, 1e-6F);
  EXPECT_NEAR(-refracted->wi.x, wo.x / 1.5F, 1e-6F);
  const double t = std::asin(std::sin(0.6) / 1.5);
  const double s = std::sin(0.6 - t) / std::sin(0.6 + t);
  const double p = std::tan(0.6 - t) / std::tan(0.6 + t);
  EXPECT_NEAR(double(reflected->pdf), 0.5 * (s * s + p * p), 1e-5);
  EXPECT_NEAR(refracted->pdf, 1.0F - reflected->pdf, 1e-6F);
  EXPECT_NEAR(refracted->weight.x, 1.0F, 1e-6F);
}

TEST(Bsdf, glass_reflects_totally_beyond_the_critical_angle) {
  SurfaceMaterial m;
  m.transmission = 1;
  m.roughness = 0;
  const Bsdf bsdf = make_bsdf(m, direction_of(0.5F, 0), MediumSide::inside);
  const auto sample = sample_bsdf(bsdf, 0.9999F, {0.5F, 0.5F});
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->is_transmission);
  EXPECT_FLOAT_EQ(sample->pdf, 1.0F);
}

TEST(Bsdf, a_pane_shows_its_base_color_once) {
  SurfaceMaterial m;
  m.transmission = 1;
  m.roughness = 0;
  m.base_color = {0.25F, 0.5F, 1.0F};
  const auto enter = sample_bsdf(make_bsdf(m, {0, 0, 1}), 0.99F, {});
  const auto leave = sample_bsdf(make_bsdf(m, {0, 0, 1}, MediumSide::inside), 0.99F, {});
  ASSERT_TRUE(enter && leave && enter->is_transmission && leave->is_transmission);
  EXPECT_NEAR(enter->weight.x * leave->weight.x, 0.25F, 1e-6F);
  EXPECT_NEAR(enter->weight.y * leave->weight.y, 0.5F, 1e-6F);
}

TEST(Bsdf, survives_a_shading_normal_that_turned_away) {
  SurfaceMaterial m;
  for (const Vec3f wo : {Vec3f{1, 0, 0}, normalize(Vec3f{1, 0, -0.3F}), Vec3f{0, 0, -1}}) {
    const Bsdf bsdf = make_bsdf(m, wo);
    EXPECT_GT(bsdf.wo.z, 0.0F);
    const BsdfValue f = eval_bsdf_with_pdf(bsdf, direction_of(0.5F, 3));
    EXPECT_TRUE(std::isfinite(f.value.x) && std::isfinite(f.pdf));
  }
}

TEST(Bsdf, black_scatters_nothing) {
  SurfaceMaterial m;
  m.base_color = Rgb(0.0F);
  m.is_mix = true;
  const Bsdf bsdf = make_bsdf(m, {0, 0, 1});
  EXPECT_FALSE(sample_bsdf(bsdf, 0.5F, {0.5F, 0.5F}));
  EXPECT_EQ(eval_bsdf(bsdf, {0, 0, 1}).x, 0.0F);
}

}  // namespace
}  // namespace arris::test
