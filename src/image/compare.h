// compare.h — how far two pictures are apart
// What       compare_images(): RMSE, largest difference, PSNR and FLIP, a measure of the difference that a
//            person sees who flips between the two pictures on a screen
// In / Out   two linear images of one size with 3 channels; `encoding` says in which values RMSE, largest
//            difference and PSNR are taken. The peak of PSNR is 1 for encoded values and for linear ones the
//            largest value of the first picture.
// Guarantee  all are 0 (PSNR infinite) exactly for equal pictures and don't depend on the order of
//            the two, PSNR of linear values apart (tests/image/compare_test.cpp)
// Limits     FLIP sees what a screen shows: sRGB, clipped at 1; 67 pixels per degree, a screen of 0.7 m
//            width and 3,840 pixels at 0.7 m
// Errors     kind input if the sizes differ; non-finite values are counted, not compared
// Source     Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for
//            Alternating Images", Proc. ACM CGIT 3(2), 2020
#pragma once

#include <cstdint>

#include "arris/image.h"

namespace arris {

enum class ValueEncoding { linear, srgb };

struct ImageDifference {
  double rmse = 0;
  double max_error = 0;
  int max_x = 0, max_y = 0;            // where
  double psnr_db = 0;                  // infinity if equal
  double peak = 1;                     // of PSNR
  double flip = 0;                     // mean over the pixels, 0..1
  std::uint64_t nonfinite_pixels = 0;  // in one of the pictures; left out of the measures above
};

ImageDifference compare_images(const Image& a, const Image& b, ValueEncoding encoding);

// FLIP of every pixel, 0..1, one channel; display-referred linear input. NaN counts as black.
Image flip_map(const Image& a, const Image& b);

// The map as a picture: from black over purple and orange to pale yellow, linear.
Image flip_colors(const Image& map);

}  // namespace arris
