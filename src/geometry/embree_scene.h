// embree_scene.h — the scene's triangles in one Embree scene
// What       meshes used by one object, and small copies, are baked to world space: one flat BVH, the
//            fastest to trace. Objects that share a big mesh become instances of one BVH. Besides, one
//            record per geometry with what a hit is evaluated from. Movable scenes have every mesh as an instance,
//            and boxes in structures of their own, so that a moved scene shares what has not changed.
// Guarantee  robust traversal: no ray passes between two triangles that share an edge
//            (tests/render/trace_test.cpp). One aimed at the very vertex may: up to 3 in 1,000 of those do.
// Limits     float coordinates: a scene far from its origin loses precision in proportion
// Errors     Error::failed when memory runs out
// Cost       build linear in the triangles (times log), parallel; const afterwards
// Embree     its headers are included by embree_scene.cpp and render/embree_hit.h and render/csg_objects.cpp,
//            nowhere else
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"

struct RTCSceneTy;
struct RTCIntersectFunctionNArguments;
struct RTCOccludedFunctionNArguments;

namespace arris {

struct Mat3f {
  Vec3f x, y, z;  // columns
};
inline Vec3f operator*(const Mat3f& m, Vec3f v) {
  return m.x * v.x + m.y * v.y + m.z * v.z;
}

// What a hit on one geometry is evaluated from. Pointers go into the scene's meshes or the baked copy.
struct GeometryRecord {
  const Triangle* triangles = nullptr;  // null: no mesh
  const Vec3f* positions = nullptr;     // world space if baked, object space if instanced
  const Vec3f* normals = nullptr;       // object space; null: flat
  const Vec2f* uvs = nullptr;
  const MaterialId* triangle_materials = nullptr;  // null: `material`
  ObjectId object;
  MeshId mesh;
  MaterialId material;
  std::uint32_t triangle_count = 0;
  bool instanced = false;
  float orientation = 1;  // -1: the transform mirrors, so winding turns round
  float position_error =
      0;  // world units: how far a computed point may be from its triangle's plane
  Mat3f normal_from_object;  // inverse transpose, for shading normals; not unit length
};

struct Box3f {
  Vec3f lower, upper;
};

// A geometry of boxes: rays that may meet one are handed to the callbacks, whose geometryUserPtr is the
// BoxGeometry: in `user` they find what is in the box. Its record has no triangles.
struct BoxGeometry {
  ObjectId object;
  std::vector<Box3f> boxes;  // world space
  const void* user = nullptr;
  void (*intersect)(const RTCIntersectFunctionNArguments*) = nullptr;
  void (*occluded)(const RTCOccludedFunctionNArguments*) = nullptr;
};

struct EmbreeSceneOptions {
  int threads = 0;  // 0: all
  // Baking shared meshes may add this many triangles; the biggest savings are instanced beyond.
  std::uint64_t max_copied_triangles = 2'000'000;
  Placement placement = Placement::baked;
  const std::atomic<bool>* stop = nullptr;  // PrepareOptions::stop, for what is built besides
};

class EmbreeScene {
 public:
  // Shares the scene's meshes. Objects that are no meshes come as boxes.
  explicit EmbreeScene(const Scene& scene, const EmbreeSceneOptions& options = {},
                       std::vector<BoxGeometry> boxes = {});
  // The same meshes and numbers of geometries, objects in other places. `boxes` as before; those without value are
  // where they were. Precondition: `before` is movable.
  EmbreeScene(const EmbreeScene& before, const Scene& moved,
              std::vector<std::optional<BoxGeometry>> boxes);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  [[nodiscard]] RTCSceneTy* handle() const { return top_.get(); }
  [[nodiscard]] Placement placement() const { return placement_; }
  // Index: what GeometryRecord an Embree hit belongs to, see render/trace.cpp.
  [[nodiscard]] const std::vector<GeometryRecord>& records() const { return records_; }
  // The index of records() of each of the boxes given.
  [[nodiscard]] const std::vector<std::uint32_t>& box_records() const { return box_records_; }
  // BVH and baked copies; of all scenes that share some of them.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  class Device;
  struct Boxes;
  using SceneHandle = std::shared_ptr<RTCSceneTy>;
  // What instances need to know of a mesh: its box and largest coordinate.
  struct Extent {
    Vec3d low, high;
  };

  void attach_meshes(const Scene& scene);
  void attach_boxes(const Scene& scene);
  void add_record(unsigned id, const GeometryRecord& record);
  void make_mesh_scene(const Scene& scene, std::uint32_t mesh);

  std::shared_ptr<Device> device_;
  SharedVector<Mesh> meshes_;  // records and structures point into them
  Placement placement_ = Placement::baked;
  std::vector<bool> instanced_;           // per mesh
  std::vector<SceneHandle> mesh_scenes_;  // per mesh; null where it is not instanced
  std::vector<Extent> extents_;           // of the same
  std::vector<std::shared_ptr<Boxes>> boxes_;
  SceneHandle top_;
  std::vector<GeometryRecord> records_;
  std::vector<std::uint32_t> box_records_;
};

}  // namespace arris
