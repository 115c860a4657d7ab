// hidden_points.h — points that show through gaps between the points in front of them
// What       Points that are hidden in a new view show where no nearer point happens to be projected onto their pixel.
//            A point is taken as hidden if it lies clearly behind the surface that the samples around suggest which can
//            be reached from it: with no edge between, they are on one surface, whose inverse depths are linear in the
//            picture where it is flat. A plane is fitted to those. Or if one of those samples is clearly nearer and of
//            another object: where one object ends before another there is an edge.
// Guarantee  points of one object and plane hide none of each other, however steep the view
//            (tests/edgepoint/points_test.cpp)
// Limits     of one object needs four samples around that are not in a line; a point with fewer is kept. Where solids
//            interpenetrate, which has no edge, points of the farther one may go beside the line.
// Cost       a look at the depths around for each point; a fit where they differ
// Source     the Render Cache culls by the mean depth of 3 × 3 pixels (Walter, Drettakis, Greenberg 2002), which
//            knows no edges and takes points along silhouettes
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/depth_cells.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"

namespace arris {

// Offsets of the pixels of a band whose points are hidden. objects: by point; none: as if
// of one. pixel_size: DepthCells'.
std::vector<std::uint32_t> find_hidden_points(const EdgePointImage& image,
                                              const PointObjects& objects, const DepthCells& cells,
                                              RowBand band, float pixel_size);

// Takes away the points of these pixels.
void remove_points(std::span<const std::uint32_t> pixels, EdgePointImage& image);

}  // namespace arris
