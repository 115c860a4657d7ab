// tint_image.h — what a surface's texture makes of the light of each pixel
// What       Points on textured surfaces are shaded as if their textures were white; what is interpolated between them
//            is multiplied by the pixel's tint: what its primary region reflects over what it would reflect in white.
// Cost       12 bytes and a bit a pixel
#pragma once

#include <cstddef>
#include <vector>

#include "arris/math.h"
#include "edgepoint/bit_plane.h"

namespace arris {

struct TintImage {
  BitPlane is_tinted;       // tints elsewhere mean nothing: nothing is multiplied
  std::vector<Rgb> values;  // row after row
  int width_px = 0;

  TintImage() = default;
  TintImage(int width, int height)
      : is_tinted(width, height),
        values(std::size_t(width) * std::size_t(height)),
        width_px(width) {}

  [[nodiscard]] Rgb at(int x, int y) const {
    if (!is_tinted.at(x, y)) return {1, 1, 1};
    return values[std::size_t(y) * std::size_t(width_px) + std::size_t(x)];
  }
};

}  // namespace arris
