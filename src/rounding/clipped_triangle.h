// clipped_triangle.h — what planes leave of a triangle
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "arris/math.h"

namespace arris {

class ClippedTriangle {
 public:
  explicit ClippedTriangle(const std::array<Vec3d, 3>& corners) {
    std::copy(corners.begin(), corners.end(), points_.begin());
  }

  // To where a linear function of the place is not above 0; five times at most.
  template <class Height>
  void clip(const Height& height) {
    std::array<double, kMost> heights;
    bool is_whole = true;
    for (std::size_t i = 0; i < count_; ++i) {
      heights[i] = height(points_[i]);
      is_whole = is_whole && heights[i] <= 0;
    }
    if (is_whole) return;
    std::array<Vec3d, kMost> out;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t k = i + 1 == count_ ? 0 : i + 1;
      const Vec3d p = points_[i], q = points_[k];
      const double hp = heights[i], hq = heights[k];
      if (hp <= 0) out[n++] = p;
      if ((hp <= 0) != (hq <= 0)) out[n++] = p + (q - p) * (hp / (hp - hq));
    }
    std::copy_n(out.begin(), n, points_.begin());
    count_ = n;
  }
  [[nodiscard]] std::span<const Vec3d> corners() const { return std::span(points_).first(count_); }

 private:
  static constexpr std::size_t kMost = 8;  // each cut adds one
  std::array<Vec3d, kMost> points_;
  std::size_t count_ = 3;
};

}  // namespace arris
