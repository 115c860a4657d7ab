// complex_pixel.h — the colour of a pixel that more than one edge crosses
// What       The 3 × 3 pixels around it are taken as 6 × 6 subpixels, whose edges come from the crossings with the
//            lines between and through the pixels. Each of the pixel's four subpixels is reconstructed from the
//            samples that reach it, and from what is interpolated of the neighbouring pixels, one region at a time;
//            where a subpixel is complex, too, or nothing reaches it, the pixel's unconstrained colour stands in.
// Guarantee  reachability is that of reach_chain-inl.h: the 6 × 6 subpixels are one word of bits
// Source     Bala, Walter, Greenberg (2003), §5.4. Theirs knows samples alone, of which 3 × 3 pixels hold few.
#pragma once

#include "arris/math.h"
#include "edgepoint/antialias.h"
#include "edgepoint/color_rows.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/tint_image.h"

namespace arris {

struct ComplexPixelColors {
  // Of the points of rows y − 1 to y + 1, also of those that classification has rejected, without their tints.
  ColorRows& samples;
  PrimaryNeighborhood around;        // tinted
  const TintImage* tints = nullptr;  // of pixels, whose samples have the same; null: none
  ColorRows* painted = nullptr;      // of the samples, what tints multiply; where there are tints
  Rgb fallback;                      // the pixel's colour with all samples taken as reachable
};
Rgb reconstruct_complex_pixel(const EdgePointImage& image, int x, int y,
                              const ComplexPixelColors& colors);

}  // namespace arris
