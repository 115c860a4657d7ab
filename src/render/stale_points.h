// stale_points.h — which cached points a change has made wrong, and how wrong
// What       When an object moves, its own points move with it; and points between which and a light it stood before
//            or stands now have another shade. Those are made stale, so that they are asked for first. When lights
//            change, all points are: a little by a small change, and the more the more changes they have seen.
// Limits     an object's shadow is that of its bounding sphere. Light that goes from surface to surface is not
//            looked at: those points are renewed by their age. What part of the light a lamp gives is not looked at.
#pragma once

#include <cstdint>
#include <span>

#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"
#include "render/shadow_finder.h"

namespace arris {

void make_shadowed_stale(std::span<const ShadowLight> lights, std::span<const Sphere> blockers,
                         PointCache& cache);
// amount: LightChanges'.
Staleness stale_by_light(double amount);

// What pixels want that show where objects were and are: more than elsewhere, as what has come into view there may have
// no points, and what lies behind may show instead.
void want_moved(const PixelView& view, std::span<const Sphere> moved,
                std::span<std::uint8_t> wanted);

}  // namespace arris
