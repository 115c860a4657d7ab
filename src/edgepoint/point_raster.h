// point_raster.h — cached points onto the pixels of a new view
// What       projects the points of the cache and keeps the nearest of each pixel, with the quarter of the pixel
//            that it lies in; but for points of surfaces that are seen from the other side now
// Guarantee  the same points at any number of bands: the nearest wins, of equal ones the lower number
// Limits     a surface that is seen at less than a degree or two shows the points of both its sides
// Cost       linear in the points; a block outside of a band costs its eight corners
// Source     Bala, Walter, Greenberg (2003), §4.3
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"

namespace arris {

// Rows of the picture that the points of each block may fall into.
std::vector<RowBand> find_block_rows(const PixelView& view, const PointCache& cache, int threads);

// Clears and fills the rows of a band. seen: of the points of each block, added to. Bands share nothing.
void project_points(const PixelView& view, const PointCache& cache,
                    std::span<const RowBand> block_rows, RowBand band, std::span<PointKey> points,
                    std::span<std::uint32_t> seen);

}  // namespace arris
