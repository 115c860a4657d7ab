#include "render/stale_points.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// A light as the end of segments: blockers are as much larger as it is.
struct LightEnd {
  HomogeneousPoint at;
  double extent = 0;
};

LightEnd end_of(const ShadowLight& light) {
  if (const auto* area = std::get_if<ParallelogramLight>(&light)) {
    return {{area->corner + (area->u + area->v) * 0.5, 1},
            std::max(length(area->u + area->v), length(area->u - area->v)) / 2};
  }
  return {std::get<HomogeneousPoint>(light), 0};
}

// Whether the segment from p to the light comes within a distance of c.
bool passes_near(Vec3d p, const LightEnd& light, Vec3d c, double distance) {
  const Vec3d to_light = light.at.w > 0 ? light.at.xyz / light.at.w - p : light.at.xyz;
  const double squared = length_squared(to_light);
  double t = squared > 0 ? dot(c - p, to_light) / squared : 0;
  t = light.at.w > 0 ? std::clamp(t, 0.0, 1.0) : std::max(t, 0.0);
  return length_squared(p + to_light * t - c) < distance * distance;
}

}  // namespace

void make_shadowed_stale(std::span<const ShadowLight> lights, std::span<const Sphere> blockers,
                         PointCache& cache) {
  for (const ShadowLight& light : lights) {
    const LightEnd end = end_of(light);
    for (const Sphere& blocker : blockers) {
      const double reach = blocker.radius + end.extent;
      cache.make_stale(
          kMovedStale,
          [&](Vec3f lower, Vec3f upper) {
            const Vec3d a(lower), b(upper);
            return passes_near((a + b) * 0.5, end, blocker.center, reach + length(b - a) / 2);
          },
          [&](Vec3f p) { return passes_near(Vec3d(p), end, blocker.center, reach); });
    }
  }
}

// A light that is another one altogether makes points as stale as a move does, one that changes by 4% in every frame
// within seven frames: such points are replaced rather than have new ones put between them.
Staleness stale_by_light(double amount) {
  constexpr double kOnce = 600, kMost = 160;
  return {float(kOnce * std::clamp(amount, 0.0, 1.0)), float(kMost)};
}

void want_moved(const PixelView& view, std::span<const Sphere> moved,
                std::span<std::uint8_t> wanted) {
  static constexpr int kMost = 224;  // less than where nothing is known
  const Mat3d world_from_pixel = inverse(view.pixel_from_world);
  const Vec3d right = normalize(world_from_pixel.x), down = normalize(world_from_pixel.y);
  const auto place = [&](Vec3d p) {
    const Vec3d v = view.pixel_from_world * (p - view.eye);
    return Vec3d{v.x / v.z, v.y / v.z, v.z};
  };
  for (const Sphere& sphere : moved) {
    const Vec3d center = place(sphere.center);
    if (!(center.z > 0) || length(sphere.center - view.eye) <= sphere.radius) continue;
    // Nearly an ellipse.
    const double a = std::abs(place(sphere.center + right * sphere.radius).x - center.x);
    const double b = std::abs(place(sphere.center + down * sphere.radius).y - center.y);
    const int last_y = int(std::clamp(std::ceil(center.y + b), 0.0, double(view.height_px)));
    for (int y = int(std::clamp(center.y - b, 0.0, double(view.height_px))); y < last_y; ++y) {
      const double up = (y + 0.5 - center.y) / b;
      const double half = a * std::sqrt(std::max(0.0, 1 - up * up));
      const int first = int(std::clamp(center.x - half, 0.0, double(view.width_px)));
      const int last = int(std::clamp(std::ceil(center.x + half), 0.0, double(view.width_px)));
      std::uint8_t* const row = wanted.data() + std::size_t(y) * std::size_t(view.width_px);
      for (int x = first; x < last; ++x) {
        row[x] = std::uint8_t(std::max<int>(row[x], std::min(kMost, 2 * row[x] + 32)));
      }
    }
  }
}

}  // namespace arris
