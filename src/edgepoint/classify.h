// classify.h — crossings and points become pixel codes, and those the regions at the pixels' corners
// Source     Bala, Walter, Greenberg (2003), §4.5 "Edge reconstruction", §4.3, §5.1
#pragma once

#include <cstdint>

#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"

namespace arris {

struct PixelClasses {
  std::uint64_t empty = 0, simple = 0, complex = 0;

  PixelClasses& operator+=(const PixelClasses& o) {
    empty += o.empty;
    simple += o.simple;
    complex += o.complex;
    return *this;
  }
};

// Makes the codes and corners of a band's rows of its crossings and points, and counts. Bands share nothing.
PixelClasses classify_pixels(RowBand band, EdgePointImage& image);

// The code of one pixel, of what its boundary is crossed by and its point (or none); and whether the point is a sample
// that others may use: it is known to lie in the primary region.
struct ClassifiedPixel {
  PixelCode code;
  bool has_sample = false;
};
inline ClassifiedPixel classify_pixel(std::uint32_t boundary, PointKey point) {
  const EdgeTables& tables = edge_tables();
  ClassifiedPixel pixel{PixelCode(classify_boundary(boundary)), false};
  if (pixel.code.is_simple()) {
    const std::uint32_t edge = pixel.code.edge();
    const RegionOf region =
        point.is_none() ? RegionOf::ambiguous : tables.region_of(edge, point.cell());
    pixel.has_sample = region != RegionOf::ambiguous;
    pixel.code.set_primary(pixel.has_sample ? region == RegionOf::a : tables.area_a[edge] > 0.5F);
  } else {
    pixel.has_sample = !point.is_none() && pixel.code.is_empty();
  }
  return pixel;
}

}  // namespace arris
