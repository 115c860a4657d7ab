#include "edgepoint/hole_filler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "base/parallel_for.h"
#include "edgepoint/antialias.h"
#include "edgepoint/bit_plane.h"
#include "edgepoint/shifted_word.h"

namespace arris {
namespace {

struct Cell {
  Rgb sum;
  float count = 0;
};

Rgb color_of(const Image& picture, int x, int y) {
  const float* const color = picture.values.data() + picture.offset(x, y);
  return {color[0], color[1], color[2]};
}

constexpr int kFirstCell = 8;  // pixels

// Means over cells of the picture, of 8 × 8 pixels and of ever twice as many, made where they are asked for.
class Grids {
 public:
  Grids(const Image& picture, const BitPlane& holes) : picture_(picture), holes_(holes) {
    int width = (picture.width_px + kFirstCell - 1) / kFirstCell;
    int height = (picture.height_px + kFirstCell - 1) / kFirstCell;
    levels_.emplace_back(width, height);
    while (width > 1 || height > 1) {
      width = (width + 1) / 2;
      height = (height + 1) / 2;
      levels_.emplace_back(width, height);
    }
  }

  [[nodiscard]] std::size_t levels() const { return levels_.size(); }
  const Cell& at(std::size_t level, int x, int y) {
    Level& l = levels_[level];
    Cell& cell = l.cells[std::size_t(y) * std::size_t(l.width) + std::size_t(x)];
    if (cell.count == kUnknown) cell = level == 0 ? of_pixels(x, y) : of_cells(level - 1, x, y);
    return cell;
  }

 private:
  static constexpr float kUnknown = -1;
  struct Level {
    int width, height;
    std::vector<Cell> cells;

    Level(int w, int h)
        : width(w), height(h), cells(std::size_t(w) * std::size_t(h), Cell{{}, kUnknown}) {}
  };

  [[nodiscard]] Cell of_pixels(int cell_x, int cell_y) const {
    Cell cell;
    const int x0 = cell_x * kFirstCell, y0 = cell_y * kFirstCell;
    for (int y = y0; y < std::min(y0 + kFirstCell, picture_.height_px); ++y) {
      for (int x = x0; x < std::min(x0 + kFirstCell, picture_.width_px); ++x) {
        if (holes_.at(x, y)) continue;
        cell.sum += color_of(picture_, x, y);
        ++cell.count;
      }
    }
    return cell;
  }

  Cell of_cells(std::size_t level, int cell_x, int cell_y) {
    Cell cell;
    const int x0 = 2 * cell_x, y0 = 2 * cell_y;
    for (int y = y0; y < std::min(y0 + 2, levels_[level].height); ++y) {
      for (int x = x0; x < std::min(x0 + 2, levels_[level].width); ++x) {
        const Cell& part = at(level, x, y);
        cell.sum += part.sum;
        cell.count += part.count;
      }
    }
    return cell;
  }

  const Image& picture_;
  const BitPlane& holes_;
  std::vector<Level> levels_;
};

// Steps of up to two pixels each.
constexpr int kSteps = 8;

void set_color(Image& picture, std::uint32_t pixel, Rgb color) {
  float* const out = picture.values.data() + 3 * std::size_t(pixel);
  out[0] = color.x;
  out[1] = color.y;
  out[2] = color.z;
}

// Pixels without a colour, and those whose colour others may take: not such as edges cross, which are mixtures, unless
// there are no others.
struct HolePlanes {
  BitPlane holes, usable;
};

void set_bit(BitPlane& plane, int x, int y, bool value) {
  const std::uint64_t bit = std::uint64_t{1} << unsigned(x & 63);
  std::uint64_t& word = plane.row(y)[x >> 6];
  word = value ? word | bit : word & ~bit;
}

HolePlanes make_planes(const EdgePointImage& image, std::span<const std::uint32_t> holes,
                       int threads) {
  HolePlanes planes{BitPlane(image.width_px, image.height_px),
                    BitPlane(image.width_px, image.height_px)};
  const auto& corners = image.corners.primary;
  parallel_for(std::size_t(image.height_px), {.grain = 128, .threads = threads},
               [&](std::size_t row) {
                 // All corners of an empty pixel are of its primary region, and of no other pixel.
                 const int y = int(row);
                 for (int word = 0; word < planes.usable.words(); ++word) {
                   planes.usable.row(y)[word] = corners[0].row(y)[word] & corners[1].row(y)[word] &
                                                corners[2].row(y)[word] & corners[3].row(y)[word];
                 }
               });
  for (const std::uint32_t hole : holes) {
    const int x = int(hole % std::uint32_t(image.width_px));
    const int y = int(hole / std::uint32_t(image.width_px));
    set_bit(planes.holes, x, y, true);
    set_bit(planes.usable, x, y, false);
  }
  return planes;
}

// For each offset of kReachOffset and its opposite: which of 64 pixels a usable colour reaches from there.
class UsableTaps {
 public:
  UsableTaps(const EdgePointImage& image, const BitPlane& usable, int y, int word) {
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      const auto [dx, dy] = kReachOffset[k];
      const BitPlane& reach = image.reach.planes[k];
      taps_[2 * k] = reach.row(y)[word] & shifted_word(usable.row(y + dy), word, dx);
      taps_[2 * k + 1] =
          shifted_word(reach.row(y - dy), word, -dx) & shifted_word(usable.row(y - dy), word, -dx);
    }
  }

