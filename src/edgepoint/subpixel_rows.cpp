#include "edgepoint/subpixel_rows.h"

#include <algorithm>
#include <bit>

#include "edgepoint/classify.h"

namespace arris {
namespace {

using Word = std::uint64_t;

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

// The region that four of the sixteen cells of a pixel lie in, the first and those right of it and below. The two bits
// of each are looked at together.
RegionOf region_of_four(std::uint32_t cells, std::uint32_t first) {
  const std::uint32_t four = cells >> (2 * first) & 0xf0fU;
  return four == 0 ? RegionOf::a : four == 0x505U ? RegionOf::b : RegionOf::ambiguous;
}

// Each of 32 bits twice.
Word doubled(Word bits) {
  bits = (bits | bits << 16U) & 0x0000ffff0000ffffU;
  bits = (bits | bits << 8U) & 0x00ff00ff00ff00ffU;
  bits = (bits | bits << 4U) & 0x0f0f0f0f0f0f0f0fU;
  bits = (bits | bits << 2U) & 0x3333333333333333U;
  bits = (bits | bits << 1U) & 0x5555555555555555U;
  return bits | bits << 1U;
}

// Four bits as the lowest of four bytes.
constexpr auto kBytes = [] {
  std::array<std::uint32_t, 16> table{};
  for (unsigned n = 0; n < 16; ++n) {
    for (unsigned bit = 0; bit < 4; ++bit) table[n] |= (n >> bit & 1U) << 8 * bit;
  }
  return table;
}();

}  // namespace

// Of one row of pixels.
struct SubpixelRows::RowInput {
  int y;
  const SubpixelColors& colors;
  const std::uint8_t *top, *mid_row, *bottom, *left, *mid_column;
  const PixelCode* codes;
  const PointKey* points;
};

// Of 32 pixels, a word in each of their two rows.
struct SubpixelRows::WordBits {
  Word plain = 0, plain_known = 0;  // bits of pixels
  std::array<std::array<Word, 2>, 4> primary{}, secondary{};
  std::array<Word, 2> known{};
};

SubpixelRows::SubpixelRows(const EdgePointImage& image)
    : image_(image),
      stride_(std::size_t(subpixel_width(image.width_px))),
      planes_(image.width_px),
      codes_(stride_ * kSubpixelRows),
      colors_(codes_.size()),
      weights_(codes_.size()) {}

void SubpixelRows::clear(int y) {
  for (int word = 0; word < planes_.known.words(); ++word) store({}, y, word);
}

void SubpixelRows::fill(int y, std::span<const std::uint64_t> wanted,
                        const SubpixelColors& colors) {
  const Crossings& c = image_.crossings;
  const std::size_t start = image_.offset(0, y);
  const RowInput in{y,
                    colors,
                    c.upper.row(y),
                    c.mid_row.row(y),
                    c.upper.row(y + 1),
                    c.left.row(y),
                    c.mid_column.row(y),
                    image_.codes.data() + start,
                    image_.points.data() + start};
  for (int word = 0; word < planes_.known.words(); ++word) {
    WordBits bits;
    Word rest = wanted[std::size_t(word / 2)] >> (word % 2 == 0 ? 0U : 32U) & 0xffffffffU;
    for (; rest != 0; rest &= rest - 1) {
      const int x = 32 * word + std::countr_zero(rest);
      if ((in.top[x] | in.mid_row[x] | in.bottom[x] | in.left[x] | in.mid_column[x] |
           in.left[x + 1]) == 0) {
        add_plain(in, x, bits);
      } else {
        add_crossed(in, x, bits);
      }
    }
    store(bits, y, word);
  }
}

// Subpixels without edges: all their corners are of their primary region.
void SubpixelRows::store(const WordBits& bits, int y, int word) {
  const Word plain = doubled(bits.plain), plain_known = doubled(bits.plain_known);
  for (int j = 0; j < 2; ++j) {
    const int row = subpixel_ring(2 * y + j);
    const auto of = [&](const std::array<Word, 2>& words) { return words[std::size_t(j)]; };
    for (std::size_t k = 0; k < 4; ++k) {
      planes_.corners.primary[k].row(row)[word] = of(bits.primary[k]) | plain;
      planes_.corners.secondary[k].row(row)[word] = of(bits.secondary[k]);
    }
    planes_.known.row(row)[word] = of(bits.known) | plain_known;
  }
}

// A pixel without edges.
void SubpixelRows::add_plain(const RowInput& in, int x, WordBits& bits) {
  const Word bit = Word{1} << unsigned(x % 32);
  bits.plain |= bit;
  const float weight = in.colors.primary.weight[x];
  if (weight > 0) {
    bits.plain_known |= bit;
    const Rgb color = color_at(in.colors.primary.color, x);
    for (int k = 0; k < 4; ++k) {
      set_color(place(2 * x + k % 2, 2 * in.y + k / 2), color, std::min(weight, 1.0F));
    }
  }
  const PointKey point = in.points[x];
  if (!point.is_none()) set_sample(in, x, point.cell() / 8 * 2 + point.cell() % 4 / 2, bits);
}

void SubpixelRows::add_crossed(const RowInput& in, int x, WordBits& bits) {
  const EdgeTables& tables = edge_tables();
  const PixelLines lines{in.top[x],  in.mid_row[x],    in.bottom[x],
                         in.left[x], in.mid_column[x], in.left[x + 1]};
  const PointKey point = in.points[x];
  // The subpixel that it is in, of which there are four.
  const unsigned in_subpixel = point.is_none() ? 4 : point.cell() / 8 * 2 + point.cell() % 4 / 2;
  std::array<std::uint32_t, 4> primary{}, secondary{};  // corners of each subpixel
  for (unsigned k = 0; k < 4; ++k) {
    const unsigned column = k % 2, row = k / 2;
    const std::uint32_t boundary = lines.boundary(column, row);
    PixelCode code(classify_boundary(boundary));
    if (boundary == 0) {
      primary[k] = 15;
      if (k == in_subpixel) {
        set_sample(in, x, k, bits);
      } else {
        const PixelCode whole = in.codes[x];
        const RegionOf of_whole = whole.primary_is_a() ? RegionOf::a : RegionOf::b;
        const bool in_primary = whole.is_simple() ? region_of_four(tables.cells[whole.edge()],
                                                                   8 * row + 2 * column) == of_whole
                                                  : whole.is_empty();
        if (in_primary) set_primary(in, x, k, bits);
      }
    } else if (!code.is_complex()) {
      // Of a point that lies in a subpixel that edges cross, to a quarter of it: each quarter is four cells of the
      // tables.
      const RegionOf region =
          k == in_subpixel ? region_of_four(tables.cells[code.edge()],
                                            8 * (point.cell() / 4 % 2) + 2 * (point.cell() % 2))
                           : RegionOf::ambiguous;
      const bool primary_is_a =
          region == RegionOf::ambiguous ? tables.area_a[code.edge()] > 0.5F : region == RegionOf::a;
      code.set_primary(primary_is_a);
      if (region != RegionOf::ambiguous) set_sample(in, x, k, bits);
      primary[k] = tables.corners_a[code.edge()] ^ (primary_is_a ? 0U : 15U);
      secondary[k] = primary[k] ^ 15U;
    }
    codes_[std::size_t(place(2 * x + int(column), 2 * in.y + int(row)))] = code;
  }
  const auto shift = unsigned(2 * x % 64);
  for (std::size_t j = 0; j < 2; ++j) {
    const std::uint32_t p = kBytes[primary[2 * j]] | kBytes[primary[2 * j + 1]] << 1U;
    const std::uint32_t s = kBytes[secondary[2 * j]] | kBytes[secondary[2 * j + 1]] << 1U;
    for (unsigned corner = 0; corner < 4; ++corner) {
      bits.primary[corner][j] |= Word{p >> 8 * corner & 3U} << shift;
      bits.secondary[corner][j] |= Word{s >> 8 * corner & 3U} << shift;
    }
  }
}

// Of subpixel k of a pixel, row after row.
void SubpixelRows::set_sample(const RowInput& in, int x, unsigned k, WordBits& bits) {
  Rgb color = color_at(in.colors.samples, x);
  if (in.colors.tints != nullptr) {
    color = tinted(color, color_at(in.colors.painted, x), in.colors.tints->at(x, in.y));
  }
  bits.known[k / 2] |= Word{1} << (unsigned(2 * x % 64) + k % 2);
  set_color(place(2 * x + int(k % 2), 2 * in.y + int(k / 2)), color, 1);
}

// As interpolated.
void SubpixelRows::set_primary(const RowInput& in, int x, unsigned k, WordBits& bits) {
  const float weight = in.colors.primary.weight[x];
  if (!(weight > 0)) return;
  bits.known[k / 2] |= Word{1} << (unsigned(2 * x % 64) + k % 2);
  set_color(place(2 * x + int(k % 2), 2 * in.y + int(k / 2)), color_at(in.colors.primary.color, x),
            std::min(weight, 1.0F));
}

void SubpixelRows::set_color(std::ptrdiff_t place, Rgb color, float weight) {
  colors_[std::size_t(place)].rgb1 = {color.x, color.y, color.z, 1};
  weights_[std::size_t(place)] = weight;
}

}  // namespace arris
