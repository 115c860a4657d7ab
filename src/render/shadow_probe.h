// shadow_probe.h — what stands between a point and a light
// What       a ray from a point that the camera sees to a place on a light: who blocks it makes a triple
// Source     Bala, Walter, Greenberg (2003), §6.5, "Finding light-blocker-receiver triples"
#pragma once

#include <optional>

#include "render/camera.h"
#include "render/prepared_scene.h"
#include "render/shadow_finder.h"

namespace arris {

struct ShadowProbe {
  TraceRay camera_ray;
  float select = 0;  // which light, 0 to 1
  Vec2f place;       // of an area light
};

// lights: shadow_lights() of the scene.
std::optional<ShadowTriple> probe_shadow(const PreparedScene& scene,
                                         std::span<const ShadowLight> lights,
                                         const ShadowProbe& probe);

}  // namespace arris
