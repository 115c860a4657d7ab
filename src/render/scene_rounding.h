// scene_rounding.h — the rounding of every object of a scene
// What       resolves each object's radius to world units and builds its Rounding beside the geometry. Baked
//            geometry is rounded in world space. Instances of one mesh by a similarity share one rounding in
//            object space, as their radius over their scale agrees; other instances get their own, in world
//            axes about the object's origin.
// Errors     Error{input} naming the object, if a radius doesn't fit
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "arris/render.h"
#include "arris/rounding.h"
#include "render/scene_fillets.h"
#include "render/scene_geometry.h"
#include "rounding/rounding_data.h"

namespace arris {

// How an instance's rounding lies in the world.
struct RoundingFrame {
  Affine3d rounding_from_world;
  Mat3d world_from_rounding_normal;
};

// What other solids have to do with the void between a sharp and a rounded edge: see void_neighbors.h.
enum class VoidNeighbors : std::uint8_t {
  none,      // all are farther from it than kVoidMargin
  touching,  // some may touch it
  inside,    // some may reach into it
};
// Relative to the size of the rounded solid.
constexpr double kVoidMargin = 5e-4;

// Rounding of one geometry, by EmbreeScene::records() index. All null: not rounded. Small: every hit reads it.
struct RoundedGeometry {
  const std::uint32_t* band_begin = nullptr;  // null also where a kd-tree detects
  const Band* bands = nullptr;
  const Rounding* rounding = nullptr;
  const RoundingFrame* frame = nullptr;  // null: world space
  // Of every arc, between its ends, then of every solid, with its corners; null: none.
  const VoidNeighbors* neighbors = nullptr;
  bool any_turned = false;  // some shell's winding points inward

  [[nodiscard]] bool is_kept(std::uint32_t triangle, float u, float v) const {
    return band_begin != nullptr && is_kept_by_bands(band_begin, bands, triangle, u, v);
  }
  // Of the void that a ray crosses: beside an arc, or kNone for anywhere in the solid's.
  [[nodiscard]] VoidNeighbors neighbors_of(std::uint32_t solid, std::uint32_t arc) const {
    if (neighbors == nullptr) return VoidNeighbors::none;
    return neighbors[arc != kNone ? arc : rounding->data().arcs.size() + solid];
  }
  [[nodiscard]] Ray local_ray(Vec3f origin, Vec3f direction) const {
    const Ray world{Vec3d(origin), Vec3d(direction)};
    if (frame == nullptr) [[likely]] {
      return world;
    }
    return {transform_point(frame->rounding_from_world, world.origin),
            transform_vector(frame->rounding_from_world, world.direction)};
  }
};

// How edges of one geometry look rounded by its shading normals: see bevel_shader.h.
struct BevelShader {
  float delta = 0;  // world units; 0: none
  float perturb = 1;
  int divisions = 3;
};

// What a geometry's rounding was made from: another place that leaves this as it is can share it.
struct RoundingSource {
  std::shared_ptr<const Rounding> rounding;  // null: not rounded
  RoundingOptions options;                   // of `rounding`
  double radius = 0;                         // in the world
  std::optional<double> scale;  // of an instance by a similarity, in object space; empty: …
  Affine3d place;               // … made for this linear part
};

// Of each solid of a geometry, or of all of it, points whose hull holds it; in the mesh's space.
using SolidPoints = std::vector<std::vector<Vec3d>>;

struct SceneRounding {
  std::optional<RoundingSettings> scene_default;
  std::vector<RoundingSource> sources;  // per geometry
  std::vector<RoundedGeometry> geometries;
  std::vector<std::shared_ptr<const Rounding>> roundings;
  std::vector<std::unique_ptr<const RoundingFrame>> frames;
  std::vector<std::vector<VoidNeighbors>> neighbors;  // per geometry; empty: none
  // What they were found from, per geometry; empty where nothing is rounded.
  std::vector<std::shared_ptr<const SolidPoints>> points;
  std::vector<std::vector<std::uint32_t>> near;  // geometries whose boxes come near its voids
  bool any = false;
  SceneFillets fillets;
  std::vector<BevelShader> shaders;  // by geometry; empty if none has one
  // What was built, for PrepareStats.
  double seconds = 0;
  std::vector<RoundingSummary> summaries;
  std::uint64_t edges = 0, corners = 0, bytes = 0;
};

struct SceneRoundingOptions {
  int threads = 0;
  Detection detection = Detection::face_index;
  const std::atomic<bool>* stop = nullptr;  // PrepareOptions::stop
};

// With `before`, of the same objects in other places: what does not change is shared, and automatic radii stay.
SceneRounding make_scene_rounding(const SceneGeometry& geometry,
                                  const std::optional<RoundingSettings>& scene_default,
                                  const SceneRoundingOptions& options,
                                  const SceneRounding* before = nullptr);

// Length of the columns if they are orthogonal and of one length.
std::optional<double> similarity_scale(const Mat3d& m);

// The most that AutoRadius takes for one object, a mesh with positions: its own, or what its scene's camera says.
double most_auto_radius(const Scene& scene, const Object& object);

// The world radius that the settings mean for one object, 0 if none. `scale` of a similarity, if the object is to be
// measured in its own space.
double resolve_radius(const Scene& scene, const Object& object, const RoundingSettings& settings,
                      std::optional<double> scale = std::nullopt);

}  // namespace arris
