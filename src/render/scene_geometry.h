// scene_geometry.h — the part of a prepared scene that a change of radius leaves alone
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "arris/scene.h"
#include "geometry/embree_scene.h"
#include "render/csg_objects.h"
#include "render/meshed_bevels.h"
#include "scene/scene_bounds.h"
#include "shading/lights.h"
#include "shading/surface_material.h"

namespace arris {

inline constexpr std::uint32_t kNoEmitter = ~std::uint32_t{0};

// A material as the renderers meet it.
struct PreparedMaterial {
  SurfaceMaterial factors;  // all there is to it unless textured
  bool textured = false;
  bool emissive = false;
  bool translucent = false;  // opacity may be below 1
};

// Emissive triangles by number, as make_light_set() was given them.
struct EmitterIndex {
  // Per geometry: where its triangles start in `emitter_of_triangle`; kNoEmitter: it has none.
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> emitter_of_triangle;
  struct Place {
    std::uint32_t geometry, triangle;
  };
  std::vector<Place> places;  // per emitter
};

// What rays meet. Scenes that differ in camera and lights share it.
struct PlacedGeometry {
  CsgObjects csg;  // its boxes are in `embree`
  EmbreeScene embree;
  std::vector<Bounds> bounds;  // of every object, in the world

  // solids: of a scene that may have the same; null: none.
  PlacedGeometry(const Scene& scene, const EmbreeSceneOptions& options,
                 const CsgSource* solids = nullptr);
  // Objects in other places. Precondition: `before` is movable.
  PlacedGeometry(const PlacedGeometry& before, const Scene& scene_before, const Scene& moved);
};

struct SceneGeometry {
  Scene scene;          // camera and environment filled in, meshed bevels in their place
  MeshedBevels meshed;  // what they are
  std::shared_ptr<const PlacedGeometry> placed;
  const CsgObjects& csg;  // of `placed`, as is the next
  const EmbreeScene& embree;
  std::vector<PreparedMaterial> materials;
  EmitterIndex emitter_index;
  LightSet lights;
  bool any_translucent = false;
  double build_seconds = 0;

  // Precondition: a valid scene with camera and environment.
  SceneGeometry(Scene described, const EmbreeSceneOptions& options,
                const CsgSource* solids = nullptr);
  // The same materials and environment, other camera, transforms and lights.
  SceneGeometry(const SceneGeometry& before, Scene moved,
                std::shared_ptr<const PlacedGeometry> moved_placed);
  SceneGeometry(const SceneGeometry&) = delete;
  SceneGeometry& operator=(const SceneGeometry&) = delete;
};

inline MaterialId material_of(const GeometryRecord& record, std::uint32_t triangle) {
  return record.triangle_materials == nullptr ? record.material
                                              : record.triangle_materials[triangle];
}

// World-space corners of a triangle, in the mesh's order.
struct WorldTriangle {
  Vec3f p0, p1, p2;
};
WorldTriangle instanced_triangle(const Scene& scene, const GeometryRecord& record,
                                 std::uint32_t triangle);
inline WorldTriangle world_triangle(const Scene& scene, const GeometryRecord& record,
                                    std::uint32_t triangle) {
  if (record.instanced) [[unlikely]] {
    return instanced_triangle(scene, record, triangle);
  }
  const Triangle& t = record.triangles[triangle];
  return {record.positions[t[0]], record.positions[t[1]], record.positions[t[2]]};
}

}  // namespace arris
