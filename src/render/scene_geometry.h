// scene_geometry.h — the part of a prepared scene that a change of radius leaves alone
#pragma once

#include "arris/scene.h"
#include "geometry/embree_scene.h"

namespace arris {

struct SceneGeometry {
  Scene scene;  // camera and environment filled in
  EmbreeScene embree;
  double build_seconds = 0;

  SceneGeometry(Scene described, const EmbreeSceneOptions& options)
      : scene(std::move(described)), embree(scene, options) {}
};

}  // namespace arris
