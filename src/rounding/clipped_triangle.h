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
    std::array<Vec3d, kMost> out;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3d p = points_[i], q = points_[i + 1 == count_ ? 0 : i + 1];
      const double hp = height(p), hq = height(q);
      if (hp <= 0) out[n++] = p;
      if ((hp <= 0) != (hq <= 0)) out[n++] = p + (q - p) * (hp / (hp - hq));
    }
    points_ = out;
    count_ = n;
  }
  [[nodiscard]] std::span<const Vec3d> corners() const { return std::span(points_).first(count_); }

 private:
  static constexpr std::size_t kMost = 8;  // each cut adds one
  std::array<Vec3d, kMost> points_;
  std::size_t count_ = 3;
};

}  // namespace arris
