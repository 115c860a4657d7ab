#include "render/shadow_probe.h"

#include <algorithm>
#include <limits>

namespace arris {
namespace {

// Towards the light: where to, and how far (infinite: as far as anything is).
struct Aim {
  Vec3d direction;
  float distance = std::numeric_limits<float>::infinity();
};

std::optional<Aim> aim_at(const ShadowLight& light, Vec2f place, Vec3d from) {
  if (const auto* area = std::get_if<ParallelogramLight>(&light)) {
    const Vec3d to = area->corner + area->u * double(place.x) + area->v * double(place.y) - from;
    if (dot(to, area->toward) >= 0) return std::nullopt;
    return Aim{normalize(to), float(length(to))};
  }
  const auto& point = std::get<HomogeneousPoint>(light);
  if (point.w == 0) return Aim{normalize(point.xyz)};
  const Vec3d to = point.xyz / point.w - from;
  if (!(length_squared(to) > 0)) return std::nullopt;
  return Aim{normalize(to), float(length(to))};
}

}  // namespace

std::optional<ShadowTriple> probe_shadow(const PreparedScene& scene,
                                         std::span<const ShadowLight> lights,
                                         const ShadowProbe& probe) {
  if (lights.empty()) return std::nullopt;
  const std::optional<SurfaceHit> hit = scene.intersect(probe.camera_ray);
  if (!hit) return std::nullopt;
  const auto light = std::min(std::size_t(probe.select * float(lights.size())), lights.size() - 1);
  const std::optional<Aim> aim = aim_at(lights[light], probe.place, Vec3d(hit->position));
  if (!aim) return std::nullopt;
  const Vec3f direction(aim->direction);
  // Turned away from the light on the side that is seen: there is no shadow edge for the eye.
  const bool seen_outside = hit->side == Side::outside;
  if ((dot(direction, hit->geometric_normal) > 0) != seen_outside) return std::nullopt;
  TraceRay ray = leave_surface(*hit, direction);
  ray.t_max = aim->distance;
  const std::optional<SurfaceHit> blocker = scene.intersect(ray);
  if (!blocker) return std::nullopt;
  return ShadowTriple{std::uint32_t(light), blocker->object.index, hit->object.index};
}

}  // namespace arris
