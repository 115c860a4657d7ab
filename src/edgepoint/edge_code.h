// edge_code.h — what an edge makes of a pixel, in 16 bits
// What       The boundary of a pixel is cut into 32 segments, eight a side; a pixel that is crossed by one edge is
//            *simple*, and its edge goes from one segment to another on another side: two numbers of five bits.
//            Two of the codes that no edge has stand for *empty* and *complex* pixels. The edge parts the pixel into
//            two regions; one of them, the one of the pixel's sample or else the larger, is *primary*.
// Legend     segment 0..31: clockwise from the upper left corner: 0–7 the top from left to right, 8–15 the right side
//            downwards, 16–23 the bottom from right to left, 24–31 the left side upwards
//            region A: the boundary between the first end and the second, clockwise; B: the rest, with the
//            upper left corner
// Source     Bala, Walter, Greenberg (2003), §4.1 to §4.3, §5.1, Fig. 4
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "arris/math.h"

namespace arris {

inline constexpr std::uint32_t kEmptyEdge = 0;    // both ends in segment 0
inline constexpr std::uint32_t kComplexEdge = 1;  // segments 0 and 1
inline constexpr std::uint32_t kEdgeCodes = 1024;

// Which segments of its four sides a pixel's edges cross: bit i of a horizontal side is its eighth from the left, of
// a vertical one its eighth from the top.
struct SideCrossings {
  std::uint8_t top = 0, right = 0, bottom = 0, left = 0;
};

// first < last, on different sides.
constexpr std::uint32_t edge_code(std::uint32_t first, std::uint32_t last) {
  return first << 5U | last;
}
constexpr std::uint32_t first_end(std::uint32_t code) {
  return code >> 5U;
}
constexpr std::uint32_t last_end(std::uint32_t code) {
  return code & 31U;
}
constexpr bool is_simple(std::uint32_t code) {
  return code > kComplexEdge;
}

// All 32 segments of the boundary as one mask.
inline std::uint32_t boundary_mask(SideCrossings c) {
  const auto reversed = [](std::uint8_t side) {
    // Bits of a byte in opposite order, by a multiplication (public domain: "Bit Twiddling Hacks").
    return std::uint32_t(((side * 0x80200802ULL) & 0x0884422110ULL) * 0x0101010101ULL >> 32U) &
           0xffU;
  };
  return std::uint32_t(c.top) | std::uint32_t(c.right) << 8U | reversed(c.bottom) << 16U |
         reversed(c.left) << 24U;
}

// Beyond the paper: edges that cross a side in neighbouring segments are taken as one, such as an outline and its own
// shadow at a contact, or the outer and inner edge of a narrow penumbra: what lies between is a quarter of a pixel wide
// at most, and a pixel that is complex would let nothing pass. Leaves the first segment of a run of two.
constexpr std::uint32_t merge_coincident(std::uint32_t mask) {
  const std::uint32_t starts = mask & ~(mask << 1U & 0xfefefefeU);
  const std::uint32_t third = starts & mask >> 1U & mask >> 2U & 0x3f3f3f3fU;
  return third == 0 ? starts : mask;
}

// §4.5: no crossing is empty, two on different sides are simple, all else is complex.
inline std::uint32_t classify_boundary(std::uint32_t mask) {
  if (mask == 0) return kEmptyEdge;
  mask = merge_coincident(mask);
  const auto first = std::uint32_t(std::countr_zero(mask));
  const auto last = 31U - std::uint32_t(std::countl_zero(mask));
  const bool two = (mask & (mask - 1)) == 1U << last;
  return two && first / 8 != last / 8 ? edge_code(first, last) : kComplexEdge;
}

// A pixel of the edge-and-point image but for its point.
class PixelCode {
 public:
  PixelCode() = default;
  explicit PixelCode(std::uint32_t code) : bits_(std::uint16_t(code)) {}

  [[nodiscard]] std::uint32_t edge() const { return bits_ & 1023U; }
  [[nodiscard]] bool is_empty() const { return edge() == kEmptyEdge; }
  [[nodiscard]] bool is_complex() const { return edge() == kComplexEdge; }
  [[nodiscard]] bool is_simple() const { return arris::is_simple(edge()); }
  // Region A is the primary one (else B, or all of a pixel that isn't simple).
  [[nodiscard]] bool primary_is_a() const { return (bits_ & kPrimaryA) != 0; }

  void set_primary(bool is_a) {
    bits_ = std::uint16_t((bits_ & ~kPrimaryA) | (is_a ? kPrimaryA : 0));
  }

 private:
  static constexpr std::uint32_t kPrimaryA = 1U << 14U;
  std::uint16_t bits_ = 0;
};

enum class RegionOf : std::uint8_t { a, b, ambiguous };

struct EdgeTables {
  // Part of the pixel that is region A.
  std::array<float, kEdgeCodes> area_a{};
  // Corners in region A: bits from the lowest, clockwise from the upper left.
  std::array<std::uint8_t, kEdgeCodes> corners_a{};
  // The region of each of the 16 cells (4 y + x of quarters of a pixel), two bits each, as RegionOf. A cell that the
  // edge may cross, wherever in its two segments it ends, is ambiguous.
  std::array<std::uint32_t, kEdgeCodes> cells{};
  // The sides that region A and region B touch, by falling length, as numbers 0 top, 1 right, 2 bottom, 3 left, two
  // bits each from the lowest; `count` of them.
  struct Sides {
    std::uint8_t order = 0, count = 0;
  };
  std::array<Sides, kEdgeCodes> sides_a{}, sides_b{};

  [[nodiscard]] RegionOf region_of(std::uint32_t code, std::uint32_t cell) const {
    return RegionOf(cells[code] >> (2 * cell) & 3U);
  }
};

// Made once, when first asked for.
const EdgeTables& edge_tables();

// The point of the unit pixel's boundary at a distance of 0..4 clockwise from the upper left corner. Segment i goes
// from i / 8 to (i + 1) / 8.
Vec2d boundary_point(double along);

}  // namespace arris
