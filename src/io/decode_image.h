// decode_image.h — PNG and JPEG bytes to 8-bit texels
// In / Out   a whole file in memory; which format it is its first bytes say. Row 0 at the top;
// values as
//            stored (sRGB for colour); 16-bit PNGs are rounded to 8 bits
// Errors     arris::Error, kind input, where = name: unknown format, truncated, corrupt, larger
// than the
//            limits of picture_limits.h (checked before memory is taken)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace arris {

struct Rgba8Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::array<std::uint8_t, 4>> texels;
};

Rgba8Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace arris
