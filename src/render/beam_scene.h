// beam_scene.h — a prepared scene as beams read it
// What       CSG solids with their leaves cut into convex ones, meshes as facets; and the hit where the ray through a
//            picture point meets a surface of these.
// Guarantee  the surface that a beam has found has a hit also where a ray through the same point of the picture would
//            miss it by a rounding error
// Limits     meshes are sharp here
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "beam/beam_shape.h"
#include "beam/beam_view.h"
#include "beam/region_look.h"
#include "render/prepared_scene.h"

namespace arris {

class BeamScene {
 public:
  // Keeps a reference to `scene`, and `eye`.
  BeamScene(const PreparedScene& scene, const EyeRays& eye);

  [[nodiscard]] const PreparedScene& scene() const { return scene_; }
  [[nodiscard]] const EyeRays& eye() const { return eye_; }
  [[nodiscard]] std::span<const BeamSolid> solids() const { return solids_; }

  // Where the ray meets the surface's plane or quadric; of a surface seen as a whole where it comes to light
  // first.
  [[nodiscard]] SurfaceHit hit_at(const SeenSurface& seen, const Ray& world) const;
  [[nodiscard]] MaterialId material_of(const SeenSurface& seen) const;
  // A mesh with normals of its own, which turn where it is flat.
  [[nodiscard]] bool is_smooth_mesh(const SeenSurface& seen) const;
  // Its shading varies from point to point.
  [[nodiscard]] bool is_curved(const SeenSurface& seen) const;

 private:
  void add_csg();
  void add_meshes();
  [[nodiscard]] SurfaceHit csg_hit(const SeenSurface& seen, const Ray& world) const;
  [[nodiscard]] SurfaceHit mesh_hit(const SeenSurface& seen, const Ray& world) const;

  const PreparedScene& scene_;
  EyeRays eye_;
  std::vector<std::unique_ptr<const BeamShape>> trees_;  // by tree; null: of no object
  std::vector<std::unique_ptr<const BeamShape>> meshes_;
  std::vector<BeamSolid> solids_;
  std::vector<const CsgObject*> objects_;  // by solid; null: a mesh
  std::vector<std::uint32_t> records_;     // by solid, of EmbreeScene::records()
};

}  // namespace arris
