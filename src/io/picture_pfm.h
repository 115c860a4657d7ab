// picture_pfm.h — portable float maps
// What       "PF" (3 channels) and "Pf" (1 channel), rows from bottom to top, 32-bit floats in
// either byte order Errors     kind input: what is wrong in the header, or the bytes that are
// missing
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arris/image.h"

namespace arris {

bool is_pfm(std::span<const std::uint8_t> bytes);
Image decode_pfm(std::span<const std::uint8_t> bytes, const std::string& name);
// 1 or 3 channels; little endian.
std::vector<std::uint8_t> encode_pfm(const Image& image);

}  // namespace arris
