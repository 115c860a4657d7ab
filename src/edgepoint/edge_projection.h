// edge_projection.h — many edges at once become edges of the picture
// What       projects edges as project_edge() does, and leaves out those of which nothing would be marked: most edges
//            of fine meshes are shorter than pixels, and many are hidden
// Guarantee  what is left is project_edge()'s, to the bit (tests/edgepoint/edge_raster_test.cpp)
// Source     Bala, Walter, Greenberg (2003), §4.5 "Eliminating occluded edges"
#pragma once

#include <span>
#include <vector>

#include "edgepoint/depth_cells.h"
#include "edgepoint/edge_raster.h"
#include "edgepoint/pixel_view.h"

namespace arris {

// Of edges those that need be rasterised, in their order: the others cross none of the lines, or are hidden wherever
// they do.
void project_seen(const PixelView& view, std::span<const WorldEdge> edges, const DepthCells& depth,
                  std::vector<ScreenEdge>& seen);
void project_seen(const PixelView& view, std::span<const SoftEdge> edges, const DepthCells& depth,
                  std::vector<ScreenEdge>& seen);

}  // namespace arris
