#include "edgepoint/hole_filler.h"

#include <cstddef>
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

}  // namespace

void fill_holes(std::span<const std::uint32_t> holes, Image& picture) {
  if (holes.empty()) return;
  std::vector<bool> is_hole(picture.values.size() / 3);
  for (const std::uint32_t hole : holes) is_hole[hole] = true;
  std::vector<Grid> grids{make_first_grid(picture, is_hole)};
  while (grids.back().width > 1 || grids.back().height > 1)
    grids.push_back(make_coarser(grids.back()));
  for (const std::uint32_t hole : holes) {
    int x = int(hole % std::uint32_t(picture.width_px)) / kFirstCell;
    int y = int(hole / std::uint32_t(picture.width_px)) / kFirstCell;
    for (Grid& grid : grids) {
      const Cell& cell = grid.at(x, y);
      if (cell.count > 0) {
        const Rgb mean = cell.sum * (1 / cell.count);
        picture.values[3 * std::size_t(hole)] = mean.x;
        picture.values[3 * std::size_t(hole) + 1] = mean.y;
        picture.values[3 * std::size_t(hole) + 2] = mean.z;
        break;
      }
      x /= 2;
      y /= 2;
    }
  }
}

}  // namespace arris
