// fresnel.h — unpolarised reflection at the interface of two dielectrics
// Legend     eta    refractive index beyond the interface over that on wo's side
//            cos_o  cosine of wo to the interface's normal, positive
#pragma once

#include <cmath>

namespace arris {

struct Refraction {
  float reflectance;  // 1 under total internal reflection
  float cos_t;  // cosine of the refracted ray to the reversed normal; 0 under total reflection
};

inline Refraction fresnel_dielectric(float cos_o, float eta) {
  const float sin2_t = (1.0F - cos_o * cos_o) / (eta * eta);
  if (sin2_t >= 1.0F) {
    return {1.0F, 0.0F};
  }
  const float cos_t = std::sqrt(1.0F - sin2_t);
  const float s = (cos_o - eta * cos_t) / (cos_o + eta * cos_t);
  const float p = (eta * cos_o - cos_t) / (eta * cos_o + cos_t);
  return {0.5F * (s * s + p * p), cos_t};
}

// Reflectance at normal incidence, and the index that has it (the larger one of the two).
constexpr float reflectance_of_ior(float ior) {
  const float r = (ior - 1.0F) / (ior + 1.0F);
  return r * r;
}
inline float ior_of_reflectance(float reflectance) {
  const float r = std::sqrt(reflectance < 0.99F ? reflectance : 0.99F);
  return (1.0F + r) / (1.0F - r);
}

}  // namespace arris
