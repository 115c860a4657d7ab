// picture_hdr.h — Radiance pictures (.hdr, .pic)
// What       RGBE, flat or run-length encoded (both schemes), any of the eight orientations of
// which
//            "-Y height +X width" and its mirror images are taken
// Errors     kind input: what is wrong, with the scanline
// Source     Greg Ward, "Real Pixels", Graphics Gems II (1991); file format of the Radiance manual
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "arris/image.h"

namespace arris {

bool is_hdr(std::span<const std::uint8_t> bytes);
Image decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace arris
