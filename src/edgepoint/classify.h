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

// The code of one pixel, of what its boundary is crossed by and its point (or none).
inline PixelCode make_pixel_code(std::uint32_t boundary, PointKey point) {
  const EdgeTables& tables = edge_tables();
  PixelCode code(classify_boundary(boundary));
  if (code.is_simple()) {
    const RegionOf region =
        point.is_none() ? RegionOf::ambiguous : tables.region_of(code.edge(), point.cell());
    if (region == RegionOf::ambiguous) {
      code.set_primary(tables.area_a[code.edge()] > 0.5F);
    } else {
      code.set_primary(region == RegionOf::a);
      code.set_sample();
    }
  } else if (!point.is_none() && code.is_empty()) {
    code.set_sample();
  }
  return code;
}

}  // namespace arris
