#include "edgepoint/complex_pixel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "edgepoint/classify.h"
#include "edgepoint/kernel.h"
#include "edgepoint/reach_chain-inl.h"

namespace arris {
namespace {

constexpr int kSide = 6;  // subpixels
constexpr int kRow = 8;  // bits of a row: two stay 0, so that nothing is shifted in from other rows
using Word = std::uint64_t;

constexpr int bit_of(int i, int j) {
  return j * kRow + i;
}

// The word as it is for the subpixel at an offset.
Word shifted(Word word, int dx, int dy) {
  const int by = bit_of(dx, dy);
  return by >= 0 ? word >> unsigned(by) : word << unsigned(-by);
}

// Four segments of half a side as eight of a whole one.
std::uint8_t spread(std::uint32_t nibble) {
  return std::uint8_t((nibble & 1U) | (nibble & 2U) << 1U | (nibble & 4U) << 2U |
                      (nibble & 8U) << 3U);
}

struct Subpixels {
  std::array<std::uint16_t, std::size_t(kSide* kRow)> edge{};
  std::array<bool, std::size_t(kSide* kRow)> primary_is_a{};
  std::array<Word, 4> primary{}, secondary{};
  // Whose primary region's colour is known, and what it counts.
  Word known = 0;
  std::array<Rgb, std::size_t(kSide* kRow)> color;
  std::array<float, std::size_t(kSide* kRow)> weight{};
};

class Builder {
 public:
  Builder(const EdgePointImage& image, int x, int y, ColorRows& samples,
          const PrimaryNeighborhood& around)
      : image_(image), x_(x), y_(y), samples_(samples), around_(around) {}

  Subpixels build() {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const int px = x_ - 1 + i / 2, py = y_ - 1 + j / 2;
        if (px < 0 || py < 0 || px >= image_.width_px || py >= image_.height_px) continue;
        add(i, j);
      }
    }
    return out_;
  }

 private:
  // Crossings of the upper side of a subpixel, also of those just below the block.
  [[nodiscard]] std::uint8_t upper(int i, int j) const {
    const int px = x_ - 1 + i / 2, py = y_ - 1 + j / 2;
    const CrossingRows& rows = j % 2 == 0 ? image_.crossings.upper : image_.crossings.mid_row;
    return spread(std::uint32_t(rows.row(py)[px]) >> unsigned(4 * (i % 2)));
  }
  [[nodiscard]] std::uint8_t left(int i, int j) const {
    const int px = x_ - 1 + i / 2, py = y_ - 1 + j / 2;
    const CrossingRows& rows = i % 2 == 0 ? image_.crossings.left : image_.crossings.mid_column;
    return spread(std::uint32_t(rows.row(py)[px]) >> unsigned(4 * (j % 2)));
  }

  void add(int i, int j) {
    const int bit = bit_of(i, j);
    const int px = x_ - 1 + i / 2, py = y_ - 1 + j / 2;
    PixelCode code(classify_boundary(
        boundary_mask({upper(i, j), left(i + 1, j), upper(i, j + 1), left(i, j)})));
    const PointKey point = image_.points[image_.offset(px, py)];
    const bool has_point =
        !point.is_none() && int(point.cell() % 4 / 2) == i % 2 && int(point.cell() / 8) == j % 2;
    const RegionOf region = has_point ? region_of(code, point.cell()) : RegionOf::ambiguous;
    if (code.is_simple()) {
      code.set_primary(region == RegionOf::ambiguous ? edge_tables().area_a[code.edge()] > 0.5F
                                                     : region == RegionOf::a);
    }
    if (has_point && region != RegionOf::ambiguous) {
      set_color(bit, samples_.row(py), px, 1);
    } else if (!code.is_complex() && lies_in_primary(px, py, i, j, code)) {
      const PrimaryRows& row = py < y_ ? around_.above : py > y_ ? around_.below : around_.here;
      if (row.weight[px] > 0) set_color(bit, row.color, px, std::min(row.weight[px], 1.0F));
    }
    out_.edge[std::size_t(bit)] = std::uint16_t(code.edge());
    out_.primary_is_a[std::size_t(bit)] = code.primary_is_a();
    if (code.is_complex()) return;
    std::uint32_t in_primary = 15;
    if (code.is_simple()) {
      in_primary = edge_tables().corners_a[code.edge()] ^ (code.primary_is_a() ? 0U : 15U);
    }
    for (unsigned k = 0; k < 4; ++k) {
      const Word is_primary = in_primary >> k & 1U;
      out_.primary[k] |= is_primary << unsigned(bit);
      out_.secondary[k] |= (is_primary ^ 1U) << unsigned(bit);
    }
  }

