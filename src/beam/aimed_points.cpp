#include "beam/aimed_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "csg/leaf_crossings.h"

namespace arris {
namespace {

constexpr int kRingPoints = 8;

// In the solid's space.
std::vector<Vec3d> inner_points(const BeamShape& shape, std::uint32_t leaf) {
  if (const Facet* facet = shape.facet(leaf)) {
    Vec3d sum;  // each corner twice
    for (const std::uint32_t edge : facet->edges)
      sum += shape.edges()[edge].a + shape.edges()[edge].b;
    return {sum / 6.0};
  }
  if (shape.volume(leaf) != nullptr) return {};
  if (const auto* torus = std::get_if<TorusLeaf>(&shape.csg().leaf(leaf).shape)) {
    const Affine3d object_from_primitive = inverse(torus->primitive_from_object);
    std::vector<Vec3d> ring;
    for (int i = 0; i < kRingPoints; ++i) {
      const double angle = 2 * kPi * i / kRingPoints;
      ring.push_back(transform_point(
          object_from_primitive,
          {torus->ring_radius * std::cos(angle), torus->ring_radius * std::sin(angle), 0}));
    }
    return ring;
  }
  const Box3d& box = shape.leaf_box(leaf);
  if (!is_finite(box.low) || !is_finite(box.high)) return {};
  return {(box.low + box.high) * 0.5};
}

}  // namespace

std::vector<Vec2d> aimed_points(const EyeRays& eye, const BeamSolid& solid, std::uint32_t leaf) {
  const Affine3d world_from_object = inverse(solid.object_from_world);
  const Vec3d view = cross(eye.step_x, eye.step_y);
  std::vector<Vec2d> points;
  for (const Vec3d& point : inner_points(*solid.shape, leaf)) {
    const Vec3d to = transform_point(world_from_object, point) - eye.position;
    const double depth = dot(view, to) / dot(view, eye.corner);
    if (!(depth > 0)) continue;
    const Vec3d in_plane = to / depth - eye.corner;  // x step_x + y step_y
    points.push_back({dot(cross(in_plane, eye.step_y), view) / dot(view, view),
                      dot(cross(eye.step_x, in_plane), view) / dot(view, view)});
  }
  return points;
}

namespace {

// Where a ray enters a leaf or leaves it, in lengths of its direction. Nothing: it misses the leaf.
std::optional<double> depth_at(const BeamSolid& solid, std::uint32_t leaf, bool entering,
                               const Ray& world) {
  thread_local LeafCrossings finder;
  const Ray ray{transform_point(solid.object_from_world, world.origin),
                transform_vector(solid.object_from_world, world.direction)};
  const CsgSolid& csg = solid.shape->csg();
  const auto& crossings = finder.find(csg.leaf(leaf), csg.surfaces(), ray);
  if (crossings.size() < 2) return std::nullopt;
  const double depth = entering ? crossings.front().t : crossings.back().t;
  return std::isfinite(depth) ? std::optional(depth) : std::nullopt;
}

// The next step to where `value` is stationary, by its differences over `step` around the point.
template <class Value>
std::optional<Vec2d> newton_step(const Value& value, Vec2d at, double step) {
  std::array<double, 9> v{};
  for (int i = 0; i < 9; ++i) {
    const std::optional<double> found =
        value(Vec2d{at.x + (i % 3 - 1) * step, at.y + (i / 3 - 1) * step});
    if (!found) return std::nullopt;
    v[std::size_t(i)] = *found;
  }
  const double gx = (v[5] - v[3]) / 2, gy = (v[7] - v[1]) / 2;
  const double hxx = v[5] - 2 * v[4] + v[3], hyy = v[7] - 2 * v[4] + v[1];
  const double hxy = (v[8] - v[6] - v[2] + v[0]) / 4;
  const double determinant = hxx * hyy - hxy * hxy;
  const Vec2d next{at.x + step * (hxy * gy - hyy * gx) / determinant,
                   at.y + step * (hxy * gx - hxx * gy) / determinant};
  return std::isfinite(next.x) && std::isfinite(next.y) ? std::optional(next) : std::nullopt;
}

}  // namespace

std::vector<Vec2d> points_of_contact(std::span<const BeamSolid> solids, const EyeRays& eye,
                                     const std::array<LeafPlace, 2>& leaves, const Rect& start) {
  constexpr int kSteps = 3;
  std::vector<Vec2d> points;
  for (const LeafPlace& leaf : leaves) {
    if (solids[leaf.solid].shape->convex(leaf.leaf) == nullptr) return points;
  }
  for (int ends = 0; ends < 4; ++ends) {
    const auto distance = [&](Vec2d at) -> std::optional<double> {
      const Ray ray = ray_through(eye, at);
      const auto a = depth_at(solids[leaves[0].solid], leaves[0].leaf, (ends & 1) != 0, ray);
      if (!a) return a;
      const auto b = depth_at(solids[leaves[1].solid], leaves[1].leaf, (ends & 2) != 0, ray);
      return b ? std::optional(*a - *b) : b;
    };
    std::optional<Vec2d> at = Vec2d{start.middle_x(), start.middle_y()};
    for (int i = 0; i < kSteps && at; ++i) at = newton_step(distance, *at, start.width());
    if (at) points.push_back(*at);
  }
  return points;
}

Rect part_in_window(const BeamView& view, LeafPlace place, const Rect& rect) {
  const LeafWindow window = view.window(place.solid, place.leaf);
  if (!window.meets(rect)) return {rect.x0, rect.y0, rect.x0, rect.y0};
  return {std::max(rect.x0, window.x0), std::max(rect.y0, window.y0), std::min(rect.x1, window.x1),
          std::min(rect.y1, window.y1)};
}

}  // namespace arris