  // Pixels that any reaches.
  [[nodiscard]] std::uint64_t any() const {
    std::uint64_t any = 0;
    for (const std::uint64_t tap : taps_) any |= tap;
    return any;
  }

  // The mean of the usable colours that reach a pixel, which is a bit of the word.
  [[nodiscard]] Rgb mean_of(const Image& picture, int x, int y) const {
    Cell cell;
    const auto add = [&](int px, int py) {
      cell.sum += color_of(picture, px, py);
      ++cell.count;
    };
    const unsigned bit = unsigned(x) & 63U;
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      const auto [dx, dy] = kReachOffset[k];
      if ((taps_[2 * k] >> bit & 1U) != 0) add(x + dx, y + dy);
      if ((taps_[2 * k + 1] >> bit & 1U) != 0) add(x - dx, y - dy);
    }
    return cell.sum * (1 / cell.count);
  }

 private:
  std::array<std::uint64_t, 2 * kReachOffsets> taps_;
};

// Of a row; and those of all holes.
struct HoleWord {
  int y, word;

  friend bool operator==(const HoleWord&, const HoleWord&) = default;
};
std::vector<HoleWord> words_of(const EdgePointImage& image, std::span<const std::uint32_t> holes) {
  std::vector<HoleWord> words;
  const auto width = std::uint32_t(image.width_px);
  for (const std::uint32_t hole : holes) {
    const HoleWord word{int(hole / width), int(hole % width / 64)};
    if (words.empty() || words.back() != word) words.push_back(word);
  }
  return words;
}
// That one thread looks at.
constexpr std::size_t kWordsAtOnce = 64;

struct FilledHole {
  int x, y;
  Rgb color;
};

// Leaves those holes that nothing reaches.
void spread_reached(const EdgePointImage& image, std::span<const HoleWord> words, int threads,
                    HolePlanes& planes, Image& picture) {
  std::vector<std::vector<FilledHole>> filled((words.size() + kWordsAtOnce - 1) / kWordsAtOnce);
  for (int step = 0; step < kSteps; ++step) {
    parallel_for(filled.size(), {.grain = 1, .threads = threads}, [&](std::size_t i) {
      filled[i].clear();
      const std::size_t first = i * kWordsAtOnce;
      for (const auto [y, word] :
           words.subspan(first, std::min(kWordsAtOnce, words.size() - first))) {
        const std::uint64_t holes = planes.holes.row(y)[word];
        if (holes == 0) continue;
        const UsableTaps taps(image, planes.usable, y, word);
        for (std::uint64_t reached = holes & taps.any(); reached != 0; reached &= reached - 1) {
          const int x = 64 * word + std::countr_zero(reached);
          filled[i].push_back({x, y, taps.mean_of(picture, x, y)});
        }
      }
    });
    bool any = false;
    for (const std::vector<FilledHole>& part : filled) {
      for (const FilledHole& hole : part) {
        set_color(picture, std::uint32_t(image.offset(hole.x, hole.y)), hole.color);
        set_bit(planes.holes, hole.x, hole.y, false);
        set_bit(planes.usable, hole.x, hole.y, true);
        any = true;
      }
    }
    if (!any) return;
  }
}

