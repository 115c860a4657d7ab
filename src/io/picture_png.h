// picture_png.h — PNG files in memory
// What       every colour type, depth and interlacing is read as RGBA
// Errors     kind input: not a PNG, corrupt, truncated, too large (picture_limits.h)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/decode_image.h"

namespace arris {

bool is_png(std::span<const std::uint8_t> bytes);

Rgba8Image decode_png(std::span<const std::uint8_t> bytes, const std::string& name);

struct Rgba16Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::array<std::uint16_t, 4>> pixels;  // sRGB encoded; 65535 is 1
};
Rgba16Image decode_png16(std::span<const std::uint8_t> bytes, const std::string& name);

// Interleaved 8-bit samples, sRGB encoded; 1 (grey), 3 or 4 channels.
struct Samples8 {
  int width_px = 0;
  int height_px = 0;
  int channels = 3;
  std::vector<std::uint8_t> samples;
};
std::vector<std::uint8_t> encode_png(const Samples8& image);

}  // namespace arris
