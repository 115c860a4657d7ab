// prepared_scene.h — the scene, built once and then const: what all renderers read
// What       the described scene with its camera and environment filled in, its acceleration structure
//            and lights; and the two ray functions, which are the only way renderers meet geometry
// Guarantee  const after prepare_scene(): every function is safe from any number of threads.
//            No ray passes between two triangles that share an edge (see embree_scene.h).
// Limits     float coordinates, in proportion to their size
// Frames     everything here is in world space
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "arris/render.h"
#include "arris/rounding.h"
#include "arris/scene.h"
#include "geometry/embree_scene.h"
#include "render/scene_rounding.h"

namespace arris {

inline constexpr std::uint32_t kNoGeometry = ~std::uint32_t{0};

enum class Side : std::uint8_t { none, outside, inside };

// Which surface a ray starts on, and towards which side of it it leaves. Rounding needs to know: a ray
// that leaves a rounded edge outward starts inside the mesh.
struct Departure {
  std::uint32_t geometry =
      kNoGeometry;  // index into EmbreeScene::records(); kNoGeometry: free space
  std::uint32_t triangle = 0;
  Side side = Side::none;
  Feature feature = Feature::face;
  std::uint32_t crossed = kNone;  // RoundedHit's
};

struct TraceRay {
  Vec3f origin;
  Vec3f direction;  // unit
  float t_min = 0;
  float t_max = std::numeric_limits<float>::infinity();
  Departure from;
};

struct SurfaceHit {
  float t = 0;
  float position_error = 0;  // GeometryRecord's
  Vec3f position;            // on the triangle to within GeometryRecord::position_error
  Vec3f geometric_normal;    // unit, outward (by winding)
  Vec3f shading_normal;      // unit, on the geometric normal's side
  Vec2f uv;                  // 0 where the mesh has none
  float u = 0, v = 0;        // barycentric weights of the second and third vertex
  std::uint32_t geometry = kNoGeometry;
  std::uint32_t triangle = 0;  // of a CSG solid: the cell
  MaterialId material;
  ObjectId object;
  Side side = Side::outside;  // where the ray came from
  Feature feature = Feature::face;
  std::uint32_t crossed = kNone;  // RoundedHit's
  bool rounding_seen = false;  // the ray met a rounded edge or corner: there, or passing one before
  float bevel_fac = 0;         // the bevel shader's Fac; 0 without that shader
};

// A hit on one object alone.
struct ObjectHit {
  float t = 0;
  std::uint32_t triangle = 0;
  Vec3f geometric_normal;  // unit, outward (by winding)
  Vec3f shading_normal;    // unit, on the geometric normal's side
};

class PreparedScene {
 public:
  PreparedScene(std::shared_ptr<const SceneGeometry> geometry, SceneRounding rounding);
  PreparedScene(std::shared_ptr<const SceneGeometry> geometry,
                std::shared_ptr<const SceneRounding> rounding);
  ~PreparedScene();

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] const SceneGeometry& geometry() const { return *geometry_; }
  [[nodiscard]] std::shared_ptr<const SceneGeometry> shared_geometry() const { return geometry_; }
  [[nodiscard]] const SceneRounding& rounding() const { return rounding_; }
  [[nodiscard]] std::shared_ptr<const SceneRounding> shared_rounding() const {
    return shared_rounding_;
  }
  [[nodiscard]] const PrepareStats& stats() const { return stats_; }

  // The closest surface in (t_min, t_max).
  [[nodiscard]] std::optional<SurfaceHit> intersect(const TraceRay& ray) const;
  // The closest triangle of one geometry in (t_min, t_max), whatever else is there, and not rounded.
  [[nodiscard]] std::optional<ObjectHit> intersect_object(const TraceRay& ray,
                                                          std::uint32_t geometry) const;
  // The share of light that passes (t_min, t_max): 0 behind an opaque surface, else the product of what
  // translucent ones let through.
  [[nodiscard]] float transmittance(const TraceRay& ray) const;
  [[nodiscard]] bool occluded(const TraceRay& ray) const { return transmittance(ray) <= 0; }

 private:
  std::shared_ptr<const SceneGeometry> geometry_;
  std::shared_ptr<const SceneRounding> shared_rounding_;
  const SceneRounding& rounding_;
  PrepareStats stats_;
};

// The ray that leaves a hit in a direction: it starts off the surface by what rounding errors need.
inline TraceRay leave_surface(const SurfaceHit& hit, Vec3f direction) {
  const bool outward = dot(direction, hit.geometric_normal) > 0;
  TraceRay ray;
  ray.origin =
      hit.position + hit.geometric_normal * (outward ? hit.position_error : -hit.position_error);
  ray.direction = direction;
  // A CSG solid's surfaces are exact: off by position_error is off.
  if (hit.feature != Feature::csg) {
    ray.from = {hit.geometry, hit.triangle, outward ? Side::outside : Side::inside, hit.feature,
                hit.crossed};
  }
  return ray;
}

}  // namespace arris
