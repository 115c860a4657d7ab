// The curve of 8-bit output: Khronos PBR Neutral. Colours up to 0.8 keep hue and saturation (less a
// Fresnel floor of 4%, which light reflected at 4% adds to every dielectric); brighter ones are
// compressed and then drawn towards white, so that highlights keep their hue without looking flat.
// Source     Khronos Group, "PBR Neutral Tone Mapper specification" (2024),
// github.com/KhronosGroup/ToneMapping
#include <algorithm>
#include <cmath>

#include "arris/io.h"
#include "image/srgb.h"

namespace arris {
namespace {

constexpr float kFresnel = 0.04F;
constexpr float kStartCompression = 0.8F - kFresnel;
constexpr float kDesaturation = 0.15F;
// Far above any display and far below overflow of what is computed from it.
constexpr float kBrightest = 1e9F;

// What can't be shown: not a number and below zero become 0.
float displayable(float value) {
  return value > 0 ? std::min(value, kBrightest) : 0.0F;
}

Rgb eval_pbr_neutral(Rgb color) {
  const float least = std::min({color.x, color.y, color.z});
  const float offset = least < 2 * kFresnel ? least - least * least / (4 * kFresnel) : kFresnel;
  color = color - Rgb(offset);
  const float peak = max_component(color);
  if (peak < kStartCompression) return color;

  const float range = 1 - kStartCompression;
  const float new_peak = 1 - range * range / (peak + range - kStartCompression);
  color *= new_peak / peak;
  const float white = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
  return color * (1 - white) + Rgb(new_peak) * white;
}

}  // namespace

Rgb tone_map(Rgb linear, double exposure) {
  const float scale = std::min(float(std::exp2(exposure)), kBrightest);
  const Rgb mapped = eval_pbr_neutral({displayable(displayable(linear.x) * scale),
                                       displayable(displayable(linear.y) * scale),
                                       displayable(displayable(linear.z) * scale)});
  return {srgb_from_linear(mapped.x), srgb_from_linear(mapped.y), srgb_from_linear(mapped.z)};
}

}  // namespace arris
