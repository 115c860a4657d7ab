#include "edgepoint/complex_pixel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "edgepoint/classify.h"
#include "edgepoint/kernel.h"
#include "edgepoint/reach_chain-inl.h"

namespace arris {
namespace {

// Bits of a row of six subpixels: two stay 0, so that nothing is shifted in from other rows.
constexpr int kRow = 8;
constexpr std::size_t kSubpixelBits = 48;
using Word = std::uint64_t;

constexpr int bit_of(int i, int j) {
  return j * kRow + i;
}

// The word as it is for the subpixel at an offset.
Word shifted(Word word, int dx, int dy) {
  const int by = bit_of(dx, dy);
  return by >= 0 ? word >> unsigned(by) : word << unsigned(-by);
}

// Four segments of half a side as eight of a whole one, in their order and in the opposite one.
struct SpreadTables {
  std::array<std::uint8_t, 16> forward{}, backward{};
};
constexpr auto kSpread = [] {
  SpreadTables tables;
  for (unsigned n = 0; n < 16; ++n) {
    for (unsigned bit = 0; bit < 4; ++bit) {
      if ((n >> bit & 1U) == 0) continue;
      tables.forward[n] = std::uint8_t(tables.forward[n] | 1U << 2 * bit);
      tables.backward[n] = std::uint8_t(tables.backward[n] | 128U >> 2 * bit);
    }
  }
  return tables;
}();
// `half`: 0 the first four segments of a side, 1 the last.
std::uint32_t half_side(std::uint8_t crossings, unsigned half,
                        const std::array<std::uint8_t, 16>& spread) {
  return spread[crossings >> (4 * half) & 15U];
}

// Red, green, blue and 1, whose sums with weights are made as one vector.
struct alignas(16) CountedColor {
  std::array<float, 4> rgb1;
};

struct Subpixels {
  std::array<PixelCode, 4> middle{};  // the pixel's own, row after row
  std::array<Word, 4> primary{}, secondary{};
  // Whose primary region's colour is known, and what it counts; of the others these are anything.
  Word known = 0;
  std::array<CountedColor, kSubpixelBits> color;
  std::array<float, kSubpixelBits> weight;
};

// What crosses a pixel's sides and middle lines.
struct PixelLines {
  std::uint8_t top, mid_row, bottom, left, mid_column, right;

  [[nodiscard]] bool any() const {
    return (top | mid_row | bottom | left | mid_column | right) != 0;
  }
  // Of a subpixel, as boundary_mask() has them.
  [[nodiscard]] std::uint32_t boundary(unsigned column, unsigned row) const {
    return half_side(row == 0 ? top : mid_row, column, kSpread.forward) |
           half_side(column == 0 ? mid_column : right, row, kSpread.forward) << 8U |
           half_side(row == 0 ? mid_row : bottom, column, kSpread.backward) << 16U |
           half_side(column == 0 ? left : mid_column, row, kSpread.backward) << 24U;
  }
};

class Builder {
 public:
  Builder(const EdgePointImage& image, int x, int y, const ComplexPixelColors& colors)
      : image_(image), x_(x), y_(y), colors_(colors) {
    build();
  }

  [[nodiscard]] const Subpixels& subpixels() const { return out_; }
  // All four of the pixel's own are.
  [[nodiscard]] bool is_all_complex() const {
    return std::ranges::all_of(out_.middle, [](PixelCode code) { return code.is_complex(); });
  }

 private:
  void build() {
    add_pixel(1, 1);
    // Then nothing around is of use.
    if (is_all_complex()) return;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        if (i == 1 && j == 1) continue;
        const int px = x_ - 1 + i, py = y_ - 1 + j;
        if (px < 0 || py < 0 || px >= image_.width_px || py >= image_.height_px) continue;
        add_pixel(i, j);
      }
    }
    for (Word& corner : out_.primary) corner |= empty_;
  }

