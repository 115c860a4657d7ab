// staging.h — makes a picture of a bare model: ground, light, material, camera, rounding
// What       stage_model() adds to a scene what its file does not say, so that a render of it is a picture
//            to show. What the file says stays, unless an option asks for something else.
// Guarantee  the scene has a camera and an environment afterwards; the model's geometry is unchanged
// Source     the ground fades out through its opacity, so that no edge shows against the backdrop
#pragma once

#include <cstdint>
#include <optional>

#include "arris/scene.h"

namespace arris {

enum class Lighting { studio, sky, white };

struct StageOptions {
  std::optional<Lighting>
      lighting;                // replaces the file's lights; empty: studio, if the file has none
  std::optional<bool> ground;  // empty: unless the file has a camera of its own
  std::optional<Material> material;  // replaces every material
  bool automatic_rounding = true;    // where the file does not say how to round
};

struct StagingReport {
  std::uint64_t ground_triangles = 0;  // of all that the scene has now
};

StagingReport stage_model(Scene& scene, const StageOptions& options);

// Environment of a lighting, for the scene's up direction.
Environment make_environment(Lighting lighting, Vec3d up);

}  // namespace arris
