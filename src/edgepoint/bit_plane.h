// bit_plane.h — one bit a pixel, rows as words
// Limits     there are margins on all sides, whose bits are 0: kRowMargin rows above and below, and a vector between
//            rows, so that a row may be read a vector to the left and beyond its end; but not written
// Cost       at 512 pixels a row twice their bits, at 1,920 four thirds of them
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace arris {

inline constexpr int kRowMargin = 2;
// 64 bytes: the widest vectors there are.
inline constexpr int kVectorWords = 8;

class BitPlane {
 public:
  BitPlane() = default;
  BitPlane(int width, int height)
      : words_((width + 63) / 64),
        stride_(std::size_t((words_ + kVectorWords - 1) / kVectorWords * kVectorWords) +
                kVectorWords),
        bits_(stride_ * std::size_t(height + 2 * kRowMargin) + kVectorWords) {}

  // Words that hold the pixels of a row.
  [[nodiscard]] int words() const { return words_; }
  // y may lie kRowMargin beyond the picture.
  [[nodiscard]] std::uint64_t* row(int y) { return bits_.data() + start(y); }
  [[nodiscard]] const std::uint64_t* row(int y) const { return bits_.data() + start(y); }
  [[nodiscard]] bool at(int x, int y) const { return (row(y)[x >> 6] >> (x & 63) & 1U) != 0; }
  [[nodiscard]] std::size_t bytes() const { return bits_.size() * sizeof(std::uint64_t); }

 private:
  [[nodiscard]] std::size_t start(int y) const {
    return std::size_t(y + kRowMargin) * stride_ + kVectorWords;
  }

  int words_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace arris
