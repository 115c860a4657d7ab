// path_integrator.h — the radiance of one camera ray by path tracing
// What       next-event estimation and BSDF sampling at every vertex, combined by multiple importance
//            sampling (power heuristic). At most `max_depth` scatterings; emission found after the last
//            one counts. Russian roulette by throughput.
// Guarantee  unbiased but for the depth limit and the last millionths of shadow rays; no clamping.
//            (tests/render/closed_form_test.cpp, furnace_test.cpp; the two strategies alone agree:
//            mis_test.cpp)
// Limits     transmitting surfaces block shadow rays: what light does through glass is found by BSDF
//            sampling alone. Area lights block nothing.
// Source     E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9
#pragma once

#include <cstdint>
#include <optional>

#include "arris/math.h"
#include "base/sobol.h"
#include "render/film.h"
#include "render/prepared_scene.h"

namespace arris {

// Which estimators a path combines; the single ones are for tests.
enum class Strategies { both, light_sampling, bsdf_sampling };

struct PathSettings {
  int max_depth = 8;
  Strategies strategies = Strategies::both;
  // Paths go on only where a glossy lobe, a mirror or glass has drawn the direction: diffuse surfaces show what comes
  // to them from lights and environment alone.
  bool only_glossy = false;
  // What the camera sees is shaded as if the texture of its base colour were white, where is_tinted().
  bool white_textures = false;
};

struct PathRays {
  std::uint64_t total = 0;
  std::uint64_t rounded = 0;
};

struct PathSample {
  Rgb radiance;
  Rgb painted;  // white_textures: the part of it that goes with the base colour; the rest, such as glints, does not
  FirstHit first;
};

// The sampler's first kCameraDimensions are the camera's. Adds the rays traced to `rays`.
inline constexpr std::uint32_t kCameraDimensions = 1;
PathSample trace_path(const PreparedScene& scene, const PathSettings& settings, TraceRay camera_ray,
                      Sampler sampler, PathRays& rays);

// A camera ray of which it is known what it meets, and of which someone else adds up what lights without extent
// (point, spot, directional), and perhaps area lights, send to that point directly.
struct KnownSight {
  TraceRay ray;
  std::optional<SurfaceHit> hit;   // nothing: it leaves the scene
  bool knows_area_lights = false;  // but for what mirrors and glass show of them
  int mirrors = 0;                 // it has left so many mirrors before, which counts as depth
};
PathSample trace_known_sight(const PreparedScene& scene, const PathSettings& settings,
                             const KnownSight& sight, Sampler sampler, PathRays& rays);
// The radiance along a ray that a mirror or glass sends on, after `depth` scatterings.
Rgb trace_side_ray(const PreparedScene& scene, const PathSettings& settings, const TraceRay& ray,
                   int depth, Sampler sampler, PathRays& rays);

}  // namespace arris
