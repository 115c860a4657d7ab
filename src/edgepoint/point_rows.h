// point_rows.h — what is read of the points of a row of the edge-and-point image, in vectors of pixels
// Cost       one pass over the row each; but colours and ages lie in no order
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/point_cache.h"

namespace arris {

// Which of up to 64 pixels have a point.
std::uint64_t find_occupied(std::span<const PointKey> keys);

// Of no point it is not a number. There is room for ColorRows::kMargin more, also in the columns below.
void find_inverse_depths(std::span<const PointKey> row, float* out);

// Columns of pixels: bits of the smallest and of the largest depth, and how many points there are.
struct DepthColumns {
  std::uint32_t *nearest, *farthest, *count;
};
void add_depths(std::span<const PointKey> row, const DepthColumns& columns);

// Colours of a row's points; black where there are none. wishes: how much a pixel with a point wants a new one: the
// more the older or staler; 0 without a point. next: the row that will be asked for next, whose points are loaded
// meanwhile. looks: room for the row's. All have ColorRows::kMargin beyond the row's end.
void fetch_points(std::span<const PointKey> row, std::span<const PointKey> next,
                  const PointCache& cache, std::uint32_t frame, std::span<PointLook> looks,
                  ColorRow colors, std::uint8_t* wishes);

// How much pixels want a new sample: what their points wish, or the more the less is known (weight, of interpolation):
// 255 where nothing is. Appends the places of those, counted from `first`.
void find_wanted(std::span<std::uint8_t> wanted, const float* weight, const std::uint8_t* wishes,
                 std::size_t first, std::vector<std::uint32_t>& unresolved);

}  // namespace arris
