// complex_pixel.h — the colours of pixels that more than one edge crosses
// What       The 3 × 3 pixels around it are taken as 6 × 6 subpixels (subpixel_rows.h). Each of the pixel's four
//            subpixels is reconstructed from the samples that reach it, and from what is interpolated of the
//            neighbouring pixels, one region at a time; where a subpixel is complex, too, or nothing reaches it, the
//            pixel's colour with all samples taken as reachable stands in.
// Guarantee  reachability is that of reach_chain-inl.h
// Cost       what subpixels are and which reach each other is found once for all the complex pixels of three rows
// Source     Bala, Walter, Greenberg (2003), §5.4. Theirs knows samples alone, of which 3 × 3 pixels hold few.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "edgepoint/antialias.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/subpixel_reach.h"
#include "edgepoint/subpixel_rows.h"
#include "edgepoint/tint_image.h"

namespace arris {

// Of rows y − 1 to y + 1, as SubpixelColors.
struct ComplexPixelColors {
  ColorRows& samples;
  PrimaryNeighborhood
      around;  // here: of a complex pixel its colour with all samples taken as reachable
  const TintImage* tints = nullptr;
  ColorRows* painted = nullptr;
};

// Where a tap's subpixel is from its own, in arrays of rows of subpixels.
struct SubpixelTapStep {
  int step;
  float kernel;
};
using SubpixelTapSteps = std::array<SubpixelTapStep, kSubpixelTaps>;

class ComplexPixels {
 public:
  explicit ComplexPixels(const EdgePointImage& image);

  // Sets the complex pixels of row y of the picture. Rows are asked for downwards, some may be left out, and the
  // colours of a row stay the same.
  void reconstruct_row(int y, const ComplexPixelColors& colors, float* out);

 private:
  using Words = std::vector<std::uint64_t>;  // a bit for each pixel of a row
  // What is known of a row of pixels.
  struct Row {
    int filled = -2, reached = -2;  // which row of the picture
    Words wanted;                   // pixels that some complex pixel has around it
  };

  [[nodiscard]] Row& row(int y) { return rows_[std::size_t(y & 3)]; }
  [[nodiscard]] std::uint64_t complex_word(int y, std::size_t word) const;
  void find_wanted(int y, Words& wanted) const;
  void fill(int y, const PrimaryRows& primary, const ComplexPixelColors& colors);
  void find_reach(int y);
  [[nodiscard]] SubpixelTapSteps taps_of(int row) const;
  [[nodiscard]] Rgb color_of(int x, int y, const std::array<SubpixelTapSteps, 2>& taps,
                             Rgb fallback) const;
  [[nodiscard]] Rgb region_color(std::uint32_t reached, std::ptrdiff_t place,
                                 const SubpixelTapSteps& taps, Rgb fallback) const;

  const EdgePointImage& image_;
  SubpixelRows subpixels_;
  SubpixelReach reach_;
  std::array<Row, 4> rows_;
  Words complex_;
  // Of the subpixels of a row of pixels, in two rows.
  std::array<std::vector<std::uint32_t>, 2> primary_taps_, secondary_taps_;
};

}  // namespace arris
