// display_codes.h — linear colours as 8-bit sRGB, fast enough for each frame of a viewer
// What       the display curve (display_curve.h), then codes from a table
// Guarantee  within one code of what a saved PNG has (tests/view/encoder_test.cpp)
#pragma once

#include <cstddef>
#include <cstdint>

namespace arris {

// rgb: 3 values a pixel; codes: as many. scale: exposure_scale().
void make_display_codes(const float* rgb, std::size_t pixels, float scale, std::uint8_t* codes);

}  // namespace arris
