// stale_points.h — which cached points a move has made wrong
// What       When an object moves, its own points move with it; and points between which and a light it stood before
//            or stands now have another shade. Those are made old, so that they are asked for first.
// Limits     an object's shadow is that of its bounding sphere. Light that goes from surface to surface is not
//            looked at: those points are renewed by their age.
#pragma once

#include <span>

#include "edgepoint/point_cache.h"
#include "render/shadow_finder.h"

namespace arris {

void make_shadowed_old(std::span<const ShadowLight> lights, std::span<const Sphere> blockers,
                       std::uint32_t frame, PointCache& cache);

}  // namespace arris
