// cell_pieces.h — solids with concave edges for the benchmark scenes: cells of a grid with uneven spacing
// Out        as convex_pieces.h
#pragma once

#include <functional>
#include <vector>

#include "rounding/convex_pieces.h"

namespace arris::bench {

// Planes between the cells, ascending.
struct CellGrid {
  std::vector<double> xs, ys, zs;
};
using IsFilled = std::function<bool(int x, int y, int z)>;

Piece make_cells(const CellGrid& grid, const IsFilled& is_filled);

// Two legs at a right angle, standing.
Piece make_bracket(double leg, double thickness, double width);
// A plate with a block on it.
Piece make_boss();
// A plate with square pockets, `count` along each side.
Piece make_pockets(int count);

}  // namespace arris::bench
