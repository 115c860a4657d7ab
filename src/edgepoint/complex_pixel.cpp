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
  struct Sample {
    int bit;
    Rgb color;
  };
  std::array<Sample, 9> samples;
  std::size_t sample_count = 0;
};

class Builder {
 public:
  Builder(const EdgePointImage& image, int x, int y, const ComplexPixelColors& colors)
      : image_(image), x_(x), y_(y), colors_(colors) {}

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
      const ColorRow row = colors_.samples.row(py);
      Rgb color{row.r[px], row.g[px], row.b[px]};
      if (colors_.tints != nullptr) color *= colors_.tints->at(px, py);
      out_.samples[out_.sample_count++] = {bit, color};
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
  const ComplexPixelColors& colors_;
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

// Whether a region of one subpixel reaches the primary region of another.
bool reaches(const Matrices& matrices, int from, int to, bool from_primary) {
  const int dx = to % kRow - from % kRow, dy = to / kRow - from / kRow;
  if (dx == 0 && dy == 0) return from_primary;
  if (dx < -2 || dx > 2 || dy < -2 || dy > 2) return false;
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    if (kReachOffset[k].dx == dx && kReachOffset[k].dy == dy) {
      return ((from_primary ? matrices[k].pp : matrices[k].sp) >> unsigned(from) & 1U) != 0;
    }
    if (kReachOffset[k].dx == -dx && kReachOffset[k].dy == -dy) {
      return ((from_primary ? matrices[k].pp : matrices[k].ps) >> unsigned(to) & 1U) != 0;
    }
  }
  return false;
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

Rgb reconstruct_complex_pixel(const EdgePointImage& image, int x, int y,
                              const ComplexPixelColors& colors) {
  const Subpixels s = Builder(image, x, y, colors).build();
  const Rgb fallback = colors.fallback;
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
