#include "render/stale_points.h"

#include <algorithm>

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

void make_shadowed_old(std::span<const ShadowLight> lights, std::span<const Sphere> blockers,
                       std::uint32_t frame, PointCache& cache) {
  for (const ShadowLight& light : lights) {
    const LightEnd end = end_of(light);
    for (const Sphere& blocker : blockers) {
      const double reach = blocker.radius + end.extent;
      cache.make_old(
          frame,
          [&](Vec3f lower, Vec3f upper) {
            const Vec3d a(lower), b(upper);
            return passes_near((a + b) * 0.5, end, blocker.center, reach + length(b - a) / 2);
          },
          [&](Vec3f p) { return passes_near(Vec3d(p), end, blocker.center, reach); });
    }
  }
}

}  // namespace arris
