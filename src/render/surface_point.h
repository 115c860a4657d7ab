// surface_point.h — a hit with its material: what scattering needs
#pragma once

#include <optional>

#include "arris/math.h"
#include "base/frame.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "shading/bsdf.h"

namespace arris {

// The shading frame on the side the ray came from: z = shading normal, bent by a normal texture if there
// is one.
Frame shading_frame(const PreparedScene& scene, const SurfaceHit& hit,
                    const SurfaceMaterial& material);

// The material at a hit: the prepared factors themselves, or evaluated into `storage` where textured.
inline const SurfaceMaterial& material_at(const PreparedScene& scene, const SurfaceHit& hit,
                                          std::optional<SurfaceMaterial>& storage) {
  const SceneGeometry& geometry = scene.geometry();
  const PreparedMaterial& prepared = geometry.materials[hit.material.index];
  if (!prepared.textured) [[likely]] {
    return prepared.factors;
  }
  return storage.emplace(
      eval_material(geometry.scene.materials[hit.material.index], geometry.scene.textures, hit.uv));
}

// Radiance of the point of an emissive triangle that light sampling drew.
Rgb sampled_emission(const SceneGeometry& geometry, const LightSample& light);

}  // namespace arris
