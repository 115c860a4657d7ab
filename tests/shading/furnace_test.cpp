// White materials under white light from everywhere: they send back what they get, no more and no less.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/sobol.h"
#include "shading/ggx_albedo.h"
#include "shading/material_table.h"
#include "support/chi_squared.h"

namespace arris::test {
namespace {

constexpr double kMaxGain = 0.01;
constexpr double kMaxLoss = 0.02;
// Nearer to grazing than the tables resolve.
constexpr float kGrazingCosine = 0.04F;
constexpr double kMaxGrazingLoss = 0.04;

class WhiteFurnace : public testing::TestWithParam<MaterialCase> {};

INSTANTIATE_TEST_SUITE_P(Bsdf, WhiteFurnace, testing::ValuesIn(material_cases()),
                         [](const auto& material) { return material.param.name; });

double sampled_albedo(const Bsdf& bsdf) {
  constexpr std::uint32_t kSamples = 1U << 15U;
  double sum = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    Sampler sampler(1, 2, 3, i);
    const float u_lobe = sampler.next_1d();
    const auto sample = sample_bsdf(bsdf, u_lobe, sampler.next_2d());
    sum += sample ? double(sample->weight.x) : 0.0;
  }
  return sum / kSamples;
}

TEST_P(WhiteFurnace, neither_gains_nor_loses_light) {
  const MaterialCase& c = GetParam();
  // A mix scatters once only: what its glossy part masks is lost, as in the renderer it follows.
  const double masked = c.material.is_mix ? 0.15 * double(c.material.glossy_share) : 0;
  for (const float cosine : {1.0F, 0.9F, 0.75F, 0.5F, 0.3F, 0.15F, 0.05F, 0.01F}) {
    const double albedo = sampled_albedo(make_bsdf(c.material, direction_of(cosine, 1), c.side));
    EXPECT_LT(albedo, 1.0 + kMaxGain) << "cos_o " << cosine;
    const double max_loss = cosine < kGrazingCosine ? kMaxGrazingLoss : kMaxLoss;
    EXPECT_GT(albedo, 1.0 - max_loss - masked) << "cos_o " << cosine;
  }
}

// The same without the sampler: eval has to be right by itself, since next-event estimation uses it alone.
TEST_P(WhiteFurnace, eval_integrates_to_what_samples_average) {
  const MaterialCase& c = GetParam();
  for (const float cosine : {0.95F, 0.5F, 0.2F}) {
    const Bsdf bsdf = make_bsdf(c.material, direction_of(cosine, 1), c.side);
    double delta = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      Sampler sampler(5, 2, 3, i);
      const float u_lobe = sampler.next_1d();
      const auto sample = sample_bsdf(bsdf, u_lobe, sampler.next_2d());
      delta += sample && sample->is_delta ? double(sample->weight.x) / 4096 : 0.0;
    }
    const double integral = integrate_sphere([&](Vec3f wi) { return eval_bsdf(bsdf, wi).x; }, 2e-6);
    EXPECT_NEAR(integral + delta, sampled_albedo(bsdf), 0.008) << "cos_o " << cosine;
  }
}

TEST(GgxAlbedo, agrees_with_numerical_integration) {
  for (const float roughness : {0.05F, 0.13F, 0.37F, 0.71F, 0.99F}) {
    for (const float cosine : {0.97F, 0.6F, 0.33F, 0.11F, 0.03F}) {
      const float alpha = roughness * roughness;
      const Vec3f wo = direction_of(cosine, 0);
      const float slope_o = ggx_slope(alpha, wo.z);
      constexpr std::uint32_t kSamples = 1U << 14U;
      double sum = 0;
      double bias = 0;
      for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = sample_ggx_normal(alpha, wo, Sampler(9, 9, 9, i).next_2d());
        const Vec3f wi = reflect(wo, h);
        if (wi.z > 0.0F) {
          const double w =
              double(ggx_shadowing(wo.z, slope_o, wi.z, ggx_slope(alpha, wi.z))) / kSamples;
          sum += w;
          bias += w * double(schlick_weight(dot(wo, h)));
        }
      }
      const GgxAlbedo albedo = ggx_albedo(cosine, roughness);
      EXPECT_NEAR(double(albedo.scale + albedo.bias), sum, 0.01) << roughness << " " << cosine;
      EXPECT_NEAR(double(albedo.bias), bias, 0.01) << roughness << " " << cosine;
    }
  }
}

}  // namespace
}  // namespace arris::test
