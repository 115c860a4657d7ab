// clear_cells.h — where on large triangles a ball touches nothing but their face, in cells
// What       Bands bound the void by half planes, which say little of a large triangle that reaches far beyond the
//            short edges that bound what is taken from it: most hits in such bands are kept all the same. Those
//            triangles get a grid of cells in their barycentrics; in those that are clear no search is needed.
// Guarantee  a ball of the radius that touches the face in a clear cell is nowhere near another face, but joined ones
// Cost       rectangles of cells by halves, down to those that a border crosses: each looks at what is near to the
//            one of which it is part; a bit for each cell
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rounding/solid_surface.h"

namespace arris {

class ClearCells {
 public:
  // One bit for each cell: row by u, bit by v. Both sides have as many as their lengths need.
  struct Grid {
    std::uint32_t triangle = 0;
    std::uint32_t cells_v = 0;
    std::vector<std::uint64_t> rows;
  };

  ClearCells() = default;
  explicit ClearCells(std::vector<Grid> grids);

  // Of a triangle with its normal; without rows if it is too small to be worth a grid.
  static Grid make_grid(const SolidSurface& surface, const SurfaceTriangle& triangle, Vec3d normal,
                        double radius);

  [[nodiscard]] bool is_clear(std::uint32_t triangle, double u, double v) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Entry {
    std::uint32_t triangle, first;
    std::uint16_t cells_u, cells_v;
  };
  std::vector<Entry> entries_;  // by triangle
  std::vector<std::uint64_t> rows_;
};

}  // namespace arris
