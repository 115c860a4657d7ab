// picture_jpeg.h — JPEG files in memory
// What       baseline and progressive, grey and colour, read as RGBA; written with full colour
// resolution (4:4:4) Errors     kind input: not a JPEG, corrupt, truncated, CMYK, too large
// (picture_limits.h)
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/decode_image.h"
#include "io/picture_png.h"

namespace arris {

inline constexpr int kMaxJpegSide = 65500;  // of libjpeg; the format could hold 65,535

bool is_jpeg(std::span<const std::uint8_t> bytes);

Rgba8Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name);

// 1 or 3 channels. quality: 1 to 100.
std::vector<std::uint8_t> encode_jpeg(const Samples8& image, int quality);

}  // namespace arris
