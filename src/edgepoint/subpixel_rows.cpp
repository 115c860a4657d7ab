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

// The region that four of the sixteen cells of a pixel lie in, the first and those right of it and below. The two bits
// of each are looked at together.
RegionOf region_of_four(std::uint32_t cells, std::uint32_t first) {
  const std::uint32_t four = cells >> (2 * first) & 0xf0fU;
  return four == 0 ? RegionOf::a : four == 0x505U ? RegionOf::b : RegionOf::ambiguous;
}

// Of four, row after row.
unsigned subpixel_of(PointKey point) {
  return point.cell() / 8 * 2 + point.cell() % 4 / 2;
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

// Which corners are in the primary region (the four lower bits) and the secondary one, as bits 0 and 4 of a byte each.
constexpr auto kCornerBytes = [] {
  std::array<std::uint32_t, 256> table{};
  for (unsigned n = 0; n < 256; ++n) {
    for (unsigned corner = 0; corner < 4; ++corner) {
      table[n] |= ((n >> corner & 1U) | (n >> (4 + corner) & 1U) << 4U) << 8 * corner;
    }
  }
  return table;
}();

// A subpixel without its point.
struct SubpixelKind {
  PixelCode code;
  std::uint8_t corners = 0;  // as in kCornerBytes

  void set_primary(bool is_a) {
    code.set_primary(is_a);
    const unsigned primary = edge_tables().corners_a[code.edge()] ^ (is_a ? 0U : 15U);
    corners = std::uint8_t(primary | (primary ^ 15U) << 4U);
  }
};

// How the four segments of a half side are crossed: by nothing, one of them, or more, which is all the same: of
// subpixels no two segments are neighbours, which would be merged (merge_coincident()). So that the tables are small.
constexpr unsigned kSideStates = 6;
constexpr auto kSideState = [] {
  std::array<std::uint8_t, 16> states{};
  for (unsigned n = 0; n < 16; ++n) {
    const int count = std::popcount(n);
    states[n] = std::uint8_t(count == 0 ? 0 : count == 1 ? 1 + std::countr_zero(n) : 5);
  }
  return states;
}();
constexpr std::array<unsigned, kSideStates> kCrossingsOfState{0, 1, 2, 4, 8, 3};

// What is found of each subpixel by its crossings and of each pixel by its code, found before.
struct SubpixelTables {
  // By the states of the sides: top + 6 (right + 6 (bottom + 6 left)).
  std::array<SubpixelKind, kSideStates * kSideStates * kSideStates * kSideStates> kinds;
  // Subpixels that lie in region A, and in region B, a bit each; by the pixel's code.
  std::array<std::uint8_t, kEdgeCodes> in_a{}, in_b{};
};

// Of the crossings of its sides, four bits each.
SubpixelKind kind_of(unsigned top, unsigned right, unsigned bottom, unsigned left) {
  const std::uint32_t boundary =
      std::uint32_t(kSpread.forward[top]) | std::uint32_t(kSpread.forward[right]) << 8U |
      std::uint32_t(kSpread.backward[bottom]) << 16U | std::uint32_t(kSpread.backward[left]) << 24U;
  SubpixelKind kind{PixelCode(classify_boundary(boundary))};
  if (kind.code.is_empty()) kind.corners = 15;
  if (kind.code.is_simple()) kind.set_primary(edge_tables().area_a[kind.code.edge()] > 0.5F);
  return kind;
}

const SubpixelTables& subpixel_tables() {
  static const SubpixelTables kTables = [] {
    SubpixelTables tables;
    for (unsigned i = 0; i < tables.kinds.size(); ++i) {
      const auto side = [&](unsigned divisor) {
        return kCrossingsOfState[i / divisor % kSideStates];
      };
      tables.kinds[i] = kind_of(side(1), side(6), side(36), side(216));
    }
    for (std::uint32_t edge = 0; edge < kEdgeCodes; ++edge) {
      if (!is_simple(edge)) continue;
      for (unsigned k = 0; k < 4; ++k) {
        const RegionOf region =
            region_of_four(edge_tables().cells[edge], 8 * (k / 2) + 2 * (k % 2));
        tables.in_a[edge] = std::uint8_t(tables.in_a[edge] | (region == RegionOf::a ? 1U << k : 0));
        tables.in_b[edge] = std::uint8_t(tables.in_b[edge] | (region == RegionOf::b ? 1U << k : 0));
      }
    }
    // All of a pixel that is crossed in its middle only.
    tables.in_b[kEmptyEdge] = 15;
    return tables;
  }();
  return kTables;
}

}  // namespace