  void set_color(int bit, ColorRow row, int px, float weight) {
    out_.known |= Word{1} << unsigned(bit);
    out_.color[std::size_t(bit)] = {row.r[px], row.g[px], row.b[px]};
    out_.weight[std::size_t(bit)] = weight;
  }

  // Whether what is primary of a subpixel is part of what is primary of its pixel.
  [[nodiscard]] bool lies_in_primary(int px, int py, int i, int j, PixelCode sub) const {
    const PixelCode whole = image_.codes[image_.offset(px, py)];
    if (whole.is_complex()) return false;
    if (whole.is_empty()) return sub.is_empty();
    if (!sub.is_empty()) return false;
    const EdgeTables& tables = edge_tables();
    const std::uint32_t first = 8U * unsigned(j % 2) + 2U * unsigned(i % 2);
    const RegionOf primary = whole.primary_is_a() ? RegionOf::a : RegionOf::b;
    for (const std::uint32_t cell : {first, first + 1, first + 4, first + 5}) {
      if (tables.region_of(whole.edge(), cell) != primary) return false;
    }
    return true;
  }

  // Of a point that lies in the subpixel, to a quarter of it: each quarter is four cells of the tables.
  static RegionOf region_of(PixelCode code, std::uint32_t cell) {
    if (code.is_empty()) return RegionOf::b;
    if (code.is_complex()) return RegionOf::ambiguous;
    const std::uint32_t first = 8 * (cell / 4 % 2) + 2 * (cell % 2);
    const EdgeTables& tables = edge_tables();
    const RegionOf region = tables.region_of(code.edge(), first);
    for (const std::uint32_t other : {first + 1, first + 4, first + 5}) {
      if (tables.region_of(code.edge(), other) != region) return RegionOf::ambiguous;
    }
    return region;
  }

  const EdgePointImage& image_;
  int x_, y_;
  ColorRows& samples_;
  const PrimaryNeighborhood& around_;
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

std::optional<Rgb> region_color(const Subpixels& s, const Matrices& matrices, int bit,
                                bool of_primary) {
  Rgb sum;
  float weight = 0;
  const auto add = [&](int at, float kernel) {
    const float w = kernel * s.weight[std::size_t(at)];
    sum += s.color[std::size_t(at)] * w;
    weight += w;
  };
  if (of_primary && (s.known >> unsigned(bit) & 1U)) add(bit, kernel_weight(0, 0));
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const auto [dx, dy] = kReachOffset[k];
    const int step = bit_of(dx, dy);
    const auto& m = matrices[k];
    const Word there = of_primary ? m.pp : m.sp, back = of_primary ? m.pp : m.ps;
    if ((there >> unsigned(bit) & s.known >> unsigned(bit + step) & 1U) != 0) {
      add(bit + step, kernel_weight(dx, dy));
    }
    if (bit >= step && (back & s.known) >> unsigned(bit - step) & 1U) {
      add(bit - step, kernel_weight(dx, dy));
    }
  }
  if (!(weight > 0)) return std::nullopt;
  return sum * (1 / weight);
}

}  // namespace

Rgb reconstruct_complex_pixel(const EdgePointImage& image, int x, int y, ColorRows& samples,
                              const PrimaryNeighborhood& around, Rgb fallback) {
  const Subpixels s = Builder(image, x, y, samples, around).build();
  const Matrices matrices = find_matrices(s);
  Rgb sum;
  for (int j = 2; j < 4; ++j) {
    for (int i = 2; i < 4; ++i) {
      const int bit = bit_of(i, j);
      const std::uint32_t edge = s.edge[std::size_t(bit)];
      if (edge == kComplexEdge) {
        sum += fallback;
        continue;
      }
      const Rgb primary = region_color(s, matrices, bit, true).value_or(fallback);
      if (edge == kEmptyEdge) {
        sum += primary;
        continue;
      }
      const Rgb secondary = region_color(s, matrices, bit, false).value_or(fallback);
      const float area_a = edge_tables().area_a[edge];
      const float area = s.primary_is_a[std::size_t(bit)] ? area_a : 1 - area_a;
      sum += primary * area + secondary * (1 - area);
    }
  }
  return sum * 0.25F;
}

}  // namespace arris
