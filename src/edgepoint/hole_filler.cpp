#include "edgepoint/hole_filler.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "arris/math.h"

namespace arris {
namespace {

struct Cell {
  Rgb sum;
  float count = 0;
};

struct Grid {
  int width, height;
  std::vector<Cell> cells;

  Grid(int w, int h) : width(w), height(h), cells(std::size_t(w) * std::size_t(h)) {}
  [[nodiscard]] Cell& at(int x, int y) {
    return cells[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

constexpr int kFirstCell = 8;  // pixels

Grid make_first_grid(const Image& picture, const std::vector<bool>& is_hole) {
  Grid grid((picture.width_px + kFirstCell - 1) / kFirstCell,
            (picture.height_px + kFirstCell - 1) / kFirstCell);
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const std::size_t at = picture.offset(x, y);
      if (is_hole[at / 3]) continue;
      Cell& cell = grid.at(x / kFirstCell, y / kFirstCell);
      cell.sum += Rgb{picture.values[at], picture.values[at + 1], picture.values[at + 2]};
      ++cell.count;
    }
  }
  return grid;
}

Grid make_coarser(Grid& fine) {
  Grid coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < fine.height; ++y) {
    for (int x = 0; x < fine.width; ++x) {
      Cell& cell = coarse.at(x / 2, y / 2);
      cell.sum += fine.at(x, y).sum;
      cell.count += fine.at(x, y).count;
    }
  }
  return coarse;
}

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
void spread_reached(const EdgePointImage& image, std::vector<std::uint32_t>& holes,
                    std::vector<bool>& is_hole, Image& picture) {
  for (int step = 0; step < kSteps && !holes.empty(); ++step) {
    std::vector<std::pair<std::uint32_t, Rgb>> filled;
    for (const std::uint32_t hole : holes) {
      const Cell cell = collect_reached(image, is_hole, picture, hole);
      if (cell.count > 0) filled.emplace_back(hole, cell.sum * (1 / cell.count));
    }
    if (filled.empty()) return;
    for (const auto& [hole, color] : filled) {
      set_color(picture, hole, color);
      is_hole[hole] = false;
    }
    std::erase_if(holes, [&](std::uint32_t hole) { return !is_hole[hole]; });
  }
}

}  // namespace

void fill_holes(const EdgePointImage& image, std::vector<std::uint32_t> holes, Image& picture) {
  if (holes.empty()) return;
  std::vector<bool> is_hole(picture.values.size() / 3);
  for (const std::uint32_t hole : holes) is_hole[hole] = true;
  spread_reached(image, holes, is_hole, picture);
  if (holes.empty()) return;
  std::vector<Grid> grids{make_first_grid(picture, is_hole)};
  while (grids.back().width > 1 || grids.back().height > 1)
    grids.push_back(make_coarser(grids.back()));
  for (const std::uint32_t hole : holes) {
    int x = int(hole % std::uint32_t(picture.width_px)) / kFirstCell;
    int y = int(hole / std::uint32_t(picture.width_px)) / kFirstCell;
    for (Grid& grid : grids) {
      const Cell& cell = grid.at(x, y);
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
