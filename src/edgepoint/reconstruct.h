// reconstruct.h — from the edge-and-point image to a picture
// What       goes down the rows of a band: fetches the colours of points, interpolates primary regions, antialiases
//            simple pixels, reconstructs complex ones, and says how much each pixel wants a sample
// Guarantee  the same picture at any number of bands
// Cost       rows wait in a ring that stays in the processor's cache: the picture is written once
// Source     Bala, Walter, Greenberg (2003), §5
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/image.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"
#include "edgepoint/tint_image.h"

namespace arris {

struct ReconstructionSettings {
  bool complex_filter = true;
  std::uint32_t frame = 0;           // against which the age of points is counted
  const TintImage* tints = nullptr;  // null: none
};

// Of one thread, milliseconds.
struct ReconstructionTimes {
  double interpolation = 0, antialias = 0, complex = 0;

  [[nodiscard]] double total() const { return interpolation + antialias + complex; }
  ReconstructionTimes& operator+=(const ReconstructionTimes& o) {
    interpolation += o.interpolation;
    antialias += o.antialias;
    complex += o.complex;
    return *this;
  }
};

// What one band hands on besides its rows.
struct BandReport {
  std::vector<std::uint32_t> unresolved;  // pixels that no sample reaches, by offset
  ReconstructionTimes times;
};

// wanted: of each pixel how much it wants a new sample, 0 to 255: 255 where nothing is known; small where there is a
// point, but the more the older that is, and much where it is stale (PointCache::make_stale()).
BandReport reconstruct_band(const EdgePointImage& image, const PointCache& cache,
                            const ReconstructionSettings& settings, RowBand band, Image& picture,
                            std::span<std::uint8_t> wanted);

}  // namespace arris
