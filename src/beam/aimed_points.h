// aimed_points.h — where in the picture a ray may meet a leaf
// What       For rays at what bounds have found and chance has not met: pictures of points that are inside the leaf
//            (a torus's ring, a facet's centroid, the middle of a box), and the part of a rectangle that it may fill.
//            Where two surfaces change their order, as where a solid just pokes through another or two have a sliver in
//            common, their distance along the rays has an extremum.
// Limits     The middle of a leaf's box may be outside of the leaf, and of what operations leave of it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "beam/beam_view.h"
#include "beam/leaf_span.h"

namespace arris {

// Pictures of points of the leaf, as far as they are before the eye. Few.
std::vector<Vec2d> aimed_points(const EyeRays& eye, const BeamSolid& solid, std::uint32_t leaf);

// Where the distance of two convex leaves' ends along a ray is stationary, of each end to each; looked for from the
// rectangle's middle, by steps that end nowhere if the rays there miss one of them.
std::vector<Vec2d> points_of_contact(std::span<const BeamSolid> solids, const EyeRays& eye,
                                     const std::array<LeafPlace, 2>& leaves, const Rect& start);

// The part of the rectangle in which the leaf may be met; empty, with no area, if there is none.
Rect part_in_window(const BeamView& view, LeafPlace place, const Rect& rect);

}  // namespace arris
