#include "render/scene_fillets.h"

#include <cmath>
#include <utility>

#include "render/prepared_scene.h"

namespace arris {
namespace {

Box transformed_box(const Rounding::FilletBox& box, const Affine3d& m, std::uint32_t item) {
  Box out{Vec3d(INFINITY), Vec3d(-INFINITY), item};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = transform_point(
        m, {(corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
            (corner & 4) != 0 ? box.high.z : box.low.z});
    out.low = min(out.low, p);
    out.high = max(out.high, p);
  }
  return out;
}

RayStart start_of(const RoundedGeometry& g, const TraceRay& ray, std::uint32_t geometry,
                  std::uint32_t triangle) {
  const bool is_own = ray.from.geometry == geometry &&
                      g.rounding->solid_of(ray.from.triangle) == g.rounding->solid_of(triangle);
  if (!is_own || ray.from.side == Side::none) return RayStart::unknown;
  return ray.from.side == Side::outside ? RayStart::outside : RayStart::inside;
}

}  // namespace

SceneFillets::SceneFillets(std::span<const RoundedGeometry> geometries) : tree_({}) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < geometries.size(); ++i) {
    const RoundedGeometry& g = geometries[i];
    if (g.rounding == nullptr) continue;
    const auto of_mesh = g.rounding->fillet_boxes();
    if (of_mesh.empty()) continue;
    const Affine3d world = g.frame == nullptr ? Affine3d{} : inverse(g.frame->rounding_from_world);
    for (std::uint32_t k = 0; k < of_mesh.size(); ++k) {
      boxes.push_back(transformed_box(of_mesh[k], world, std::uint32_t(places_.size())));
      places_.push_back({i, k});
    }
  }
  tree_ = BoxTree(std::move(boxes));
}

std::optional<SceneFillets::Met> SceneFillets::meet(std::span<const RoundedGeometry> geometries,
                                                    const TraceRay& ray, double t_max) const {
  std::optional<Met> met;
  double end = t_max;
  tree_.for_each_along(
      Vec3d(ray.origin), Vec3d(ray.direction), ray.t_min, end, [&](std::uint32_t i) {
        const Place& place = places_[i];
        const RoundedGeometry& g = geometries[place.geometry];
        const std::uint32_t triangle = g.rounding->fillet_boxes()[place.box].triangle;
        const auto hit =
            g.rounding->meet_fillet(place.box, g.local_ray(ray.origin, ray.direction), ray.t_min,
                                    end, start_of(g, ray, place.geometry, triangle));
        if (!hit) return;
        end = hit->t;
        met = Met{place.geometry, triangle, *hit};
        if (g.frame == nullptr) return;
        met->hit.normal = normalize(g.frame->world_from_rounding_normal * hit->normal);
      });
  return met;
}

}  // namespace arris
