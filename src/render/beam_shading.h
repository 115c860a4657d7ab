// beam_shading.h — the light that a surface of a beam pixel sends to the camera
// What       make_sight() finds the point of a given surface in the picture, whatever else is in the way;
//            direct_light() adds up what point, spot and directional lights do there, by the same materials as the path
//            tracer's. What other lights and further bounces do the path tracer finds from that point on.
#pragma once

#include <cstdint>
#include <vector>

#include "beam/beam_tracer.h"
#include "render/beam_scene.h"
#include "render/path_integrator.h"

namespace arris {

// A light without extent, or one of the points that stand for an area light.
struct BeamLight {
  Emitter emitter;
  Vec3f position{};  // of an area light's point
  float share = 1;   // of its area
};
// In this order in the bits of PixelSurface::lit. Area lights are `light_beams` points a side, or left out if 0.
std::vector<BeamLight> make_beam_lights(const LightSet& lights, int light_beams);
// Where shadows are to be looked for from.
LightPlace place_of(const LightSet& lights, const BeamLight& light);

// What glass on the way to a surface reflects, which nothing else shows.
struct SideRay {
  TraceRay ray;
  Rgb throughput;
  int depth = 0;  // scatterings before
};

// By way of the surface's mirrors and glass.
struct MirroredSight {
  KnownSight sight;
  Rgb throughput{1, 1, 1};  // of the mirrors
  std::vector<SideRay> side_rays;
};
MirroredSight make_sight(const BeamScene& scene, const PixelSurface& surface, Vec2d at);

// Does the surface nothing but reflect like a mirror, or reflect and refract like clear glass?
Optics optics_of(const BeamScene& scene, const SeenSurface& seen);

Rgb direct_light(const PreparedScene& scene, const std::vector<BeamLight>& lights,
                 const KnownSight& sight, const PixelSurface& surface, PathRays& rays);

}  // namespace arris