  void add_pixel(int i, int j) {
    const int px = x_ - 1 + i, py = y_ - 1 + j;
    const Crossings& c = image_.crossings;
    const PixelLines lines{c.upper.row(py)[px], c.mid_row.row(py)[px],    c.upper.row(py + 1)[px],
                           c.left.row(py)[px],  c.mid_column.row(py)[px], c.left.row(py)[px + 1]};
    const PointKey point = image_.points[image_.offset(px, py)];
    const unsigned point_column = point.cell() % 4 / 2, point_row = point.cell() / 8;
    const int bit = bit_of(2 * i, 2 * j);
    if (!lines.any()) {
      empty_ |= (Word{3} | Word{3} << unsigned(kRow)) << unsigned(bit);
      for (const int at : {bit, bit + 1, bit + kRow, bit + kRow + 1}) set_primary(at, px, py);
      if (!point.is_none()) set_sample(bit + bit_of(int(point_column), int(point_row)), px, py);
      return;
    }
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned column = k % 2, row = k / 2;
      const int at = bit + bit_of(int(column), int(row));
      const std::uint32_t boundary = lines.boundary(column, row);
      const bool has_point = !point.is_none() && point_column == column && point_row == row;
      if (boundary == 0) {
        empty_ |= Word{1} << unsigned(at);
        if (has_point) {
          set_sample(at, px, py);
        } else if (lies_in_primary(px, py, column, row)) {
          set_primary(at, px, py);
        }
        continue;
      }
      PixelCode code(classify_boundary(boundary));
      const RegionOf region = has_point ? region_of(code, point.cell()) : RegionOf::ambiguous;
      if (code.is_simple()) {
        code.set_primary(region == RegionOf::ambiguous ? tables_.area_a[code.edge()] > 0.5F
                                                       : region == RegionOf::a);
      }
      if (region != RegionOf::ambiguous) set_sample(at, px, py);
      if (i == 1 && j == 1) out_.middle[k] = code;
      add_corners(code, at);
    }
  }

  // Of a subpixel that edges cross.
  void add_corners(PixelCode code, int bit) {
    if (code.is_complex()) return;
    const std::uint32_t in_primary =
        tables_.corners_a[code.edge()] ^ (code.primary_is_a() ? 0U : 15U);
    for (unsigned k = 0; k < 4; ++k) {
      const Word is_primary = in_primary >> k & 1U;
      out_.primary[k] |= is_primary << unsigned(bit);
      out_.secondary[k] |= (is_primary ^ 1U) << unsigned(bit);
    }
  }

  void set_sample(int bit, int px, int py) {
    Rgb color = color_at(colors_.samples.row(py), px);
    if (colors_.tints != nullptr) {
      color = tinted(color, color_at(colors_.painted->row(py), px), colors_.tints->at(px, py));
    }
    set_color(bit, color, 1);
  }
  // As interpolated.
  void set_primary(int bit, int px, int py) {
    const PrimaryNeighborhood& around = colors_.around;
    const PrimaryRows& row = py < y_ ? around.above : py > y_ ? around.below : around.here;
    if (row.weight[px] > 0) set_color(bit, color_at(row.color, px), std::min(row.weight[px], 1.0F));
  }
  void set_color(int bit, Rgb color, float weight) {
    out_.known |= Word{1} << unsigned(bit);
    out_.color[std::size_t(bit)].rgb1 = {color.x, color.y, color.z, 1};
    out_.weight[std::size_t(bit)] = weight;
  }

  // Whether a subpixel that no edge crosses lies in its pixel's primary region.
  [[nodiscard]] bool lies_in_primary(int px, int py, unsigned column, unsigned row) const {
    const PixelCode whole = image_.codes[image_.offset(px, py)];
    if (!whole.is_simple()) return whole.is_empty();
    const std::uint32_t first = 8 * row + 2 * column;
    const RegionOf primary = whole.primary_is_a() ? RegionOf::a : RegionOf::b;
    for (const std::uint32_t cell : {first, first + 1, first + 4, first + 5}) {
      if (tables_.region_of(whole.edge(), cell) != primary) return false;
    }
    return true;
  }

  // Of a point that lies in a subpixel that edges cross, to a quarter of it: each quarter is four cells of the tables.
  [[nodiscard]] RegionOf region_of(PixelCode code, std::uint32_t cell) const {
    if (code.is_complex()) return RegionOf::ambiguous;
    const std::uint32_t first = 8 * (cell / 4 % 2) + 2 * (cell % 2);
    const RegionOf region = tables_.region_of(code.edge(), first);
    for (const std::uint32_t other : {first + 1, first + 4, first + 5}) {
      if (tables_.region_of(code.edge(), other) != region) return RegionOf::ambiguous;
    }
    return region;
  }

  const EdgePointImage& image_;
  int x_, y_;
  const ComplexPixelColors& colors_;
  const EdgeTables& tables_ = edge_tables();
  Word empty_ = 0;  // subpixels without edges: all their corners are of their primary region
  Subpixels out_;
};

