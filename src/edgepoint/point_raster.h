// point_raster.h — cached points onto the pixels of a new view
// What       projects the points of the cache and keeps the nearest of each pixel, with the quarter of the pixel
//            that it lies in
// Guarantee  the same points at any number of bands: the nearest wins, of equal ones the lower number
// Cost       linear in the points; a block outside of a band costs its eight corners
// Source     Bala, Walter, Greenberg (2003), §4.3
#pragma once

#include <span>

#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"

namespace arris {

// Clears and fills the rows of a band. Bands share nothing.
void project_points(const PixelView& view, const PointCache& cache, RowBand band,
                    std::span<PointKey> points);

}  // namespace arris
