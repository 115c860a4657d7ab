// bsdf.h — how a surface scatters light: a sum of at most four lobes
// What       make_bsdf() turns the material at a point into lobes for one wo; eval_bsdf(), pdf_bsdf()
//            and sample_bsdf() belong together.
//            diffuse   Lambert
//            specular  GGX reflection of the dielectric's and the metal's surface, Schlick's Fresnel
//            glass     GGX reflection and refraction of the transmitting share, exact Fresnel
//            coat      GGX reflection of the clearcoat, F0 = 0.04, above all others
// In / Out   local frame: z = shading normal on wo's side; wo and wi unit, away from the surface.
//            wi.z < 0 is beyond the surface. eval returns f·|cos_i|; pdfs are per solid angle of wi.
// Guarantee  integrates over wi to at most 1.01 for every material, and to at least 0.98 for white ones
//            (0.96 where cos_o < 0.04) but for glossy mixes, which scatter once
//            (tests/shading/furnace_test.cpp). The layers below a reflecting one get what it leaves at
//            wo (albedo scaling); what GGX loses to single scattering is scaled back (Turquin). Both
//            look at wo alone, so only glossy mixes are reciprocal.
// Limits     alpha = roughness² below kMinAlpha is a delta lobe: eval and pdf leave it out, sample
//            returns it with is_delta. Light is carried as L/n²: the factor eta² of refracted radiance
//            is left out; it cancels on every path that ends in the medium it began in. The
//            transmission colour is split over a solid's two interfaces: sqrt(base_color) at each.
// Source     glTF 2.0 appendix B, KHR_materials_{ior,specular,transmission,clearcoat}; B. Walter et al.
//            2007; E. Turquin, "Practical multiple scattering compensation for microfacet models" (2019)
#pragma once

#include <cmath>
#include <optional>

#include "arris/math.h"
#include "base/scalar.h"
#include "base/trigonometry.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"
#include "shading/surface_material.h"

