// picture_sum.h — joins pictures of parts of one render
// What       a picture as sums over its samples. Means of parts A..B and B..C, weighted with their counts,
//            make the mean of A..C: colour and most layers. "depth" holds the nearest surface and
//            "object" what the first sample saw, and both are joined so.
// Guarantee  adding in the same order gives the same bits; the join of any partition of a render is the render
//            to the rounding of its floats (tests/image/picture_sum_test.cpp)
// Limits     parts must be added in the order of their samples ("object")
// Errors     kind input if sizes or layers differ
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arris/image.h"

namespace arris {

struct ImageSum {
  std::string name;  // empty: the colour
  int channels = 0;
  std::vector<double> values;
};

struct PictureSum {
  int width_px = 0, height_px = 0;
  std::uint64_t samples = 0;
  std::vector<ImageSum> images;  // the colour first
};

// sum += mean over `samples` samples; the first picture sets size and layers.
void add_picture(PictureSum& sum, const Picture& mean, std::uint64_t samples);

// Precondition: samples > 0.
Picture mean_picture(const PictureSum& sum);

// The sums themselves as layers of floats without loss, beside their mean, and back. Nothing if
// the picture holds none.
Picture pack_sum(const PictureSum& sum);
PictureSum unpack_sum(const Picture& packed, std::uint64_t samples);

}  // namespace arris
