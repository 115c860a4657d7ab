// pov_scene.h — a scene in POV-Ray's language, so that both renderers draw the same picture
// What       objects are CSG trees of spheres, boxes, cones and convex polyhedra; each leaf brings its texture, as its
//            faces show the material of their own leaf here. Intensities are such that POV-Ray's colours are
//            radiances: a diffuse finish reflects color·cos, which is (base_color / π)·irradiance for color =
//            irradiance / π, and a point light fades with the square of the distance.
// Guarantee  as single rays go, its picture is ours: bench_csg prints how far their dense pictures are apart
// Limits     diffuse or emitting materials; point and directional lights; a constant environment
// Errors     arris::Error, kind input, that names what the scene has beyond these
// Source     "POV-Ray 3.7 Documentation", sections Camera, Light Sources (fade_power), Matrix, Finish
#pragma once

#include <string>

#include "arris/scene.h"

namespace arris::bench {

// POV-Ray tries every child of one difference on every ray. cut: a box from which many solids are taken becomes 20 x 20
// boxes with those that reach into them, which shows the same and is what a user of POV-Ray would do.
enum class PovDifferences { as_they_are, cut };

std::string pov_scene(const Scene& scene, PovDifferences differences = PovDifferences::cut);

}  // namespace arris::bench
