// picture_limits.h — which picture sizes are believed
// What       check_picture_size() runs on a file's header, before memory is taken for its pixels
// Guarantee  memory stays below kMaxPicturePixels and below kMaxExpansion times the file
// Errors     kind input: the size and the limit
#pragma once

#include <cstdint>
#include <string>

#include "arris/image.h"

namespace arris {

// No format here packs a picture tighter: deflate reaches 1,032, JPEG of one colour about 1,500.
inline constexpr std::int64_t kMaxExpansion = 4096;

struct PictureSize {
  std::int64_t width_px = 0, height_px = 0;
  std::int64_t bytes_per_pixel = 0;  // in memory
};

void check_picture_size(const PictureSize& size, std::size_t file_bytes, const std::string& name);

}  // namespace arris
