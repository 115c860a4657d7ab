// pixel_view.h — from world points to pixels
// Legend     x, y: picture coordinates in pixels, (0, 0) the upper left corner of the upper left pixel; w: how far
//            in front of the eye, in the unit of the camera's rays; pixel_from_world · (p − eye) = (x w, y w, w)
#pragma once

#include "arris/math.h"

namespace arris {

struct PixelView {
  Vec3d eye;
  Mat3d pixel_from_world;
  int width_px = 0, height_px = 0;

  friend bool operator==(const PixelView&, const PixelView&) = default;
};

// (x w, y w, w) of a point.
inline Vec3d project(const PixelView& view, Vec3d p) {
  return view.pixel_from_world * (p - view.eye);
}

// Rows of a picture that one thread works on: first ≤ y < last.
struct RowBand {
  int first = 0, last = 0;
};

}  // namespace arris
