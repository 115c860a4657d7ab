// material_table.h — the materials that every scattering test runs over
// What       a new lobe or parameter needs a line here, and is tested by all suites
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "shading/bsdf.h"
#include "shading/surface_material.h"

namespace arris::test {

struct MaterialCase {
  std::string name;
  SurfaceMaterial material;
  MediumSide side = MediumSide::outside;
};

inline void PrintTo(const MaterialCase& c, std::ostream* out) {
  *out << c.name;
}

// White, so that the furnace is; colours don't matter to the other tests.
inline std::vector<MaterialCase> material_cases() {
  const SurfaceMaterial white{.base_color = Rgb(1.0F)};
  const auto with = [](SurfaceMaterial m, auto change) {
    change(m);
    return m;
  };
  using M = SurfaceMaterial;
  std::vector<MaterialCase> cases = {
      {"lambert", with(white, [](M& m) { m.is_mix = true; })},
      {"mix",
       with(white, [](M& m) { m.is_mix = true, m.glossy_share = 0.1F, m.roughness = 0.2F; })},
      {"glossy",
       with(white, [](M& m) { m.is_mix = true, m.glossy_share = 1, m.roughness = 0.4F; })},
      {"chalk", with(white, [](M& m) { m.specular = 0; })},
      {"diamond_like", with(white, [](M& m) { m.ior = 2.4F, m.roughness = 0.3F; })},
      {"half_metal", with(white, [](M& m) { m.metallic = 0.5F, m.roughness = 0.3F; })},
      {"lacquer", with(white, [](M& m) { m.clearcoat = 1, m.clearcoat_roughness = 0.2F; })},
      {"mirror_coat", with(white, [](M& m) { m.clearcoat = 1; })},
      {"coated_metal", with(white,
                            [](M& m) {
                              m.metallic = 1, m.roughness = 0.5F;
                              m.clearcoat = 0.7F, m.clearcoat_roughness = 0.1F;
                            })},
      {"milk_glass", with(white, [](M& m) { m.transmission = 0.5F, m.roughness = 0.4F; })},
      {"no_index_step", with(white, [](M& m) { m.transmission = 1, m.ior = 1; })},
      {"everything", with(white,
                          [](M& m) {
                            m.metallic = 0.3F, m.transmission = 0.6F, m.ior = 1.8F;
                            m.roughness = 0.5F, m.clearcoat = 0.8F, m.clearcoat_roughness = 0.3F;
                          })},
  };
  for (const float roughness : {0.0F, 0.1F, 0.3F, 0.6F, 1.0F}) {
    std::string suffix = "_";
    suffix += std::to_string(int(roughness * 10.0F));
    SurfaceMaterial m = white;
    m.roughness = roughness;
    cases.push_back({std::string("plastic").append(suffix), m});
    m.metallic = 1;
    cases.push_back({std::string("metal").append(suffix), m});
    m.metallic = 0;
    m.transmission = 1;
    cases.push_back({std::string("glass").append(suffix), m});
    cases.push_back({std::string("glass_inside").append(suffix), m, MediumSide::inside});
  }
  return cases;
}

inline Vec3f direction_of(float cos_theta, float phi) {
  const float r = std::sqrt(1.0F - cos_theta * cos_theta);
  return {r * std::cos(phi), r * std::sin(phi), cos_theta};
}

// From straight above to near grazing.
inline const std::vector<float>& outgoing_cosines() {
  static const std::vector<float> kCosines = {1.0F, 0.8F, 0.4F, 0.12F};
  return kCosines;
}

}  // namespace arris::test
