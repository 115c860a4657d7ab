// staging.h — makes a picture of a bare model: ground, light, material, camera, rounding
// What       stage_model() adds to a scene what its file does not say, so that a render of it is a picture
//            to show. What the file says stays, unless an option asks for something else.
// Guarantee  afterwards the scene has a camera and an environment, and `ground` is the one that it has; the
//            model's geometry is unchanged
// Source     the ground fades out through its opacity, so that no edge shows against the backdrop
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arris/scene.h"

namespace arris {

enum class Lighting { studio, sky, white };

// What replaces the file's camera, or the framed view, piece by piece.
struct CameraOptions {
  std::optional<Vec3d> position, target;
  std::optional<Vec3d> up;  // without a camera in the file also the scene's: the ground lies below
  std::optional<double> fov_deg;
};

struct StageOptions {
  // A model is staged as described; a scene file only where an option says so.
  enum class Source { model, scene_file } source = Source::model;
  std::optional<Lighting> lighting;  // replaces the file's lights; empty: studio, if it has none
  std::optional<bool> ground;  // empty: where the file says so, and for models without a camera
  bool rounded = true;         // models get the automatic radius
  std::optional<Material> material;  // replaces every material
  CameraOptions camera;
};

struct StagingReport {
  std::uint64_t ground_triangles = 0;  // of all that the scene has now
  // Why there is no room for the camera or the ground that the model gets, with a remedy; empty: there is.
  std::string problem;
};

StagingReport stage_model(Scene& scene, const StageOptions& options);

// Environment of a lighting, for the scene's up direction.
Environment make_environment(Lighting lighting, Vec3d up);

}  // namespace arris