namespace arris {

// Where wo is: outside of the solid or in its glass. Decides the relative index.
enum class MediumSide { outside, inside };

// Fixed for one wo. Lobes with share 0 don't exist.
struct Bsdf {
  Vec3f wo;
  Rgb diffuse;         // albedo / π
  Rgb specular_f0;     // Fresnel × weight × compensation at normal incidence
  Rgb specular_f90;    // … at grazing
  Rgb glass_reflect;   // factor of Fresnel's reflectance
  Rgb glass_transmit;  // factor of what it leaves
  float coat = 0;      // weight
  float alpha = 1;     // of specular; 0: delta
  float glass_alpha = 1;
  float coat_alpha = 1;
  float slope_o = 1;  // ggx_slope(alpha, wo.z)
  float coat_slope_o = 1;
  float eta = 1;          // index beyond the surface over the one on wo's side: bends
  float fresnel_eta = 1;  // … after `specular`: reflects
  // Selection probabilities; sum 1 unless the surface is black.
  float share_diffuse = 0, share_specular = 0, share_glass = 0, share_coat = 0;
};

// wo.z: raised to a small positive number if the shading normal turned away from wo.
Bsdf make_bsdf(const SurfaceMaterial& material, Vec3f wo, MediumSide side = MediumSide::outside);

// Reflected of light that comes evenly from all sides; without what glass lobes do. material: what `bsdf` is of.
Rgb directional_albedo(const SurfaceMaterial& material, const Bsdf& bsdf);

struct BsdfValue {
  Rgb value;  // f·|cos_i|
  float pdf = 0;
};

struct BsdfSample {
  Vec3f wi;
  Rgb weight;     // f·|cos_i| / pdf, of all lobes; of the delta lobe alone if is_delta
  float pdf = 0;  // the lobe's selection probability if is_delta
  bool is_delta = false;
  bool is_transmission = false;
};

inline constexpr float kCoatF0 = 0.04F;

inline Rgb schlick(Rgb f0, Rgb f90, float weight) {
  return f0 + (f90 - f0) * weight;
}

// `specular` changes how much is reflected, not the directions, nor where reflection is total.
inline Refraction refract_glass(const Bsdf& bsdf, float cos_o) {
  Refraction refraction = fresnel_dielectric(cos_o, bsdf.eta);
  if (bsdf.fresnel_eta != bsdf.eta && refraction.cos_t > 0.0F) {
    refraction.reflectance = fresnel_dielectric(cos_o, bsdf.fresnel_eta).reflectance;
  }
  return refraction;
}

// Refracted side of eval: adds to nothing, as all other lobes reflect.
inline BsdfValue eval_glass_transmission(const Bsdf& bsdf, Vec3f wi) {
  Vec3f h = normalize(bsdf.wo + wi * bsdf.eta);
  h = h.z < 0.0F ? -h : h;
  const float cos_oh = dot(bsdf.wo, h);
  const float cos_ih = dot(wi, h);
  if (cos_oh <= 0.0F || cos_ih >= 0.0F) {
    return {};
  }
  const float denominator = cos_oh + bsdf.eta * cos_ih;
  const float jacobian = -cos_ih * bsdf.eta * bsdf.eta / (denominator * denominator);
  const float slope_i = ggx_slope(bsdf.glass_alpha, -wi.z);
  const float slope_o = bsdf.slope_o;
  const float transmittance = 1.0F - refract_glass(bsdf, cos_oh).reflectance;
  const float pdf = transmittance * ggx_density(bsdf.glass_alpha, h) *
                    ggx_visible_factor(bsdf.wo.z, slope_o) * 4.0F * cos_oh * jacobian;
  const float shadowing = ggx_shadowing(bsdf.wo.z, slope_o, -wi.z, slope_i);
  return {bsdf.glass_transmit * (pdf * shadowing), pdf * bsdf.share_glass};
}

// All lobes but delta ones.
inline BsdfValue eval_bsdf_with_pdf(const Bsdf& bsdf, Vec3f wi) {
  if (wi.z <= 0.0F) {
    const bool rough_glass = bsdf.share_glass > 0.0F && bsdf.glass_alpha > 0.0F && wi.z < 0.0F;
    return rough_glass ? eval_glass_transmission(bsdf, wi) : BsdfValue{};
  }
  BsdfValue result{bsdf.diffuse * wi.z, bsdf.share_diffuse * wi.z * (1.0F / kPiF)};
  if (bsdf.share_diffuse == 1.0F) {
    return result;
  }
  const Vec3f h = normalize(bsdf.wo + wi);
  const float cos_oh = dot(bsdf.wo, h);
  const float fresnel_weight = schlick_weight(cos_oh);
  const float glossy_share = bsdf.alpha > 0.0F ? bsdf.share_specular : 0.0F;
  const float glass_share = bsdf.glass_alpha > 0.0F ? bsdf.share_glass : 0.0F;
  if (glossy_share + glass_share > 0.0F) {
    const float d = ggx_density(bsdf.alpha, h);
    const float slope_i = ggx_slope(bsdf.alpha, wi.z);
    const float factor = d * ggx_reflection_factor(bsdf.wo.z, bsdf.slope_o, wi.z, slope_i);
    float pdf_share = glossy_share;
    if (glossy_share > 0.0F) {
      result.value += schlick(bsdf.specular_f0, bsdf.specular_f90, fresnel_weight) * factor;
    }
    if (glass_share > 0.0F) {
      const float reflectance = refract_glass(bsdf, cos_oh).reflectance;
      result.value += bsdf.glass_reflect * (factor * reflectance);
      pdf_share += glass_share * reflectance;
    }
    result.pdf += pdf_share * d * ggx_visible_factor(bsdf.wo.z, bsdf.slope_o);
  }
  if (bsdf.share_coat > 0.0F && bsdf.coat_alpha > 0.0F) {
    const float d = ggx_density(bsdf.coat_alpha, h);
    const float slope_i = ggx_slope(bsdf.coat_alpha, wi.z);
    const float fresnel = kCoatF0 + (1.0F - kCoatF0) * fresnel_weight;
    result.value += Rgb(bsdf.coat * fresnel * d *
                        ggx_reflection_factor(bsdf.wo.z, bsdf.coat_slope_o, wi.z, slope_i));
    result.pdf += bsdf.share_coat * d * ggx_visible_factor(bsdf.wo.z, bsdf.coat_slope_o);
  }
  return result;
}

inline Rgb eval_bsdf(const Bsdf& bsdf, Vec3f wi) {
  return eval_bsdf_with_pdf(bsdf, wi).value;
}
inline float pdf_bsdf(const Bsdf& bsdf, Vec3f wi) {
  return eval_bsdf_with_pdf(bsdf, wi).pdf;
}

// Every lobe is a delta: next-event estimation would find nothing.
inline bool is_delta_only(const Bsdf& bsdf) {
  return bsdf.share_diffuse == 0.0F && (bsdf.share_specular == 0.0F || bsdf.alpha == 0.0F) &&
         (bsdf.share_glass == 0.0F || bsdf.glass_alpha == 0.0F) &&
         (bsdf.share_coat == 0.0F || bsdf.coat_alpha == 0.0F);
}

inline BsdfSample delta_reflection(const Bsdf& bsdf, Rgb weight, float share) {
  return {{-bsdf.wo.x, -bsdf.wo.y, bsdf.wo.z}, weight * (1.0F / share), share, true, false};
}

inline Vec3f refract(Vec3f wo, Vec3f h, float cos_oh, float cos_t, float eta) {
  return h * (cos_oh / eta - cos_t) - wo * (1.0F / eta);
}

// u_side in [0, 1) decides between reflection and refraction.
inline BsdfSample sample_clear_glass(const Bsdf& bsdf, float u_side) {
  const Refraction glass = refract_glass(bsdf, bsdf.wo.z);
  const float share = bsdf.share_glass;
  if (u_side < glass.reflectance) {
    return delta_reflection(bsdf, bsdf.glass_reflect * glass.reflectance,
                            share * glass.reflectance);
  }
  const Vec3f wi = refract(bsdf.wo, {0, 0, 1}, bsdf.wo.z, glass.cos_t, bsdf.eta);
  return {wi, bsdf.glass_transmit * (1.0F / share), share * (1.0F - glass.reflectance), true, true};
}

inline Vec3f sample_rough_glass(const Bsdf& bsdf, float u_side, Vec2f u) {
  const Vec3f h = sample_ggx_normal(bsdf.glass_alpha, bsdf.wo, u);
  const float cos_oh = dot(bsdf.wo, h);
  const Refraction glass = refract_glass(bsdf, cos_oh);
  // What leaves to the wrong side is absorbed.
  if (u_side < glass.reflectance) {
    const Vec3f wi = reflect(bsdf.wo, h);
    return wi.z > 0.0F ? wi : Vec3f{};
  }
  const Vec3f wi = refract(bsdf.wo, h, cos_oh, glass.cos_t, bsdf.eta);
  return wi.z < 0.0F ? wi : Vec3f{};
}

inline Vec3f sample_cosine_hemisphere(Vec2f u) {
  const Vec2f circle = unit_circle(u.x);
  const float r = std::sqrt(u.y);
  return {r * circle.x, r * circle.y, std::sqrt(1.0F - u.y)};
}

// u_lobe selects, u samples; all in [0, 1). Nothing if the sample is absorbed or the surface black.
inline std::optional<BsdfSample> sample_bsdf(const Bsdf& bsdf, float u_lobe, Vec2f u) {
  // 1. Select a lobe; a delta lobe answers for itself.
  Vec3f wi;
  const float after_diffuse = bsdf.share_diffuse;
  const float after_specular = after_diffuse + bsdf.share_specular;
  const float after_coat = after_specular + bsdf.share_coat;
  if (u_lobe < after_diffuse) {
    wi = sample_cosine_hemisphere(u);
  } else if (u_lobe < after_specular) {
    if (bsdf.alpha == 0.0F) {
      const Rgb f = schlick(bsdf.specular_f0, bsdf.specular_f90, schlick_weight(bsdf.wo.z));
      return delta_reflection(bsdf, f, bsdf.share_specular);
    }
    wi = reflect(bsdf.wo, sample_ggx_normal(bsdf.alpha, bsdf.wo, u));
  } else if (u_lobe < after_coat) {
    if (bsdf.coat_alpha == 0.0F) {
      const float fresnel = kCoatF0 + (1.0F - kCoatF0) * schlick_weight(bsdf.wo.z);
      return delta_reflection(bsdf, Rgb(bsdf.coat * fresnel), bsdf.share_coat);
    }
    wi = reflect(bsdf.wo, sample_ggx_normal(bsdf.coat_alpha, bsdf.wo, u));
  } else if (bsdf.share_glass > 0.0F) {
    const float u_side = min_of((u_lobe - after_coat) / bsdf.share_glass, 0x1.fffffep-1F);
    if (bsdf.glass_alpha == 0.0F) {
      return sample_clear_glass(bsdf, u_side);
    }
    wi = sample_rough_glass(bsdf, u_side, u);
  }
  const bool from_glass = u_lobe >= after_coat;
  if (wi.z <= 0.0F && !from_glass) {
    return std::nullopt;
  }
  // 2. Weigh it by all lobes that could have drawn it.
  const BsdfValue value = eval_bsdf_with_pdf(bsdf, wi);
  if (!(value.pdf > 0.0F)) {
    return std::nullopt;
  }
  return BsdfSample{wi, value.value * (1.0F / value.pdf), value.pdf, false, wi.z < 0.0F};
}

}  // namespace arris
