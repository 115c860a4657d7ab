#include "edgepoint/complex_pixel.h"

#include <array>
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

struct Subpixels {
  std::array<PixelCode, 4> middle{};  // the pixel's own, row after row
  std::array<Word, 4> primary{}, secondary{};
  struct Sample {
    int bit;
    Rgb color;
  };
  std::array<Sample, 9> samples;  // row of subpixels after row
  std::size_t sample_count = 0;
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
  Builder(const EdgePointImage& image, int x, int y, ColorRows& samples)
      : image_(image), x_(x), y_(y), samples_(samples) {}

  Subpixels build() {
    for (int j = 0; j < 3; ++j) {
      std::array<bool, 12> is_sample{};
      for (int i = 0; i < 3; ++i) {
        const int px = x_ - 1 + i, py = y_ - 1 + j;
        if (px < 0 || py < 0 || px >= image_.width_px || py >= image_.height_px) continue;
        add_pixel(i, j, is_sample);
      }
      add_samples(j, is_sample);
    }
    for (Word& corner : out_.primary) corner |= empty_;
    return out_;
  }

 private:
  // is_sample: by the row of subpixels and the pixel.
  void add_pixel(int i, int j, std::array<bool, 12>& is_sample) {
    const int px = x_ - 1 + i, py = y_ - 1 + j;
    const Crossings& c = image_.crossings;
    const PixelLines lines{c.upper.row(py)[px], c.mid_row.row(py)[px],    c.upper.row(py + 1)[px],
                           c.left.row(py)[px],  c.mid_column.row(py)[px], c.left.row(py)[px + 1]};
    const PointKey point = image_.points[image_.offset(px, py)];
    const unsigned point_column = point.cell() % 4 / 2, point_row = point.cell() / 8;
    const auto sample_at = std::size_t(6 * point_row) + std::size_t(i);
    const int bit = bit_of(2 * i, 2 * j);
    if (!lines.any()) {
      empty_ |= (Word{3} | Word{3} << unsigned(kRow)) << unsigned(bit);
      is_sample[sample_at] = !point.is_none();
      return;
    }
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned column = k % 2, row = k / 2;
      const std::uint32_t boundary = lines.boundary(column, row);
      const bool has_point = !point.is_none() && point_column == column && point_row == row;
      if (boundary == 0) {
        empty_ |= Word{1} << unsigned(bit + bit_of(int(column), int(row)));
        if (has_point) is_sample[sample_at] = true;
        continue;
      }
      PixelCode code(classify_boundary(boundary));
      const RegionOf region = has_point ? region_of(code, point.cell()) : RegionOf::ambiguous;
      if (code.is_simple()) {
        code.set_primary(region == RegionOf::ambiguous ? tables_.area_a[code.edge()] > 0.5F
                                                       : region == RegionOf::a);
      }
      if (region != RegionOf::ambiguous) is_sample[sample_at] = true;
      if (i == 1 && j == 1) out_.middle[k] = code;
      add_corners(code, bit + bit_of(int(column), int(row)));
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

  // Of a row of pixels, by rows of subpixels.
  void add_samples(int j, const std::array<bool, 12>& is_sample) {
    const int py = y_ - 1 + j;
    for (int row = 0; row < 2; ++row) {
      for (int i = 0; i < 3; ++i) {
        if (!is_sample[std::size_t(6 * row) + std::size_t(i)]) continue;
        const int px = x_ - 1 + i;
        const std::uint32_t cell = image_.points[image_.offset(px, py)].cell();
        const ColorRow colors = samples_.row(py);
        out_.samples[out_.sample_count++] = {bit_of(2 * i + int(cell % 4 / 2), 2 * j + row),
                                             {colors.r[px], colors.g[px], colors.b[px]}};
      }
    }
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
  ColorRows& samples_;
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

// By 5 (dy + 2) + dx + 2: the place in kReachOffset of an offset or its opposite; of the middle none.
struct OffsetPlace {
  std::uint8_t place = 0;
  bool opposite = false;
};
constexpr auto kOffsetPlaces = [] {
  std::array<OffsetPlace, 25> places{};
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const int at = 5 * kReachOffset[k].dy + kReachOffset[k].dx;
    places[std::size_t(12 + at)] = {std::uint8_t(k), false};
    places[std::size_t(12 - at)] = {std::uint8_t(k), true};
  }
  return places;
}();

// Whether a region of one subpixel reaches the primary region of another.
bool reaches(const Matrices& matrices, int from, int to, bool from_primary) {
  const int dx = to % kRow - from % kRow, dy = to / kRow - from / kRow;
  if (dx == 0 && dy == 0) return from_primary;
  if (dx < -2 || dx > 2 || dy < -2 || dy > 2) return false;
  const OffsetPlace offset = kOffsetPlaces[std::size_t(12 + 5 * dy + dx)];
  const HWY_NAMESPACE::ReachMatrix<Word>& m = matrices[offset.place];
  const Word reached = from_primary ? m.pp : offset.opposite ? m.ps : m.sp;
  return (reached >> unsigned(offset.opposite ? to : from) & 1U) != 0;
}

std::optional<Rgb> region_color(const Subpixels& s, const Matrices& matrices, int bit,
                                bool of_primary) {
  Rgb sum;
  float weight = 0;
  for (std::size_t i = 0; i < s.sample_count; ++i) {
    const int at = s.samples[i].bit;
    if (!reaches(matrices, bit, at, of_primary)) continue;
    const float w = kernel_weight(at % kRow - bit % kRow, at / kRow - bit / kRow);
    sum += s.samples[i].color * w;
    weight += w;
  }
  if (!(weight > 0)) return std::nullopt;
  return sum * (1 / weight);
}

}  // namespace

Rgb reconstruct_complex_pixel(const EdgePointImage& image, int x, int y, ColorRows& samples,
                              Rgb fallback) {
  const Subpixels s = Builder(image, x, y, samples).build();
  const Matrices matrices = s.sample_count > 0 ? find_matrices(s) : Matrices{};
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