// All that have a colour and belong to a region: the narrow one between an outline and a shadow has pixels alone that
// edges cross.
void use_mixtures(const EdgePointImage& image, std::span<const HoleWord> words,
                  HolePlanes& planes) {
  const auto use_row = [&](int y, int word) {
    const std::uint64_t in_region =
        image.corners.primary[0].row(y)[word] | image.corners.secondary[0].row(y)[word];
    planes.usable.row(y)[word] = in_region & ~planes.holes.row(y)[word];
  };
  for (const auto [y, word] : words) {
    for (int row = std::max(0, y - 2); row <= std::min(image.height_px - 1, y + 2); ++row) {
      for (int w = std::max(0, word - 1); w <= std::min(planes.usable.words() - 1, word + 1); ++w) {
        use_row(row, w);
      }
    }
  }
}

// Mixes the colours of a simple pixel's regions, where one of them was a hole.
class EdgeMixer {
 public:
  struct Holes {
    const BitPlane& before;
    const BitPlane& not_of_region;  // those that did not take the colour of their primary region
    const BitPlane& left;
  };

  EdgeMixer(const EdgePointImage& image, const Holes& holes, const Image& picture)
      : image_(image), holes_(holes), picture_(picture) {}

  // A hole that was filled, and its neighbours.
  void add_around(int x, int y) {
    if (is_simple(x, y) && !holes_.not_of_region.at(x, y)) {
      mix(x, y, [&](int px, int py) { return !holes_.left.at(px, py); });
    }
    for (const PixelSide& side : kPixelSides) {
      const int nx = x + side.dx, ny = y + side.dy;
      if (nx < 0 || ny < 0 || nx >= image_.width_px || ny >= image_.height_px) continue;
      if (holes_.before.at(nx, ny) || !is_simple(nx, ny)) continue;
      const auto known = [&](int px, int py) { return !holes_.before.at(px, py); };
      if (find_secondary_neighbor(image_, nx, ny, known)) continue;
      mix(nx, ny, [&](int px, int py) { return px == x && py == y; });
    }
  }

  void finish(Image& picture) const {
    for (const FilledHole& pixel : mixed_) {
      set_color(picture, std::uint32_t(image_.offset(pixel.x, pixel.y)), pixel.color);
    }
  }

 private:
  [[nodiscard]] bool is_simple(int x, int y) const {
    return image_.codes[image_.offset(x, y)].is_simple();
  }

  template <class MayUse>
  void mix(int x, int y, const MayUse& may_use) {
    const std::optional<PixelPlace> other = find_secondary_neighbor(image_, x, y, may_use);
    if (!other) return;
    const float area = primary_area(image_.codes[image_.offset(x, y)]);
    mixed_.push_back(
        {x, y,
         color_of(picture_, x, y) * area + color_of(picture_, other->x, other->y) * (1 - area)});
  }

  const EdgePointImage& image_;
  Holes holes_;
  const Image& picture_;
  std::vector<FilledHole> mixed_;
};

}  // namespace

void fill_holes(const EdgePointImage& image, std::span<const std::uint32_t> holes, int threads,
                Image& picture) {
  if (holes.empty()) return;
  HolePlanes planes = make_planes(image, holes, threads);
  const BitPlane before = planes.holes;
  const std::vector<HoleWord> words = words_of(image, holes);
  spread_reached(image, words, threads, planes, picture);
  const BitPlane not_of_region = planes.holes;
  use_mixtures(image, words, planes);
  spread_reached(image, words, threads, planes, picture);
  EdgeMixer mixer(image, {before, not_of_region, planes.holes}, picture);
  for (const std::uint32_t hole : holes) {
    const int x = int(hole % std::uint32_t(picture.width_px));
    const int y = int(hole / std::uint32_t(picture.width_px));
    if (!planes.holes.at(x, y)) mixer.add_around(x, y);
  }
  mixer.finish(picture);
  Grids grids(picture, planes.holes);
  for (const std::uint32_t hole : holes) {
    const int pixel_x = int(hole % std::uint32_t(picture.width_px));
    const int pixel_y = int(hole / std::uint32_t(picture.width_px));
    if (!planes.holes.at(pixel_x, pixel_y)) continue;
    int x = pixel_x / kFirstCell, y = pixel_y / kFirstCell;
    for (std::size_t level = 0; level < grids.levels(); ++level) {
      const Cell& cell = grids.at(level, x, y);
      if (cell.count > 0) {
        set_color(picture, hole, cell.sum * (1 / cell.count));
        break;
      }
      x /= 2;
      y /= 2;
    }
  }
}

}  // namespace arris