// Of one row of pixels.
struct SubpixelRows::RowInput {
  int y;
  const SubpixelColors& colors;
  const SubpixelTables& tables;
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
                    subpixel_tables(),
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
  if (!point.is_none()) set_sample(in, x, subpixel_of(point), bits);
}

void SubpixelRows::add_crossed(const RowInput& in, int x, WordBits& bits) {
  const unsigned top = in.top[x], mid_row = in.mid_row[x], bottom = in.bottom[x], left = in.left[x],
                 mid_column = in.mid_column[x], right = in.left[x + 1];
  const auto kind = [&](unsigned of_top, unsigned of_right, unsigned of_bottom, unsigned of_left) {
    return in.tables.kinds[kSideState[of_top] + 6U * kSideState[of_right] +
                           36U * kSideState[of_bottom] + 216U * kSideState[of_left]];
  };
  std::array<SubpixelKind, 4> kinds{
      kind(top & 15U, mid_column & 15U, mid_row & 15U, left & 15U),
      kind(top >> 4U, right & 15U, mid_row >> 4U, mid_column & 15U),
      kind(mid_row & 15U, mid_column >> 4U, bottom & 15U, left >> 4U),
      kind(mid_row >> 4U, right >> 4U, bottom >> 4U, mid_column >> 4U)};
  const PixelCode whole = in.codes[x];
  unsigned in_primary = (whole.primary_is_a() ? in.tables.in_a : in.tables.in_b)[whole.edge()];
  for (unsigned k = 0; k < 4; ++k) {
    in_primary &= ~((kinds[k].code.is_empty() ? 0U : 1U) << k);
  }
  const PointKey point = in.points[x];
  if (!point.is_none()) {
    const unsigned k = subpixel_of(point);
    SubpixelKind& of_point = kinds[k];
    // In a subpixel that edges cross, its place is known to a quarter of it: four cells of the tables.
    const RegionOf region =
        of_point.code.is_simple()
            ? region_of_four(edge_tables().cells[of_point.code.edge()],
                             8 * (point.cell() / 4 % 2) + 2 * (point.cell() % 2))
            : RegionOf::ambiguous;
    if (region != RegionOf::ambiguous) of_point.set_primary(region == RegionOf::a);
    if (region != RegionOf::ambiguous || of_point.code.is_empty()) set_sample(in, x, k, bits);
    if (of_point.code.is_empty()) in_primary &= ~(1U << k);
  }
  for (; in_primary != 0; in_primary &= in_primary - 1) {
    set_primary(in, x, unsigned(std::countr_zero(in_primary)), bits);
  }
  const auto shift = unsigned(2 * x % 64);
  for (unsigned j = 0; j < 2; ++j) {
    const SubpixelKind first = kinds[2 * j], second = kinds[2 * j + 1];
    const std::uint32_t both = kCornerBytes[first.corners] | kCornerBytes[second.corners] << 1U;
    for (unsigned corner = 0; corner < 4; ++corner) {
      bits.primary[corner][j] |= Word{both >> 8 * corner & 3U} << shift;
      bits.secondary[corner][j] |= Word{both >> (8 * corner + 4) & 3U} << shift;
    }
    PixelCode* const codes = codes_.data() + place(2 * x, 2 * in.y + int(j));
    codes[0] = first.code;
    codes[1] = second.code;
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
