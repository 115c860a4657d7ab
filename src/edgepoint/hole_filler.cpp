#include "edgepoint/hole_filler.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "arris/math.h"
#include "base/parallel_for.h"
#include "edgepoint/bit_plane.h"
#include "edgepoint/shifted_word.h"

namespace arris {
namespace {

struct Cell {
  Rgb sum;
  float count = 0;
};

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
        const std::size_t at = picture_.offset(x, y);
        cell.sum += Rgb{picture_.values[at], picture_.values[at + 1], picture_.values[at + 2]};
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

// Pixels without a colour, and those whose colour others may take: not such as edges cross, which are mixtures.
struct HolePlanes {
  BitPlane holes, usable;
};

void set_bit(BitPlane& plane, int x, int y, bool value) {
  const std::uint64_t bit = std::uint64_t{1} << unsigned(x & 63);
  std::uint64_t& word = plane.row(y)[x >> 6];
  word = value ? word | bit : word & ~bit;
}

HolePlanes make_planes(const EdgePointImage& image, std::span<const std::uint32_t> holes) {
  HolePlanes planes{BitPlane(image.width_px, image.height_px),
                    BitPlane(image.width_px, image.height_px)};
  const auto& corners = image.corners.primary;
  for (int y = 0; y < image.height_px; ++y) {
    // All corners of an empty pixel are of its primary region, and of no other pixel.
    for (int word = 0; word < planes.usable.words(); ++word) {
      planes.usable.row(y)[word] = corners[0].row(y)[word] & corners[1].row(y)[word] &
                                   corners[2].row(y)[word] & corners[3].row(y)[word];
    }
  }
  for (const std::uint32_t hole : holes) {
    const int x = int(hole % std::uint32_t(image.width_px));
    const int y = int(hole / std::uint32_t(image.width_px));
    set_bit(planes.holes, x, y, true);
    set_bit(planes.usable, x, y, false);
  }
  return planes;
}

// Of the holes of a word those that a usable colour reaches.
std::uint64_t find_reached(const EdgePointImage& image, const HolePlanes& planes, int y, int word) {
  std::uint64_t reached = 0;
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const auto [dx, dy] = kReachOffset[k];
    const BitPlane& reach = image.reach.planes[k];
    reached |= reach.row(y)[word] & shifted_word(planes.usable.row(y + dy), word, dx);
    reached |= shifted_word(reach.row(y - dy), word, -dx) &
               shifted_word(planes.usable.row(y - dy), word, -dx);
  }
  return reached & planes.holes.row(y)[word];
}

// The mean of the usable colours that reach a hole.
Rgb mean_reached(const EdgePointImage& image, const BitPlane& usable, const Image& picture, int x,
                 int y) {
  Cell cell;
  const auto add = [&](int px, int py) {
    if (!usable.at(px, py)) return;
    const float* const color = picture.values.data() + 3 * image.offset(px, py);
    cell.sum += Rgb{color[0], color[1], color[2]};
    ++cell.count;
  };
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const auto [dx, dy] = kReachOffset[k];
    // Nothing beyond the picture is reached.
    if (image.reach.at(k, x, y)) add(x + dx, y + dy);
    const bool inside = x - dx >= 0 && x - dx < image.width_px && y - dy >= 0;
    if (inside && image.reach.at(k, x - dx, y - dy)) add(x - dx, y - dy);
  }
  return cell.sum * (1 / cell.count);
}

struct FilledHole {
  int x;
  Rgb color;
};

// Leaves those holes that nothing reaches.
void spread_reached(const EdgePointImage& image, int threads, HolePlanes& planes, Image& picture) {
  std::vector<std::vector<FilledHole>> filled(std::size_t(image.height_px));
  for (int step = 0; step < kSteps; ++step) {
    parallel_for(filled.size(), {.grain = 16, .threads = threads}, [&](std::size_t row) {
      const int y = int(row);
      filled[row].clear();
      for (int word = 0; word < planes.holes.words(); ++word) {
        if (planes.holes.row(y)[word] == 0) continue;
        std::uint64_t reached = find_reached(image, planes, y, word);
        for (; reached != 0; reached &= reached - 1) {
          const int x = 64 * word + std::countr_zero(reached);
          filled[row].push_back({x, mean_reached(image, planes.usable, picture, x, y)});
        }
      }
    });
    bool any = false;
    for (int y = 0; y < image.height_px; ++y) {
      for (const FilledHole& hole : filled[std::size_t(y)]) {
        set_color(picture, std::uint32_t(image.offset(hole.x, y)), hole.color);
        set_bit(planes.holes, hole.x, y, false);
        set_bit(planes.usable, hole.x, y, image.codes[image.offset(hole.x, y)].is_empty());
        any = true;
      }
    }
    if (!any) return;
  }
}

}  // namespace

void fill_holes(const EdgePointImage& image, std::span<const std::uint32_t> holes, int threads,
                Image& picture) {
  if (holes.empty()) return;
  HolePlanes planes = make_planes(image, holes);
  spread_reached(image, threads, planes, picture);
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
