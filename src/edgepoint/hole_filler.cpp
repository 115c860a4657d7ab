#include "edgepoint/hole_filler.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "arris/math.h"
#include "base/parallel_for.h"

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
  Grids(const Image& picture, const std::vector<bool>& is_hole)
      : picture_(picture), is_hole_(is_hole) {
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
        const std::size_t at = picture_.offset(x, y);
        if (is_hole_[at / 3]) continue;
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
  const std::vector<bool>& is_hole_;
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

// Colours of pixels around one that no edge parts from it, but not of such as edges cross: those are mixtures.
Cell collect_reached(const EdgePointImage& image, const std::vector<bool>& is_hole,
                     const Image& picture, std::uint32_t pixel) {
  const int x = int(pixel % std::uint32_t(image.width_px));
  const int y = int(pixel / std::uint32_t(image.width_px));
  Cell cell;
  const auto add = [&](int px, int py) {
    const std::size_t at = image.offset(px, py);
    if (is_hole[at] || !image.codes[at].is_empty()) return;
    const float* const color = picture.values.data() + 3 * at;
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
  return cell;
}

// Leaves those holes that nothing reaches.
void spread_reached(const EdgePointImage& image, int threads, std::vector<std::uint32_t>& holes,
                    std::vector<bool>& is_hole, Image& picture) {
  std::vector<Cell> around;
  for (int step = 0; step < kSteps && !holes.empty(); ++step) {
    around.resize(holes.size());
    parallel_for(holes.size(), {.grain = 256, .threads = threads}, [&](std::size_t i) {
      around[i] = collect_reached(image, is_hole, picture, holes[i]);
    });
    std::size_t left = 0;
    for (std::size_t i = 0; i < holes.size(); ++i) {
      if (around[i].count > 0) {
        set_color(picture, holes[i], around[i].sum * (1 / around[i].count));
        is_hole[holes[i]] = false;
      } else {
        holes[left++] = holes[i];
      }
    }
    if (left == holes.size()) return;
    holes.resize(left);
  }
}

}  // namespace

void fill_holes(const EdgePointImage& image, std::vector<std::uint32_t> holes, int threads,
                Image& picture) {
  if (holes.empty()) return;
  std::vector<bool> is_hole(picture.values.size() / 3);
  for (const std::uint32_t hole : holes) is_hole[hole] = true;
  spread_reached(image, threads, holes, is_hole, picture);
  if (holes.empty()) return;
  Grids grids(picture, is_hole);
  for (const std::uint32_t hole : holes) {
    int x = int(hole % std::uint32_t(picture.width_px)) / kFirstCell;
    int y = int(hole / std::uint32_t(picture.width_px)) / kFirstCell;
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
