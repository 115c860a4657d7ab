// color_rows.h — some rows of colours, a plane for each channel
// Limits     rows repeat modulo their number: row(y) is row(y + count). kMargin values beside each row can be read
//            and written; those beyond the width are anything
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "arris/math.h"

namespace arris {

struct ColorRow {
  float *r, *g, *b;
};

inline Rgb color_at(const ColorRow& row, int x) {
  return {row.r[x], row.g[x], row.b[x]};
}

class ColorRows {
 public:
  static constexpr int kMargin = 16;  // the lanes of the widest vectors

  ColorRows(int count, int width)
      : count_(count),
        stride_((std::size_t(width) + 5 * std::size_t(kMargin) - 1) / kMargin * kMargin),
        values_(3 * stride_ * std::size_t(count) + kMargin),
        start_(aligned_start()) {}
  // Rows lie where they were made.
  ColorRows(const ColorRows&) = delete;
  ColorRows& operator=(const ColorRows&) = delete;

  // y ≥ −count
  [[nodiscard]] ColorRow row(int y) {
    float* const start = start_ + 3 * stride_ * std::size_t((y + count_) % count_) + kMargin;
    return {start, start + stride_, start + 2 * stride_};
  }

 private:
  // Vectors that start at multiples of their size are loaded faster.
  float* aligned_start() {
    void* at = values_.data();
    std::size_t room = values_.size() * sizeof(float);
    return static_cast<float*>(std::align(kMargin * sizeof(float), sizeof(float), at, room));
  }

  int count_;
  std::size_t stride_;
  std::vector<float> values_;
  float* start_;
};

}  // namespace arris
