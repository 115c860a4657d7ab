// bevel_shader.h — edges that look rounded by bent normals alone
// What       Below the shaded point, at depth Delta, Divisions³ rays leave in directions N + Perturb·d. The outward
//            normals where they leave the object are averaged with N: near an edge the neighbouring face's come in.
//            Geometry, silhouettes and shadows stay sharp.
// In / Out   lengths in world units, vectors in world space. Outputs as the original's: `fac`, the share of rays that
//            hit, (hits + 1) / (1 + Divisions³), and the unit `normal`.
//            A ray that finds nothing within reach counts as a miss: beside concave edges, and few that run along the
//            face where Perturb is near 1.
// Differs    The directions d are Owen-scrambled Sobol points in the cube [−1, 1]³, turned so that its z axis is N
//            (the author: the directions of Perlin noise are "rather awful", "some Halton or Sobel sequence would
//            probably be better"). Each point of the surface has its own, so that errors are noise that averages out
//            rather than bands. Only the shaded object is hit, and nothing farther than kBevelReach·Delta but the
//            shaded face itself (the author: "we could check this against some limit to reduce artifacts on
//            concave meshes").
// Guarantee  a function of the point alone: same picture at any number of threads
// Limits     what the paper shows of bevel shaders: no shrinking, sharp outlines, wrong normals on thin parts
// Cost       Divisions³ rays for every hit on such an object
// Source     M. Anders, "A bevel shader for Blender's Cycles", OSL code (2014); compared with in Courtin et al.,
//            Table 1
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arris/scene.h"
#include "render/prepared_scene.h"

namespace arris {

// Hits farther than this many Deltas belong to other parts of the object.
inline constexpr float kBevelReach = 4;

struct BevelShading {
  float fac = 1;
  Vec3f normal;
};

// hit: on an object with this shader.
BevelShading eval_bevel_shader(const PreparedScene& scene, const BevelShader& shader,
                               const SurfaceHit& hit);

// One per geometry; delta is 0 where the object has no bevel shader. Empty if none has. `before`: of the same objects
// in other places, whose automatic depths stay.
std::vector<BevelShader> make_bevel_shaders(const SceneGeometry& geometry,
                                            const std::optional<RoundingSettings>& scene_default,
                                            const SceneRounding* before = nullptr);

// Notes the shader's Fac in the hit and puts its normal in place of the hit's shading normal, bent back to where mirror
// directions leave the face.
void bend_normal(const PreparedScene& scene, const BevelShader& shader, Vec3f ray_direction,
                 SurfaceHit& hit);

}  // namespace arris
