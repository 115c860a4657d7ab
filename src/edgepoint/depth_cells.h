// depth_cells.h — how far away an edge may be and still be seen
// What       Edges behind the points around them are hidden. As points lie between edges and leave gaps, the depth
//            that an edge is held against is the largest of the points around it, and more where points are few; where
//            they lie on one side alone no edge is hidden.
// Guarantee  none: an edge that is kept in error costs a neighbour, one that is lost lets colours bleed, so the
//            depth is a generous one
// Source     Bala, Walter, Greenberg (2003), §4.5, "Eliminating occluded edges": the largest depth of a 4 × 4
//            neighbourhood and an offset that depends on the local density of points. Here cells of 4 × 4 pixels and
//            the 2 × 2 cells around a place; the offset knows the slope.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "arris/math.h"
#include "edgepoint/edge_point_image.h"

namespace arris {

class DepthCells {
 public:
  static constexpr int kSide = 4;  // of a cell, pixels

  DepthCells(int width, int height);

  void fill_cells(std::span<const PointKey> points, int cell_row);
  // After all rows of cells. pixel_size: of a pixel at depth 1, in the world.
  void fill_limits(int limit_row, float pixel_size);
  [[nodiscard]] int cell_rows() const { return rows_; }
  [[nodiscard]] int limit_rows() const { return rows_ + 1; }

  // The largest depth at which an edge is seen at a place of the picture.
  [[nodiscard]] float limit_at(float x, float y) const { return around_[place_of(x, y)].limit; }
  // As much as that at least, anywhere in the box of two places, which may lie beside the picture. Infinite if they are
  // far apart: of long edges some part is seen more often than not.
  [[nodiscard]] float limit_around(Vec2f a, Vec2f b) const {
    const auto cell = [](float v, int size) {
      return int(std::clamp(v, 0.0F, float(size)) * (1.0F / kSide) + 0.5F);
    };
    const int left = cell(std::min(a.x, b.x), width_), right = cell(std::max(a.x, b.x), width_);
    const int top = cell(std::min(a.y, b.y), height_), bottom = cell(std::max(a.y, b.y), height_);
    if (right - left > 1 || bottom - top > 1) return std::numeric_limits<float>::infinity();
    const Around *const upper = around_row(top), *const lower = around_row(bottom);
    return std::max(std::max(upper[left].limit, upper[right].limit),
                    std::max(lower[left].limit, lower[right].limit));
  }
  // The smallest depth of the points around each pixel of a row; it is the same for a row unless that changes there.
  void copy_nearest(int y, std::span<float> out) const;
  [[nodiscard]] static bool row_changes_at(int y) { return (y + kSide / 2) % kSide == 0; }

 private:
  struct Cell {
    float nearest, farthest;
    std::uint32_t count;
  };

  struct Around {
    float nearest, limit;
  };

  [[nodiscard]] std::size_t place_of(float x, float y) const {
    const int i = int(x * (1.0F / kSide) + 0.5F), j = int(y * (1.0F / kSide) + 0.5F);
    return std::size_t(j) * std::size_t(columns_ + 1) + std::size_t(i);
  }

  [[nodiscard]] const Around* around_row(int row) const {
    return around_.data() + std::size_t(row) * std::size_t(columns_ + 1);
  }

  int width_, height_, columns_, rows_;
  std::vector<Cell> cells_;
  std::vector<Around> around_;  // at the corners of cells: of the four around
};

}  // namespace arris
