// picture_exr.h — OpenEXR files in memory
// What       written as 32-bit float scan lines with ZIP: R, G, B, the layers, string attributes. A
// layer of
//            three or four channels becomes "name.R", "name.G", …, one of one channel plain "name".
//            Read from any flat file, half or float or integer, tiled or not; of several parts the
//            first
// Errors     kind input: corrupt, truncated, deep, subsampled, too large (picture_limits.h)
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arris/image.h"
#include "io/picture_file.h"

namespace arris {

bool is_exr(std::span<const std::uint8_t> bytes);
PictureFile decode_exr(std::span<const std::uint8_t> bytes, const std::string& name);
std::vector<std::uint8_t> encode_exr(const Picture& picture, const Attributes& attributes);

}  // namespace arris
