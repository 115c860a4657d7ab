// auto_radius.h — how large a rounding has to be to be seen
// What       readable_radius(): the world length that covers a given share of the picture at a given distance
//            from the camera: kReadablePart of its height, at least kReadablePixels
// Limits     says nothing about what fits the part: the rounding's own limits come on top
#pragma once

#include <algorithm>
#include <cmath>

#include "arris/scene.h"

namespace arris {

// A band of light along an edge is about as wide as its radius: below three pixels it is a line of noise.
inline constexpr double kReadablePixels = 3;
inline constexpr double kReadablePart = 0.006;

inline double readable_radius(const Camera& camera, const ImageSettings& image, Vec3d point) {
  const double depth =
      std::max(dot(point - camera.position, normalize(camera.target - camera.position)),
               1e-3 * length(point - camera.position));
  const double height = 2 * depth * std::tan(radians(camera.fov_deg) / 2);
  return height * std::max(kReadablePart, kReadablePixels / image.height_px);
}

}  // namespace arris
