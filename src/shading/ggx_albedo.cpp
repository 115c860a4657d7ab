#include "shading/ggx_albedo.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/scalar.h"
#include "base/sobol.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"

namespace arris {
namespace {

constexpr int kCosines = 32;
constexpr int kRoughnesses = 32;
constexpr int kGlassCosines = 16;
constexpr int kGlassRoughnesses = 12;
constexpr int kGlassEtas = 24;
constexpr std::uint32_t kReflectionSamples = 256;
constexpr std::uint32_t kGlassSamples = 256;
// The glass table's axis is (eta - 1) / (eta + 1): eta from 1/3 to 3; an even count leaves eta = 1 out.
constexpr float kGlassEtaRange = 0.5F;

// Cosines are squares of evenly spaced numbers: the albedo falls fast towards grazing.
float cosine_of_node(int node, int count) {
  const float s = float(node) / float(count - 1);
  return max_of(s * s, 1e-4F);
}
float alpha_of_node(int node, int count) {
  const float roughness = float(node) / float(count - 1);
  return max_of(roughness * roughness, kMinAlpha);
}
Vec3f direction_of_cosine(float cosine) {
  return {std::sqrt(1.0F - cosine * cosine), 0.0F, cosine};
}

GgxAlbedo integrate_reflection(float cosine, float alpha) {
  const Vec3f wo = direction_of_cosine(cosine);
  const float slope_o = ggx_slope(alpha, wo.z);
  GgxAlbedo sum{0, 0};
  for (std::uint32_t i = 0; i < kReflectionSamples; ++i) {
    const Vec3f h = sample_ggx_normal(alpha, wo, Sampler(0, 0, 0, i).next_2d());
    const Vec3f wi = reflect(wo, h);
    if (wi.z > 0.0F) {
      const float weight = ggx_shadowing(wo.z, slope_o, wi.z, ggx_slope(alpha, wi.z));
      const float fresnel = schlick_weight(dot(wo, h));
      sum.scale += weight * (1.0F - fresnel);
      sum.bias += weight * fresnel;
    }
  }
  return {sum.scale / float(kReflectionSamples), sum.bias / float(kReflectionSamples)};
}

using GlassRow = std::array<float, kGlassEtas>;

float eta_of_node(std::size_t node) {
  const float x = kGlassEtaRange * (2.0F * float(node) / (kGlassEtas - 1) - 1.0F);
  return (1.0F + x) / (1.0F - x);
}

// For all indices at once: they share the microfacets.
GlassRow integrate_glass(float cosine, float alpha) {
  const Vec3f wo = direction_of_cosine(cosine);
  const float slope_o = ggx_slope(alpha, wo.z);
  GlassRow sums{};
  for (std::uint32_t i = 0; i < kGlassSamples; ++i) {
    const Vec3f h = sample_ggx_normal(alpha, wo, Sampler(0, 0, 0, i).next_2d());
    const float cos_oh = dot(wo, h);
    const Vec3f wr = reflect(wo, h);
    const float reflected =
        wr.z > 0.0F ? ggx_shadowing(wo.z, slope_o, wr.z, ggx_slope(alpha, wr.z)) : 0.0F;
    for (std::size_t e = 0; e < sums.size(); ++e) {
      const float eta = eta_of_node(e);
      const Refraction refraction = fresnel_dielectric(cos_oh, eta);
      const float cos_t = -(h.z * (cos_oh / eta - refraction.cos_t) - wo.z / eta);
      const float refracted =
          cos_t > 0.0F ? ggx_shadowing(wo.z, slope_o, cos_t, ggx_slope(alpha, cos_t)) : 0.0F;
      sums[e] += refracted + (reflected - refracted) * refraction.reflectance;
    }
  }
  for (float& sum : sums) {
    sum /= float(kGlassSamples);
  }
  return sums;
}

using ReflectionTable = std::array<std::array<GgxAlbedo, kCosines>, kRoughnesses>;
using GlassSlice = std::array<std::array<float, kGlassCosines>, kGlassRoughnesses>;
using GlassTable = std::array<GlassSlice, kGlassEtas>;

ReflectionTable make_reflection_table() {
  ReflectionTable table;
  for (int r = 0; r < kRoughnesses; ++r) {
    for (int c = 0; c < kCosines; ++c) {
      table[std::size_t(r)][std::size_t(c)] =
          integrate_reflection(cosine_of_node(c, kCosines), alpha_of_node(r, kRoughnesses));
    }
  }
  return table;
}

GlassTable make_glass_table() {
  GlassTable table;
  for (std::size_t r = 0; r < kGlassRoughnesses; ++r) {
    for (std::size_t c = 0; c < kGlassCosines; ++c) {
      const GlassRow row = integrate_glass(cosine_of_node(int(c), kGlassCosines),
                                           alpha_of_node(int(r), kGlassRoughnesses));
      for (std::size_t e = 0; e < kGlassEtas; ++e) {
        table[e][r][c] = row[e];
      }
    }
  }
  return table;
}

// Where x in [0, 1] falls among `count` evenly spaced nodes.
struct Interpolation {
  std::size_t node;
  float fraction;
};
Interpolation interpolation_at(float x, int count) {
  const float scaled = min_of(max_of(x, 0.0F), 1.0F) * float(count - 1);
  const int node = scaled < float(count - 2) ? int(scaled) : count - 2;
  return {std::size_t(node), scaled - float(node)};
}

float mix(float a, float b, float t) {
  return a + (b - a) * t;
}
GgxAlbedo mix(GgxAlbedo a, GgxAlbedo b, float t) {
  return {mix(a.scale, b.scale, t), mix(a.bias, b.bias, t)};
}

template <class Table>
auto bilinear(const Table& table, Interpolation row, Interpolation column) {
  const auto& r0 = table[row.node];
  const auto& r1 = table[row.node + 1];
  return mix(mix(r0[column.node], r0[column.node + 1], column.fraction),
             mix(r1[column.node], r1[column.node + 1], column.fraction), row.fraction);
}

}  // namespace

GgxAlbedo ggx_albedo(float cos_o, float roughness) {
  if (roughness * roughness < kMinAlpha) {
    const float fresnel = schlick_weight(cos_o);
    return {1.0F - fresnel, fresnel};
  }
  static const ReflectionTable kTable = make_reflection_table();
  return bilinear(kTable, interpolation_at(roughness, kRoughnesses),
                  interpolation_at(std::sqrt(cos_o), kCosines));
}

float glass_albedo(float cos_o, float roughness, float eta) {
  static const GlassTable kTable = make_glass_table();
  const float x = (eta - 1.0F) / (eta + 1.0F);
  const Interpolation slice = interpolation_at(0.5F + 0.5F * x / kGlassEtaRange, kGlassEtas);
  const Interpolation row = interpolation_at(roughness, kGlassRoughnesses);
  const Interpolation column = interpolation_at(std::sqrt(cos_o), kGlassCosines);
  return mix(bilinear(kTable[slice.node], row, column),
             bilinear(kTable[slice.node + 1], row, column), slice.fraction);
}

}  // namespace arris
