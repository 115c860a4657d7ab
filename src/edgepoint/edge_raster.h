// edge_raster.h — edges in space become crossings of the pixels' boundaries
// What       projects line segments, clips them to the picture, and marks on each line between pixels, and on those
//            through the pixels' middles, in which eighth of a pixel an edge crosses it, unless it is hidden there
// Guarantee  segments with a common end cross a line at it once, as ends are taken half open; the crossings of a
//            segment with rows and columns tell one way through the pixels, also where it runs exactly through
//            corners (tests/edgepoint/edge_raster_test.cpp). So a pixel that one edge passes is crossed twice.
// Limits     pictures of at most 65,536 pixels a side
// Cost       linear in segments times bands, and in crossings
// Source     Bala, Walter, Greenberg (2003), §4.5, §5.4
#pragma once

#include <span>
#include <vector>

#include "arris/math.h"
#include "edgepoint/depth_cells.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"

namespace arris {

// Nearer to the eye, in parts of the edge's depth, an edge is cut off.
inline constexpr double kNearest = 1e-6;
// Pixels around the picture that edges are drawn to.
inline constexpr double kAroundPicture = 2;
// Ends lie on a grid so fine that it is not seen, and so coarse that where an edge crosses a line is computed exactly
// in double as far as its pixel goes: crossings with rows and columns always agree on the way through the pixels.
inline constexpr double kScreenGrid = 256;  // places a pixel

struct WorldEdge {
  Vec3f a, b;
};

// Where a shadow begins or ends.
struct SoftEdge {
  WorldEdge edge;
  Vec3f penumbra;  // from its middle to the shadow's other edge; 0 if hard
  bool is_umbra = false;
};

// In picture coordinates; inverse depths are linear along it.
struct ScreenEdge {
  float x0 = 0, y0 = 0, inverse_depth0 = 0;
  float x1 = 0, y1 = 0, inverse_depth1 = 0;
};

// An edge of no length where nothing of it is in the picture.
ScreenEdge project_edge(const PixelView& view, const WorldEdge& edge);

// False where a shadow's edge does not matter: the penumbra is so wide in the picture that light changes little from
// pixel to pixel, or so narrow that its outer edge stands for both.
bool penumbra_matters(const PixelView& view, const SoftEdge& edge, const ScreenEdge& e);

// Of no length also where the edge does not matter.
ScreenEdge project_edge(const PixelView& view, const SoftEdge& edge);

// Of a band's rows. Bands share nothing.
void clear_crossings(RowBand band, int height_px, Crossings& crossings);

// Adds to the crossings of a band's rows.
void rasterize_edges(std::span<const ScreenEdge> edges, const DepthCells& depth, RowBand band,
                     int width_px, int height_px, Crossings& crossings);

}  // namespace arris
