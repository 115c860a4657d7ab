// reach_filter.h — noise is averaged over pixels that no edge parts
// What       An à-trous filter of 5 × 5 pixels and steps of 1, 2, 4, … pixels, whose taps end at edges: a pixel is
//            reached over a longer step if each of the two shorter ones reaches. Among pixels that are reached, weights
//            fall with the difference of colours in proportion to their noise, and where normals turn.
// In         colours and the variances of their channels; which pixels are samples (the others are mixtures of what
//            lies on both sides of an edge, and take the colour of their primary region)
// Guarantee  the same picture at any number of threads; no colour crosses an edge
// Source     H. Dammertz et al., "Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination
//            Filtering" (2010); C. Schied et al., "Spatiotemporal Variance-Guided Filtering" (2017), §4.4.
//            Theirs guess edges from depth and normals.
#pragma once

#include <vector>

#include "arris/math.h"
#include "edgepoint/edge_point_image.h"

namespace arris {

struct NoisyPixel {
  Rgb color, variance;
  Vec3f normal;        // unit, or 0 where there is none: where it turns light does, too
  bool known = false;  // its colour is that of its primary region
};

struct ReachFilterSettings {
  int levels = 5;  // the last one's step is 2^(levels − 1) pixels
  int threads = 0;
};

// Row after row. Pixels that nothing reaches stay as they are.
void filter_within_reach(const EdgePointImage& image, const ReachFilterSettings& settings,
                         std::vector<NoisyPixel>& pixels);

}  // namespace arris
