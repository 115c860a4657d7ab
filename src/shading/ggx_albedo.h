// ggx_albedo.h — how much of the light GGX reflects in all, tabulated
// What       directional albedos of single-scattering lobes, for energy compensation and lobe selection
// Guarantee  within 0.01 of numerical integration (tests/shading/furnace_test.cpp)
// Cost       a bilinear lookup; the reflection table is built at its first use in about 8 ms, the glass
//            table, which rough glass alone needs, in about 40 ms; both are constant afterwards
// Source     the split into scale and bias: B. Karis, "Real Shading in Unreal Engine 4" (2013)
#pragma once

namespace arris {

// Albedo with Schlick's Fresnel: f0 · scale + f90 · bias. Their sum is the albedo of a white lobe.
struct GgxAlbedo {
  float scale = 1;
  float bias = 0;
};

// roughness 0: a mirror, exact.
GgxAlbedo ggx_albedo(float cos_o, float roughness);

// Albedo of reflection and refraction together through rough glass; eta: index beyond over index on wo's side.
float glass_albedo(float cos_o, float roughness, float eta);

}  // namespace arris
