#include "edgepoint/depth_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "edgepoint/color_rows.h"
#include "edgepoint/point_rows.h"

namespace arris {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Sixty-four pixels with so few points say nothing.
constexpr std::uint32_t kFewPoints = 3;
// An edge may lie deeper than the points that surround it by what a surface that is this steep gains over the width
// of some pixels.
constexpr float kPixelsDeep = 6;

// Of four cells, two bits for the upper and two for the lower: upper, lower, left and right. If one half has no points,
// nothing is known of what lies there, as where an object has moved away: edges may be its border.
constexpr std::array<std::uint32_t, 4> kHalves{0b0011, 0b1100, 0b0101, 0b1010};

}  // namespace

DepthCells::DepthCells(int width, int height)
    : width_(width),
      height_(height),
      columns_((width + kSide - 1) / kSide),
      rows_((height + kSide - 1) / kSide),
      cells_(std::size_t(columns_) * std::size_t(rows_)),
      around_(std::size_t(columns_ + 1) * std::size_t(rows_ + 1)) {}

void DepthCells::fill_cells(std::span<const PointKey> points, int cell_row) {
  const std::size_t stride = std::size_t(columns_) * kSide + ColorRows::kMargin;
  std::vector<std::uint32_t> nearest(stride, std::bit_cast<std::uint32_t>(kInfinity));
  std::vector<std::uint32_t> farthest(stride), count(stride);
  const int last = std::min(height_, (cell_row + 1) * kSide);
  for (int y = cell_row * kSide; y < last; ++y) {
    add_depths(points.subspan(std::size_t(y) * std::size_t(width_), std::size_t(width_)),
               {nearest.data(), farthest.data(), count.data()});
  }
  Cell* const row = cells_.data() + std::size_t(cell_row) * std::size_t(columns_);
  for (std::size_t i = 0; i < std::size_t(columns_); ++i) {
    const auto over = [&](const std::vector<std::uint32_t>& columns, const auto& combine) {
      const std::uint32_t* const c = columns.data() + kSide * i;
      return combine(combine(c[0], c[1]), combine(c[2], c[3]));
    };
    // Depths are positive floats, which compare like their bits.
    const auto lower = [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); };
    const auto upper = [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); };
    row[i] = {std::bit_cast<float>(over(nearest, lower)),
              std::bit_cast<float>(over(farthest, upper)), over(count, std::plus<std::uint32_t>())};
  }
}

void DepthCells::fill_limits(int limit_row, float pixel_size) {
  Around* const row = around_.data() + std::size_t(limit_row) * std::size_t(columns_ + 1);
  for (int i = 0; i <= columns_; ++i) {
    Cell around{kInfinity, 0, 0};
    std::uint32_t with_points = 0, in_picture = 0;  // bits: cells that have some
    for (int r = std::max(0, limit_row - 1); r <= std::min(rows_ - 1, limit_row); ++r) {
      for (int c = std::max(0, i - 1); c <= std::min(columns_ - 1, i); ++c) {
        const Cell& cell = cells_[std::size_t(r) * std::size_t(columns_) + std::size_t(c)];
        around.nearest = std::min(around.nearest, cell.nearest);
        around.farthest = std::max(around.farthest, cell.farthest);
        around.count += cell.count;
        const std::uint32_t bit = 1U << unsigned(2 * (r - limit_row + 1) + c - i + 1);
        in_picture |= bit;
        if (cell.count > 0) with_points |= bit;
      }
    }
    const bool surrounded = std::ranges::all_of(kHalves, [&](std::uint32_t half) {
      return (in_picture & half) == 0 || (with_points & half) != 0;
    });
    // Points spread over the window show all of its depths but for about one part in their number.
    const float spread =
        (around.farthest - around.nearest) * (2.0F / float(std::max(around.count, 1U)));
    const float limit = around.count < kFewPoints || !surrounded
                            ? kInfinity
                            : around.farthest + spread + around.farthest * pixel_size * kPixelsDeep;
    row[i] = {around.nearest, limit};
  }
}

void DepthCells::copy_nearest(int y, std::span<float> out) const {
  const Around* const row =
      around_.data() + std::size_t((y + kSide / 2) / kSide) * std::size_t(columns_ + 1);
  for (int x = 0; x < width_; ++x) out[std::size_t(x)] = row[(x + kSide / 2) / kSide].nearest;
}

}  // namespace arris
