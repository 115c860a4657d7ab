// placement.h — transforms and rectangles from the numbers that scene files and keys have
#pragma once

#include "arris/scene.h"

namespace arris {

// Scales, then turns about the world's x, y and z, then moves.
Affine3d make_placement(Vec3d translate, Vec3d rotate_deg, Vec3d scale);

// The light as a key has it. Rectangles face away from the key's position about it; their height, size.y, goes along
// `up` as far as it can.
void move_light(Light& light, const LightTrack& track, const LightKey& key);

}  // namespace arris
