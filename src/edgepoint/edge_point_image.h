// edge_point_image.h — the edge-and-point image
// What       for each pixel which eighths of its boundary are crossed by edges, what that makes of it, and the
//            nearest point that was projected onto it
// Cost       a pixel: 2 bytes of code, 8 of depth, point and subpixel position; beside them 2 bytes of crossings, 2
//            more with the half lines that complex pixels are looked at with; and planes of bits, 22 a pixel and
//            their margins (bit_plane.h): corners, points, samples, reachability
// Source     Bala, Walter, Greenberg (2003), §4.4, §7.4
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "edgepoint/bit_plane.h"
#include "edgepoint/edge_code.h"
#include "edgepoint/point_cache.h"
#include "edgepoint/reach_planes.h"

namespace arris {

// The nearest point of a pixel: depth in the upper half, then the point's number, then its subpixel position, so that
// the smaller is the nearer. Depths are positive floats, which compare like their bits.
class PointKey {
 public:
  PointKey() = default;
  PointKey(std::uint32_t depth_bits, PointNumber point, std::uint32_t cell)
      : PointKey(depth_bits, point << 4U | cell) {}
  // place: the point's number and its subpixel position, together.
  PointKey(std::uint32_t depth_bits, std::uint32_t place)
      : bits_(std::uint64_t(depth_bits) << 32U | place) {}

  [[nodiscard]] bool is_none() const { return bits_ == kNoPoint; }
  [[nodiscard]] float depth() const;
  [[nodiscard]] PointNumber point() const { return std::uint32_t(bits_) >> 4U; }
  [[nodiscard]] std::uint32_t cell() const { return std::uint32_t(bits_) & 15U; }
  friend bool operator<(PointKey a, PointKey b) { return a.bits_ < b.bits_; }

 private:
  static constexpr std::uint64_t kNoPoint = ~std::uint64_t{0};
  std::uint64_t bits_ = kNoPoint;
};

// Crossings with one family of lines, a byte for each pixel's length.
class CrossingRows {
 public:
  CrossingRows() = default;
  CrossingRows(int width, int height)
      : stride_((std::size_t(width) + 63) / 64 * 64), bytes_(stride_ * std::size_t(height)) {}

  [[nodiscard]] std::uint8_t* row(int y) { return bytes_.data() + std::size_t(y) * stride_; }
  [[nodiscard]] const std::uint8_t* row(int y) const {
    return bytes_.data() + std::size_t(y) * stride_;
  }
  // Of every row; a multiple of 64.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

 private:
  std::size_t stride_ = 0;
  std::vector<std::uint8_t> bytes_;
};

struct Crossings {
  CrossingRows upper;       // (x, y): of the upper side of pixel (x, y); y up to height
  CrossingRows left;        // of its left side; x up to width, and to 64 beyond what can be read
  CrossingRows mid_row;     // of the line through its middle from left to right
  CrossingRows mid_column;  // of that from top to bottom

  Crossings() = default;
  Crossings(int width, int height)
      : upper(width, height + 1),
        left(width + 64, height),
        mid_row(width, height),
        mid_column(width, height) {}

  [[nodiscard]] SideCrossings of_pixel(int x, int y) const {
    return {upper.row(y)[x], left.row(y)[x + 1], upper.row(y + 1)[x], left.row(y)[x]};
  }
};

inline std::size_t pixel_count(int width, int height) {
  return std::size_t(unsigned(width)) * unsigned(height);
}

struct EdgePointImage {
  int width_px = 0, height_px = 0;
  Crossings crossings;
  std::vector<PixelCode> codes;
  std::vector<PointKey> points;
  CornerPlanes corners;
  BitPlane occupied;  // that have a point
  BitPlane fresh;  // of `samples`, those that are not stale; means nothing unless `some_are_stale`
  bool some_are_stale = false;
  BitPlane samples;  // whose point is known to lie in the primary region, so that others may use it
  ReachPlanes reach;

  EdgePointImage() = default;
  EdgePointImage(int width, int height)
      : width_px(width),
        height_px(height),
        crossings(width, height),
        codes(pixel_count(width, height)),
        points(codes.size()),
        corners(width, height),
        occupied(width, height),
        fresh(width, height),
        samples(width, height),
        reach(width, height) {}

  [[nodiscard]] std::size_t offset(int x, int y) const {
    return std::size_t(y) * std::size_t(width_px) + std::size_t(x);
  }
  [[nodiscard]] std::size_t bytes() const;
};

}  // namespace arris
