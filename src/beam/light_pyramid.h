// light_pyramid.h — the beam from a light to the patch that a uniform region shows
// What       The paper's light beam (§2.2): the light is its apex, or its rays are parallel; its edges pass the four
//            points A, B, C and D where the region's corner rays meet the surface; and it ends at a base:
//            flat     the surface itself
//            convex   the plane of three of the points, with the fourth and the light on one side of it
//            concave  the plane that touches the surface at E, where the light's middle ray meets it
//            Convex and concave are as the eye sees the surface: from outside of its leaf, or from inside.
// Guarantee  holds all of a flat patch. Curved ones may bulge out of the sides: see docs/beam.md
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §2.2
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "beam/separation.h"

namespace arris {

enum class PatchForm : std::uint8_t { flat, convex, concave };

// In the world.
struct HitPatch {
  SeenSurface seen;
  PatchForm form = PatchForm::flat;
  std::array<Vec3d, 4> corners;  // A, B, C, D
  std::array<Vec3d, 4> normals;  // towards the eye, any length
};

// Precondition: the surface is not whole (beam_shape.h).
HitPatch make_patch(const BeamSolid& solid, const SeenSurface& seen,
                    const std::array<Vec3d, 4>& corners, Vec3d eye);

// To the light itself, or as far as the length of a directional light's direction.
Vec3d to_light(const LightPlace& light, Vec3d from);

// Nothing: rounding leaves no base.
std::optional<Pyramid> make_light_pyramid(const BeamSolid& solid, const HitPatch& patch,
                                          const LightPlace& light);

// Can light that leaves the patch on the eye's side not meet the leaf again? Precondition: it is of the patch's solid.
bool is_behind(const BeamSolid& solid, std::uint32_t leaf, const HitPatch& patch);

}  // namespace arris
