// hole_filler.h — colours for pixels that no sample reaches
// What       takes over the colours of pixels that no edge parts from a hole, step by step, so that what comes into
//            view keeps its outline until its first samples; then those of pixels that edges cross, along regions
//            of less than a pixel's width, such as a contact's shadow; where there are none, the mean of the nearest
//            pixels, found on ever coarser grids. Pixels that one edge crosses are mixed of their two regions' colours
//            where one of these was filled.
// Guarantee  colours cross no edge, but in regions in which nothing is known (tests/edgepoint/points_test.cpp)
// Cost       nothing without holes; a step what interpolation costs, of the grids only what holes lie in. Keeps a
//            picture's memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "arris/image.h"
#include "base/parallel_for.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/interpolate.h"

namespace arris {

class HoleFiller {
 public:
  HoleFiller(int width_px, int height_px);

  // Sizes must be the filler's. holes: offsets of pixels, ascending.
  void fill(const EdgePointImage& image, std::span<const std::uint32_t> holes,
            const ParallelOptions& parallel, Image& picture);

 private:
  void spread_reached(const EdgePointImage& image, const ParallelOptions& parallel,
                      HolePlanes& planes);

  std::size_t filled_stride_;
  ColorRows colors_;
  std::vector<std::uint64_t> filled_;  // by the last step
};

}  // namespace arris