using Matrices = HWY_NAMESPACE::Reach<Word>;

Matrices find_matrices(const Subpixels& s) {
  using HWY_NAMESPACE::CornerRegions;
  const auto corner = [&](std::size_t k, int dx, int dy) {
    return CornerRegions<Word>{shifted(s.primary[k], dx, dy), shifted(s.secondary[k], dx, dy)};
  };
  const auto right = [&](int dx, int dy) {
    return HWY_NAMESPACE::reach_across(corner(1, dx, dy), corner(2, dx, dy), corner(0, dx + 1, dy),
                                       corner(3, dx + 1, dy));
  };
  const auto down = [&](int dx, int dy) {
    return HWY_NAMESPACE::reach_across(corner(3, dx, dy), corner(2, dx, dy), corner(0, dx, dy + 1),
                                       corner(1, dx, dy + 1));
  };
  return HWY_NAMESPACE::chain_reach<Word>(right, down);
}

// The subpixel itself, then each offset of kReachOffset and its opposite: sums are always made in this order.
constexpr std::size_t kSubpixelSteps = 1 + 2 * kReachOffsets;
struct SubpixelTap {
  int step;
  float kernel;
};
constexpr auto kSubpixelTaps = [] {
  std::array<SubpixelTap, kSubpixelSteps> taps{};
  taps[0] = {0, kernel_weight(0, 0)};
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const auto [dx, dy] = kReachOffset[k];
    taps[2 * k + 1] = {bit_of(dx, dy), kernel_weight(dx, dy)};
    taps[2 * k + 2] = {-bit_of(dx, dy), kernel_weight(dx, dy)};
  }
  return taps;
}();

// Of a middle subpixel: all its taps are bits of the word.
std::optional<Rgb> region_color(const Subpixels& s, const Matrices& matrices, int bit,
                                bool of_primary) {
  // Which taps count can't be guessed, so they are found without a branch.
  Word taps = of_primary ? s.known >> unsigned(bit) & 1U : 0;
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const int step = kSubpixelTaps[2 * k + 1].step;
    const auto& m = matrices[k];
    const Word there = of_primary ? m.pp : m.sp, back = of_primary ? m.pp : m.ps;
    taps |= (there >> unsigned(bit) & s.known >> unsigned(bit + step) & 1U) << (2 * k + 1);
    taps |= ((back & s.known) >> unsigned(bit - step) & 1U) << (2 * k + 2);
  }
  std::array<float, 4> sum{};
  for (; taps != 0; taps &= taps - 1) {
    const SubpixelTap& tap = kSubpixelTaps[std::size_t(std::countr_zero(taps))];
    const auto at = std::size_t(bit + tap.step);
    const float w = tap.kernel * s.weight[at];
    for (std::size_t c = 0; c < 4; ++c) sum[c] += s.color[at].rgb1[c] * w;
  }
  const float weight = sum[3];
  if (!(weight > 0)) return std::nullopt;
  return Rgb{sum[0], sum[1], sum[2]} * (1 / weight);
}

}  // namespace

Rgb reconstruct_complex_pixel(const EdgePointImage& image, int x, int y,
                              const ComplexPixelColors& colors) {
  const Builder builder(image, x, y, colors);
  const Subpixels& s = builder.subpixels();
  const Rgb fallback = colors.fallback;
  const Matrices matrices =
      s.known != 0 && !builder.is_all_complex() ? find_matrices(s) : Matrices{};
  Rgb sum;
  for (int k = 0; k < 4; ++k) {
    const int bit = bit_of(2 + k % 2, 2 + k / 2);
    const PixelCode code = s.middle[std::size_t(k)];
    if (code.is_complex()) {
      sum += fallback;
      continue;
    }
    const Rgb primary = region_color(s, matrices, bit, true).value_or(fallback);
    if (code.is_empty()) {
      sum += primary;
      continue;
    }
    const Rgb secondary = region_color(s, matrices, bit, false).value_or(fallback);
    const float area_a = edge_tables().area_a[code.edge()];
    const float area = code.primary_is_a() ? area_a : 1 - area_a;
    sum += primary * area + secondary * (1 - area);
  }
  return sum * 0.25F;
}

}  // namespace arris
