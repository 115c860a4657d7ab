#include "edgepoint/hole_filler.h"

#include <algorithm>
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
#include "edgepoint/interpolate.h"
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

ParallelOptions with_grain(ParallelOptions parallel, std::size_t grain) {
  parallel.grain = grain;
  return parallel;
}

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

  // Of the smallest cell about a pixel in which anything is known; black where nothing is.
  Rgb mean_around(int x, int y) {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      const Cell& cell = at(level, x / kFirstCell >> level, y / kFirstCell >> level);
      if (cell.count > 0) return cell.sum * (1 / cell.count);
    }
    return {};
  }

 private:
  const Cell& at(std::size_t level, int x, int y) {
    Level& l = levels_[level];
    Cell& cell = l.cells[std::size_t(y) * std::size_t(l.width) + std::size_t(x)];
    if (cell.count == kUnknown) cell = level == 0 ? of_pixels(x, y) : of_cells(level - 1, x, y);
    return cell;
  }

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

void set_color(Image& picture, std::uint32_t pixel, Rgb color) {
  float* const out = picture.values.data() + 3 * std::size_t(pixel);
  out[0] = color.x;
  out[1] = color.y;
  out[2] = color.z;
}

// Usable are first such as no edge crosses: the others are mixtures.
HolePlanes make_planes(const EdgePointImage& image, std::span<const std::uint32_t> holes,
                       const ParallelOptions& parallel) {
  HolePlanes planes{BitPlane(image.width_px, image.height_px),
                    BitPlane(image.width_px, image.height_px)};
  const auto& corners = image.corners.primary;
  const auto width = std::uint32_t(image.width_px);
  parallel_for(std::size_t(image.height_px), with_grain(parallel, 32), [&](std::size_t row) {
    const int y = int(row);
    std::uint64_t* const of_holes = planes.holes.row(y);
    const std::uint32_t first = std::uint32_t(row) * width;
    auto hole = std::ranges::lower_bound(holes, first);
    for (; hole != holes.end() && *hole < first + width; ++hole) {
      of_holes[(*hole - first) / 64] |= std::uint64_t{1} << (*hole - first) % 64;
    }
    // All corners of an empty pixel are of its primary region, and of no other pixel.
    for (int word = 0; word < planes.usable.words(); ++word) {
      planes.usable.row(y)[word] = corners[0].row(y)[word] & corners[1].row(y)[word] &
                                   corners[2].row(y)[word] & corners[3].row(y)[word] &
                                   ~of_holes[word];
    }
  });
  return planes;
}

struct FilledHole {
  int x, y;
  Rgb color;
};

// All that have a colour and belong to a region: the narrow one between an outline and a shadow has pixels alone that
// edges cross.
void use_mixtures(const EdgePointImage& image, HolePlanes& planes,
                  const ParallelOptions& parallel) {
  parallel_for(std::size_t(image.height_px), with_grain(parallel, 128), [&](std::size_t row) {
    const int y = int(row);
    for (int word = 0; word < planes.usable.words(); ++word) {
      const std::uint64_t in_region =
          image.corners.primary[0].row(y)[word] | image.corners.secondary[0].row(y)[word];
      planes.usable.row(y)[word] = in_region & ~planes.holes.row(y)[word];
    }
  });
}

