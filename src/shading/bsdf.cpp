#include "shading/bsdf.h"

#include <cmath>

#include "shading/ggx_albedo.h"

namespace arris {
namespace {

// Interpolated and mapped normals may turn away from wo: that far above the surface it is taken then.
constexpr float kMinCosine = 1e-3F;
// Rough glass between indices closer than this is clear: its half vector is not defined.
constexpr float kMinIndexStep = 1e-3F;

Vec3f raise_above_surface(Vec3f wo) {
  return wo.z >= kMinCosine ? wo : normalize(Vec3f{wo.x, wo.y, kMinCosine});
}

float alpha_of_roughness(float roughness) {
  const float alpha = roughness * roughness;
  return alpha < kMinAlpha ? 0.0F : min_of(alpha, 1.0F);
}

Rgb min_one(Rgb c) {
  return min(c, Rgb(1.0F));
}

// Fresnel's ends of one surface, times what scales single scattering to all scattering.
struct SpecularLayer {
  Rgb f0, f90;
  Rgb albedo;
};

SpecularLayer make_specular_layer(Rgb f0, float f90, GgxAlbedo albedo) {
  const float single = albedo.scale + albedo.bias;
  const Rgb compensation = Rgb(1.0F) + f0 * ((1.0F - single) / single);
  const Rgb scaled_f0 = f0 * compensation;
  const Rgb scaled_f90 = compensation * f90;
  return {scaled_f0, scaled_f90, scaled_f0 * albedo.scale + scaled_f90 * albedo.bias};
}

void normalize_shares(Bsdf& bsdf) {
  const float sum = bsdf.share_diffuse + bsdf.share_specular + bsdf.share_glass + bsdf.share_coat;
  if (sum <= 0.0F) {
    return;
  }
  const float scale = 1.0F / sum;
  bsdf.share_specular *= scale;
  bsdf.share_glass *= scale;
  bsdf.share_coat *= scale;
  const float others = bsdf.share_specular + bsdf.share_glass + bsdf.share_coat;
  bsdf.share_diffuse = bsdf.share_diffuse > 0.0F ? max_of(0.0F, 1.0F - others) : 0.0F;
}

Bsdf make_mix(const SurfaceMaterial& material, Vec3f wo) {
  Bsdf bsdf;
  bsdf.wo = wo;
  const float share = material.glossy_share;
  bsdf.diffuse = material.base_color * ((1.0F - share) / kPiF);
  bsdf.share_diffuse = (1.0F - share) * max_component(material.base_color);
  bsdf.specular_f0 = bsdf.specular_f90 = Rgb(share);
  bsdf.share_specular = share;
  if (share > 0.0F) {
    bsdf.alpha = alpha_of_roughness(material.roughness);
    bsdf.slope_o = ggx_slope(bsdf.alpha, wo.z);
  }
  normalize_shares(bsdf);
  return bsdf;
}

// weight: the transmitting share of the surface below the coat.
void add_glass(Bsdf& bsdf, const SurfaceMaterial& material, float weight, MediumSide side) {
  const float tint = max_component(material.specular_color);
  const float f0 = min_of(1.0F, reflectance_of_ior(material.ior) * material.specular * tint);
  const bool plain = material.specular == 1.0F && tint == 1.0F;
  const float reflecting_ior = plain ? material.ior : ior_of_reflectance(f0);
  const bool outside = side == MediumSide::outside;
  bsdf.eta = outside ? material.ior : 1.0F / material.ior;
  bsdf.fresnel_eta = outside ? reflecting_ior : 1.0F / reflecting_ior;
  bsdf.glass_alpha = std::fabs(bsdf.eta - 1.0F) < kMinIndexStep ? 0.0F : bsdf.alpha;
  float scale = weight;
  if (bsdf.glass_alpha > 0.0F) {
    scale /= glass_albedo(bsdf.wo.z, material.roughness, bsdf.eta);
  }
  const Rgb color = material.base_color;
  bsdf.glass_reflect = material.specular_color * (tint > 0.0F ? scale / tint : 0.0F);
  bsdf.glass_transmit = Rgb{std::sqrt(color.x), std::sqrt(color.y), std::sqrt(color.z)} * scale;
  bsdf.share_glass = weight;
}

// Returns what the coat leaves to the layers below.
float add_coat(Bsdf& bsdf, const SurfaceMaterial& material) {
  bsdf.coat = material.clearcoat;
  bsdf.coat_alpha = alpha_of_roughness(material.clearcoat_roughness);
  bsdf.coat_slope_o = ggx_slope(bsdf.coat_alpha, bsdf.wo.z);
  const GgxAlbedo albedo = ggx_albedo(bsdf.wo.z, material.clearcoat_roughness);
  bsdf.share_coat = bsdf.coat * (kCoatF0 * albedo.scale + albedo.bias);
  return 1.0F - bsdf.share_coat;
}

}  // namespace

Bsdf make_bsdf(const SurfaceMaterial& material, Vec3f wo_given, MediumSide side) {
  const Vec3f wo = raise_above_surface(wo_given);
  if (material.is_mix) {
    return make_mix(material, wo);
  }
  Bsdf bsdf;
  bsdf.wo = wo;
  bsdf.alpha = alpha_of_roughness(material.roughness);
  bsdf.slope_o = ggx_slope(bsdf.alpha, wo.z);
  const bool coated = material.clearcoat > 0.0F && side == MediumSide::outside;
  const float below_coat = coated ? add_coat(bsdf, material) : 1.0F;

  const float metal = material.metallic * below_coat;
  const float glass = (below_coat - metal) * material.transmission;
  const float plastic = below_coat - metal - glass;
  const GgxAlbedo albedo = ggx_albedo(wo.z, material.roughness);
  Rgb specular_albedo;
  if (plastic > 0.0F) {
    const Rgb f0 =
        min_one(material.specular_color * reflectance_of_ior(material.ior)) * material.specular;
    const SpecularLayer layer = make_specular_layer(f0, material.specular, albedo);
    bsdf.specular_f0 += layer.f0 * plastic;
    bsdf.specular_f90 += layer.f90 * plastic;
    specular_albedo += layer.albedo * plastic;
    const float left = plastic * max_of(0.0F, 1.0F - max_component(layer.albedo));
    bsdf.diffuse = material.base_color * (left / kPiF);
    bsdf.share_diffuse = max_component(material.base_color) * left;
  }
  if (metal > 0.0F) {
    const SpecularLayer layer = make_specular_layer(min_one(material.base_color), 1.0F, albedo);
    bsdf.specular_f0 += layer.f0 * metal;
    bsdf.specular_f90 += layer.f90 * metal;
    specular_albedo += layer.albedo * metal;
  }
  bsdf.share_specular = max_component(specular_albedo);
  if (glass > 0.0F) {
    add_glass(bsdf, material, glass, side);
  }
  normalize_shares(bsdf);
  return bsdf;
}

Rgb directional_albedo(const SurfaceMaterial& material, const Bsdf& bsdf) {
  const GgxAlbedo specular = ggx_albedo(bsdf.wo.z, material.roughness);
  Rgb albedo =
      bsdf.diffuse * kPiF + bsdf.specular_f0 * specular.scale + bsdf.specular_f90 * specular.bias;
  if (bsdf.coat > 0) {
    const GgxAlbedo coat = ggx_albedo(bsdf.wo.z, material.clearcoat_roughness);
    albedo += Rgb(bsdf.coat * (kCoatF0 * coat.scale + coat.bias));
  }
  return albedo;
}

}  // namespace arris
