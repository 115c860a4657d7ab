// subpixel_rows.h — the halves of pixels that complex pixels are reconstructed from
// What       some rows of subpixels, four to a pixel: their edges come from the crossings with the lines between and
//            through the pixels; their colours are those of the points in them, or what is interpolated of the primary
//            region of their pixel if they lie in it. Made once for all the complex pixels that are near.
// Source     Bala, Walter, Greenberg (2003), §5.4
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/antialias.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/subpixel_reach.h"
#include "edgepoint/tint_image.h"

namespace arris {

// Of a row of pixels.
struct SubpixelColors {
  ColorRow
      samples;  // of points, also of those that classification has rejected, without their tints
  PrimaryRows primary;               // tinted
  const TintImage* tints = nullptr;  // of pixels, whose samples have the same; null: none
  ColorRow painted;                  // of the samples, what tints multiply; where there are tints
};

// Red, green, blue and 1, whose sums with weights are made as one vector.
struct alignas(16) CountedColor {
  std::array<float, 4> rgb1;
};

class SubpixelRows {
 public:
  explicit SubpixelRows(const EdgePointImage& image);

  // Makes the two rows of subpixels of pixel row y, of the pixels that are wanted (a bit each). Others are empty of
  // everything.
  void fill(int y, std::span<const std::uint64_t> wanted, const SubpixelColors& colors);
  // As of a row beyond the picture.
  void clear(int y);

  [[nodiscard]] const SubpixelPlanes& planes() const { return planes_; }
  // Of a subpixel in arrays of rows of subpixels.
  [[nodiscard]] std::ptrdiff_t place(int column, int row) const {
    return std::ptrdiff_t(subpixel_ring(row)) * std::ptrdiff_t(stride_) + column;
  }
  // Of a pixel that is crossed.
  [[nodiscard]] PixelCode code(std::ptrdiff_t place) const { return codes_[std::size_t(place)]; }
  // Of those that are known; of others these are anything.
  [[nodiscard]] const CountedColor* colors() const { return colors_.data(); }
  [[nodiscard]] const float* weights() const { return weights_.data(); }

 private:
  struct RowInput;
  struct WordBits;

  void add_plain(const RowInput& in, int x, WordBits& bits);
  void add_crossed(const RowInput& in, int x, WordBits& bits);
  void set_primary(const RowInput& in, int x, unsigned k, WordBits& bits);
  void set_sample(const RowInput& in, int x, unsigned k, WordBits& bits);
  void set_color(std::ptrdiff_t place, Rgb color, float weight);
  void store(const WordBits& bits, int y, int word);

  const EdgePointImage& image_;
  std::size_t stride_;
  SubpixelPlanes planes_;
  std::vector<PixelCode> codes_;
  std::vector<CountedColor> colors_;
  std::vector<float> weights_;
};

}  // namespace arris
