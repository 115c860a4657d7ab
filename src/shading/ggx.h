// ggx.h — the isotropic GGX microfacet distribution with Smith's height-correlated masking
// In / Out   local frame, z = normal; unit vectors away from the surface; alpha = roughness²
// Legend     alpha  width of the slope distribution; callers keep it at or above kMinAlpha
//            h      microfacet normal, h.z > 0
//            D      density of microfacet normals per solid angle, ∫ D cosθ = 1
//            S(w)   sqrt(alpha² + (1 - alpha²) cos²θ): 1 + 2Λ(w) = S / cosθ
// Source     B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007;
//            E. Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014, eq. 99;
//            visible normals: J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps",
//            HPG 2023
#pragma once

#include <cmath>

#include "arris/math.h"
#include "base/scalar.h"
#include "base/trigonometry.h"

namespace arris {

// Smoother surfaces are perfect mirrors (delta lobes), so that D's peak 1/(π alpha²) stays inside float.
inline constexpr float kMinAlpha = 1e-4F;
inline constexpr float kPiF = float(kPi);

// In the form that stays exact about the peak, where 1 - h.z² would cancel.
inline float ggx_density(float alpha, Vec3f h) {
  const float alpha2 = alpha * alpha;
  const float t = (h.x * h.x + h.y * h.y) + alpha2 * h.z * h.z;
  return alpha2 / (kPiF * t * t);
}

inline float ggx_slope(float alpha, float cos_w) {
  const float alpha2 = alpha * alpha;
  return std::sqrt(alpha2 + (1.0F - alpha2) * cos_w * cos_w);
}

// G1(wo) / (4 cos_o): times D it is the pdf of reflected directions, per solid angle.
inline float ggx_visible_factor(float cos_o, float slope_o) {
  return 0.5F / (cos_o + slope_o);
}

// G2(wo, wi) / (4 cos_o): times D and Fresnel it is the reflected f·cos_i.
inline float ggx_reflection_factor(float cos_o, float slope_o, float cos_i, float slope_i) {
  return 0.5F * cos_i / (cos_o * slope_i + cos_i * slope_o);
}

// G2 / G1(wo), the weight of a reflected sample without Fresnel.
inline float ggx_shadowing(float cos_o, float slope_o, float cos_i, float slope_i) {
  return cos_i * (cos_o + slope_o) / (cos_o * slope_i + cos_i * slope_o);
}

// A microfacet normal with density D(h) max(0, wo·h) G1(wo) / wo.z. Precondition: wo.z > 0.
inline Vec3f sample_ggx_normal(float alpha, Vec3f wo, Vec2f u) {
  const Vec3f w = normalize(Vec3f{alpha * wo.x, alpha * wo.y, wo.z});
  const float z = (1.0F - u.y) * (1.0F + w.z) - w.z;
  const float r = std::sqrt(max_of(0.0F, 1.0F - z * z));
  const Vec2f circle = unit_circle(u.x);
  const Vec3f h{r * circle.x + w.x, r * circle.y + w.y, z + w.z};
  return normalize(Vec3f{alpha * h.x, alpha * h.y, max_of(h.z, 1e-6F)});
}

inline Vec3f reflect(Vec3f w, Vec3f h) {
  return h * (2.0F * dot(w, h)) - w;
}

// (1 - c)^5
inline float schlick_weight(float c) {
  const float m = c < 1.0F ? 1.0F - c : 0.0F;
  const float m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace arris
