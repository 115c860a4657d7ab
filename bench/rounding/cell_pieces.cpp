#include "rounding/cell_pieces.h"

#include <array>
#include <cstdint>
#include <map>

namespace arris::bench {
namespace {

using Spot = std::array<int, 3>;

class CellMaker {
 public:
  CellMaker(const CellGrid& grid, const IsFilled& is_filled) : grid_(grid), is_filled_(is_filled) {}

  Piece make() {
    const Spot count = counts();
    for (int x = 0; x < count[0]; ++x)
      for (int y = 0; y < count[1]; ++y)
        for (int z = 0; z < count[2]; ++z)
          if (is_filled_(x, y, z)) add_cell({x, y, z});
    return std::move(piece_);
  }

 private:
  [[nodiscard]] Spot counts() const {
    return {int(grid_.xs.size()) - 1, int(grid_.ys.size()) - 1, int(grid_.zs.size()) - 1};
  }
  [[nodiscard]] bool is_solid(const Spot& cell) const {
    const Spot count = counts();
    for (std::size_t k = 0; k < 3; ++k)
      if (cell[k] < 0 || cell[k] >= count[k]) return false;
    return is_filled_(cell[0], cell[1], cell[2]);
  }

  void add_cell(const Spot& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Spot beyond = cell;
        beyond[axis] += side == 0 ? -1 : 1;
        if (!is_solid(beyond)) add_side(cell, axis, side);
      }
    }
  }

  void add_side(const Spot& cell, std::size_t axis, int side) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<std::uint32_t> loop;
    for (const auto& [du, dv] :
         {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
      Spot corner = cell;
      corner[axis] += side;
      corner[u] += side == 1 ? du : dv;
      corner[v] += side == 1 ? dv : du;
      loop.push_back(vertex(corner));
    }
    piece_.faces.push_back(std::move(loop));
  }

  std::uint32_t vertex(const Spot& at) {
    const auto [found, is_new] = vertices_.try_emplace(at, std::uint32_t(piece_.vertices.size()));
    if (is_new) {
      piece_.vertices.push_back({grid_.xs[std::size_t(at[0])], grid_.ys[std::size_t(at[1])],
                                 grid_.zs[std::size_t(at[2])]});
    }
    return found->second;
  }

  const CellGrid& grid_;
  const IsFilled& is_filled_;
  Piece piece_;
  std::map<Spot, std::uint32_t> vertices_;
};

}  // namespace

Piece make_cells(const CellGrid& grid, const IsFilled& is_filled) {
  return CellMaker(grid, is_filled).make();
}

Piece make_bracket(double leg, double thickness, double width) {
  const CellGrid grid{{0, thickness, leg}, {0, width}, {0, thickness, leg}};
  return make_cells(grid, [](int x, int, int z) { return x == 0 || z == 0; });
}

Piece make_boss() {
  const CellGrid grid{{-2, -0.8, 0.8, 2}, {-2, -0.8, 0.8, 2}, {0, 0.8, 1.7}};
  return make_cells(grid, [](int x, int y, int z) { return z == 0 || (x == 1 && y == 1); });
}

Piece make_pockets(int count) {
  CellGrid grid{{}, {}, {0, 0.4, 1}};
  for (int i = 0; i <= 2 * count + 1; ++i) grid.xs.push_back(i);
  grid.ys = grid.xs;
  return make_cells(grid, [](int x, int y, int z) { return z == 0 || x % 2 == 0 || y % 2 == 0; });
}

}  // namespace arris::bench
