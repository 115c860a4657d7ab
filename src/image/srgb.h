// srgb.h — the sRGB transfer curve
// In / Out   both in 0..1; arguments outside are clamped, NaN becomes 0
// Source     IEC 61966-2-1:1999
#pragma once

#include <cmath>
#include <cstdint>

namespace arris {

inline float linear_from_srgb(float encoded) {
  if (!(encoded > 0)) return 0;
  if (encoded >= 1) return 1;
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

inline float srgb_from_linear(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308F ? linear * 12.92F : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

// Rounded to the nearest code.
inline std::uint8_t quantize8(float unit) {
  if (!(unit > 0)) return 0;
  return unit >= 1 ? std::uint8_t(255) : std::uint8_t(unit * 255.0F + 0.5F);
}

}  // namespace arris
