// tint_image.h — what a surface's texture makes of the light of each pixel
// What       Points on textured surfaces are shaded as if their textures were white. Of what is interpolated between
//            them, the part that goes with the base colour (ShadedPoint::painted) is multiplied by the pixel's tint:
//            its texture in its primary region, averaged over the pixel's filter.
// Cost       12 bytes and a bit a pixel
#pragma once

#include <cstddef>
#include <vector>

#include "arris/math.h"
#include "edgepoint/bit_plane.h"

namespace arris {

// light: with white textures; painted: the part of it that goes with the base colour.
inline Rgb tinted(Rgb light, Rgb painted, Rgb tint) {
  return light + painted * (tint - Rgb(1));
}

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