// Pixels of a word that edges cross, and those beside them.
std::uint64_t near_edges(const EdgePointImage& image, int y, int word) {
  const auto& corners = image.corners.primary;
  const auto is_empty = [&](int row, int dx) {
    std::uint64_t all = ~std::uint64_t{0};
    for (const BitPlane& corner : corners) all &= shifted_word(corner.row(row), word, dx);
    return all;
  };
  return ~(is_empty(y, 0) & is_empty(y, -1) & is_empty(y, 1) & is_empty(y - 1, 0) &
           is_empty(y + 1, 0));
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

HoleFiller::HoleFiller(int width_px, int height_px)
    : filled_stride_(std::size_t(width_px + 63) / 64 + kVectorWords),
      colors_(height_px + 2 * kRowMargin, width_px),
      filled_(filled_stride_ * std::size_t(height_px)) {}

// Step by step. Leaves those holes that nothing reaches.
void HoleFiller::spread_reached(const EdgePointImage& image, const ParallelOptions& parallel,
                                HolePlanes& planes) {
  constexpr int kSteps = 8;  // of up to two pixels each
  const auto height = std::size_t(image.height_px);
  const int words = planes.holes.words();
  std::vector<std::uint8_t> changes(height + 2 * kRowMargin, 1);
  for (int step = 0; step < kSteps; ++step) {
    std::vector<std::uint8_t> changed(changes.size(), 0);
    parallel_for(height, with_grain(parallel, 8), [&](std::size_t y) {
      // Rows from y − kRowMargin on.
      const std::uint8_t* const around = changes.data() + y;
      if (std::all_of(around, around + 2 * kRowMargin + 1, [](auto c) { return c == 0; })) return;
      std::uint64_t* const filled = filled_.data() + y * filled_stride_;
      changed[y + kRowMargin] = fill_reached_row(image, planes, int(y), colors_, filled) ? 1 : 0;
    });
    if (std::ranges::all_of(changed, [](auto c) { return c == 0; })) return;
    parallel_for(height, with_grain(parallel, 64), [&](std::size_t y) {
      if (changed[y + kRowMargin] == 0) return;
      for (int word = 0; word < words; ++word) {
        const std::uint64_t filled = filled_[y * filled_stride_ + std::size_t(word)];
        planes.holes.row(int(y))[word] &= ~filled;
        planes.usable.row(int(y))[word] |= filled;
      }
    });
    changes.swap(changed);
  }
}

void HoleFiller::fill(const EdgePointImage& image, std::span<const std::uint32_t> holes,
                      const ParallelOptions& parallel, Image& picture) {
  if (holes.empty()) return;
  HolePlanes planes = make_planes(image, holes, parallel);
  const BitPlane before = planes.holes;
  const auto height = std::size_t(image.height_px), width = std::size_t(image.width_px);
  const ParallelOptions rows = with_grain(parallel, 32);
  parallel_for(height, rows, [&](std::size_t y) {
    part_row(picture.values.data() + 3 * width * y, image.width_px, colors_.row(int(y)));
  });
  spread_reached(image, parallel, planes);
  const BitPlane not_of_region = planes.holes;
  use_mixtures(image, planes, parallel);
  spread_reached(image, parallel, planes);
  const auto for_filled = [&](int y, const auto& call) {
    for (int word = 0; word < before.words(); ++word) {
      const std::uint64_t filled = before.row(y)[word] & ~planes.holes.row(y)[word];
      if (filled != 0) call(word, filled);
    }
  };
  parallel_for(height, rows, [&](std::size_t row) {
    const ColorRow colors = colors_.row(int(row));
    for_filled(int(row), [&](int word, std::uint64_t filled) {
      for (; filled != 0; filled &= filled - 1) {
        const int x = 64 * word + std::countr_zero(filled);
        set_color(picture, std::uint32_t(image.offset(x, int(row))), color_at(colors, x));
      }
    });
  });
  // Strips of rows; of what several mix, the last one's counts.
  constexpr int kStrip = 32;
  const std::size_t strips = (height + kStrip - 1) / kStrip;
  std::vector<EdgeMixer> mixers(strips,
                                EdgeMixer(image, {before, not_of_region, planes.holes}, picture));
  parallel_for(strips, parallel, [&](std::size_t strip) {
    const int first = int(strip) * kStrip;
    for (int y = first; y < std::min(first + kStrip, image.height_px); ++y) {
      for_filled(y, [&](int word, std::uint64_t filled) {
        for (filled &= near_edges(image, y, word); filled != 0; filled &= filled - 1) {
          mixers[strip].add_around(64 * word + std::countr_zero(filled), y);
        }
      });
    }
  });
  for (const EdgeMixer& mixer : mixers) mixer.finish(picture);
  Grids grids(picture, planes.holes);
  for (int y = 0; y < image.height_px; ++y) {
    for (int word = 0; word < planes.holes.words(); ++word) {
      for (std::uint64_t left = planes.holes.row(y)[word]; left != 0; left &= left - 1) {
        const int x = 64 * word + std::countr_zero(left);
        set_color(picture, std::uint32_t(image.offset(x, y)), grids.mean_around(x, y));
      }
    }
  }
}

}  // namespace arris
