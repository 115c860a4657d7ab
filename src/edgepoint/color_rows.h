// color_rows.h — some rows of colours, a plane for each channel
// Limits     rows repeat modulo their number: row(y) is row(y + count). kMargin values beside each row can be read
//            and written; those beyond the width are anything
#pragma once

#include <array>
#include <cstddef>
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
        stride_(std::size_t(width) + 4 * std::size_t(kMargin)),
        values_(3 * stride_ * std::size_t(count)) {}

  // y ≥ −count
  [[nodiscard]] ColorRow row(int y) {
    float* const start =
        values_.data() + 3 * stride_ * std::size_t((y + count_) % count_) + kMargin;
    return {start, start + stride_, start + 2 * stride_};
  }

 private:
  int count_;
  std::size_t stride_;
  std::vector<float> values_;
};

}  // namespace arris
