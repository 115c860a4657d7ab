// display_curve.h — the curve of 8-bit output before sRGB encoding: Khronos PBR Neutral
// What       colours up to 0.8 keep hue and saturation (less a Fresnel floor of 4%, which light reflected at 4% adds to
//            every dielectric); brighter ones are compressed and then drawn towards white, so that highlights keep
//            their hue without looking flat
// In / Out   linear scene-referred RGB in; linear display RGB out, 0..1. What can't be shown (not a number, below
//            zero) is 0.
// Source     Khronos Group, "PBR Neutral Tone Mapper specification" (2024), github.com/KhronosGroup/ToneMapping
#pragma once

#include <algorithm>
#include <cmath>

#include "arris/math.h"

namespace arris {

// Far above any display and far below overflow of what is computed from it.
inline constexpr float kBrightestShown = 1e9F;

// Of an exposure in stops.
inline float exposure_scale(double exposure) {
  return std::min(float(std::exp2(exposure)), kBrightestShown);
}

struct DisplayCurve {
  static constexpr float kFresnel = 0.04F;
  static constexpr float kStartCompression = 0.8F - kFresnel;
  static constexpr float kDesaturation = 0.15F;
};

inline Rgb eval_display_curve(Rgb linear, float scale) {
  constexpr float kFresnel = DisplayCurve::kFresnel;
  constexpr float kStartCompression = DisplayCurve::kStartCompression;
  const auto displayable = [](float value) {
    return value > 0 ? std::min(value, kBrightestShown) : 0.0F;
  };
  Rgb color{displayable(displayable(linear.x) * scale), displayable(displayable(linear.y) * scale),
            displayable(displayable(linear.z) * scale)};

  const float least = std::min({color.x, color.y, color.z});
  const float offset = least < 2 * kFresnel ? least - least * least / (4 * kFresnel) : kFresnel;
  color = color - Rgb(offset);
  const float peak = max_component(color);
  if (peak < kStartCompression) return color;

  const float range = 1 - kStartCompression;
  const float new_peak = 1 - range * range / (peak + range - kStartCompression);
  color *= new_peak / peak;
  const float white = 1 - 1 / (DisplayCurve::kDesaturation * (peak - new_peak) + 1);
  return color * (1 - white) + Rgb(new_peak) * white;
}

}  // namespace arris
