// picture_sum.h — pictures as sums over their samples, so that parts of one render can be joined
// What       colour and most layers are exact sums; "depth" holds the nearest surface and "object" what the first
//            sample saw, and both are joined so. mean_picture() is what the sums show.
// Guarantee  the sum of any partition of a render is the sum of the render, bit by bit, also after
//            pack_sum() and unpack_sum() (tests/image/picture_sum_test.cpp)
// Limits     parts must be added in the order of their samples ("object"); values as base/exact_sum.h says. A picture
//            without sums (sum_of_mean) is joined to the rounding of its floats.
// Errors     kind input if sizes or layers differ
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arris/image.h"
#include "base/exact_sum.h"

namespace arris {

enum class Join { sum, nearest, first };

struct ImageSum {
  std::string name;  // empty: the colour
  int channels = 0;
  Join join = Join::sum;
  std::vector<ExactSum> sums;  // Join::sum
  std::vector<float> values;   // the others; 0: nothing was hit
};

struct PictureSum {
  int width_px = 0, height_px = 0;
  std::uint64_t samples = 0;
  std::vector<ImageSum> images;  // the colour first
};

// All zero.
ImageSum make_image_sum(const std::string& name, int channels, std::size_t pixels);

// An empty sum takes size and layers of the other.
void add_sum(PictureSum& sum, const PictureSum& other);

// Black without samples.
Picture mean_picture(const PictureSum& sum);
PictureSum sum_of_mean(const Picture& mean, std::uint64_t samples);

// The mean, and beside it the sums as layers of floats without loss; and back.
Picture pack_sum(const PictureSum& sum);
bool holds_sum(const Picture& picture);
PictureSum unpack_sum(const Picture& packed, std::uint64_t samples);

}  // namespace arris
