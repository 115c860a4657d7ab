#include "edgepoint/classify.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace arris {
namespace {

constexpr int kWord = 64;  // pixels

std::uint64_t any_of(const std::uint8_t* bytes) {
  std::array<std::uint64_t, kWord / 8> words;
  std::memcpy(words.data(), bytes, kWord);
  return words[0] | words[1] | words[2] | words[3] | words[4] | words[5] | words[6] | words[7];
}

struct Corners {
  std::array<std::uint64_t, 4> primary{}, secondary{};

  void add(PixelCode code, int bit) {
    if (code.is_complex()) return;
    std::uint32_t in_primary = 15;
    if (code.is_simple()) {
      in_primary = edge_tables().corners_a[code.edge()];
      if (!code.primary_is_a()) in_primary ^= 15U;
    }
    for (unsigned k = 0; k < 4; ++k) {
      const std::uint64_t is_primary = in_primary >> k & 1U;
      primary[k] |= is_primary << unsigned(bit);
      secondary[k] |= (is_primary ^ 1U) << unsigned(bit);
    }
  }
};

}  // namespace

std::size_t EdgePointImage::bytes() const {
  std::size_t sum = crossings.upper.bytes() + crossings.left.bytes() + crossings.mid_row.bytes() +
                    crossings.mid_column.bytes() + codes.size() * sizeof(PixelCode) +
                    points.size() * sizeof(PointKey) + samples.bytes();
  for (const BitPlane& plane : corners.primary) sum += plane.bytes();
  for (const BitPlane& plane : corners.secondary) sum += plane.bytes();
  for (const BitPlane& plane : reach.planes) sum += plane.bytes();
  return sum;
}

PixelClasses classify_pixels(RowBand band, EdgePointImage& image) {
  PixelClasses classes;
  const int width = image.width_px;
  for (int y = band.first; y < band.last; ++y) {
    const Crossings& c = image.crossings;
    const std::uint8_t *upper = c.upper.row(y), *lower = c.upper.row(y + 1), *left = c.left.row(y);
    PixelCode* const codes = image.codes.data() + image.offset(0, y);
    const PointKey* const points = image.points.data() + image.offset(0, y);
    for (int x0 = 0; x0 < width; x0 += kWord) {
      const int count = std::min(kWord, width - x0);
      Corners corners;
      std::uint64_t samples = 0;
      // The right side of the last pixel of the word is the left one of the next.
      const bool any = (any_of(upper + x0) | any_of(lower + x0) | any_of(left + x0)) != 0 ||
                       left[x0 + count] != 0;
      if (!any) {
        corners.primary.fill(count == kWord ? ~std::uint64_t{0}
                                            : (std::uint64_t{1} << unsigned(count)) - 1);
        std::fill(codes + x0, codes + x0 + count, PixelCode(kEmptyEdge));
        for (int i = 0; i < count; ++i) {
          samples |= std::uint64_t(points[x0 + i].is_none() ? 0 : 1) << unsigned(i);
        }
        classes.empty += std::uint64_t(count);
      } else {
        for (int x = x0; x < x0 + count; ++x) {
          const ClassifiedPixel pixel = classify_pixel(boundary_mask(c.of_pixel(x, y)), points[x]);
          codes[x] = pixel.code;
          corners.add(pixel.code, x - x0);
          samples |= std::uint64_t(pixel.has_sample ? 1 : 0) << unsigned(x - x0);
          classes.empty += codes[x].is_empty() ? 1 : 0;
          classes.simple += codes[x].is_simple() ? 1 : 0;
          classes.complex += codes[x].is_complex() ? 1 : 0;
        }
      }
      image.samples.row(y)[x0 / kWord] = samples;
      for (std::size_t k = 0; k < 4; ++k) {
        image.corners.primary[k].row(y)[x0 / kWord] = corners.primary[k];
        image.corners.secondary[k].row(y)[x0 / kWord] = corners.secondary[k];
      }
    }
  }
  return classes;
}

}  // namespace arris
