#include "rounding/clear_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace arris {
namespace {

// Relative to the radius: cells are no larger than this, if they may be so many; and what positions are wrong by.
constexpr double kCell = 0.5, kPositionError = 1e-3;
constexpr std::uint32_t kMostCells = 64;
// Triangles with sides of fewer cells have none.
constexpr std::uint32_t kLeastCells = 4;
// Relative to the radius: cells together that are larger are not looked at at once.
constexpr double kLarge = 8;

class GridMaker {
 public:
  GridMaker(const SolidSurface& surface, const SurfaceTriangle& triangle, Vec3d normal,
            double radius)
      : surface_(surface),
        region_(triangle.region),
        r_(radius),
        corner_(triangle.p0 - normal * radius),
        along_u_(triangle.p1 - triangle.p0),
        along_v_(triangle.p2 - triangle.p0) {}

  [[nodiscard]] std::vector<std::uint64_t> make(std::uint32_t cells) {
    cells_ = cells;
    rows_.assign(cells, 0);
    fill(0, 0, cells);
    return std::move(rows_);
  }

 private:
  // Of so many cells along each side.
  void fill(std::uint32_t i, std::uint32_t j, std::uint32_t extent) {
    if (i + j >= cells_) return;  // beyond the triangle
    const double part = double(extent) / cells_;
    const Vec3d middle = corner_ + along_u_ * (double(i) / cells_ + 0.5 * part) +
                         along_v_ * (double(j) / cells_ + 0.5 * part);
    const double half =
        0.5 * part * std::max(length(along_u_ + along_v_), length(along_u_ - along_v_));
    if (half < kLarge * r_ &&
        !surface_.is_near(middle, (1 + kPositionError) * r_ + half, region_)) {
      const std::uint64_t bits =
          (extent == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << extent) - 1);
      for (std::uint32_t k = i; k < i + extent; ++k) rows_[k] |= bits << j;
    } else if (extent > 1) {
      const std::uint32_t h = extent / 2;
      fill(i, j, h);
      fill(i + h, j, h);
      fill(i, j + h, h);
      fill(i + h, j + h, h);
    }
  }

  const SolidSurface& surface_;
  std::uint32_t region_;
  double r_;
  Vec3d corner_, along_u_, along_v_;
  std::uint32_t cells_ = 0;
  std::vector<std::uint64_t> rows_;
};

}  // namespace

ClearCells::Grid ClearCells::make_grid(const SolidSurface& surface, const SurfaceTriangle& t,
                                       Vec3d normal, double radius) {
  const double extent = std::max({length(t.p1 - t.p0), length(t.p2 - t.p0), length(t.p2 - t.p1)});
  const double wanted = extent / (kCell * radius);
  if (!(wanted >= kLeastCells)) return {};
  const std::uint32_t cells =
      wanted >= kMostCells ? kMostCells : std::bit_ceil(std::uint32_t(wanted));
  return {t.index, cells, GridMaker(surface, t, normal, radius).make(cells)};
}

ClearCells::ClearCells(std::vector<Grid> grids) {
  std::ranges::sort(grids, {}, &Grid::triangle);
  for (const Grid& grid : grids) {
    const auto is_empty = [](std::uint64_t row) { return row == 0; };
    if (std::ranges::all_of(grid.rows, is_empty)) continue;
    entries_.push_back({grid.triangle, std::uint32_t(rows_.size()), grid.cells});
    rows_.insert(rows_.end(), grid.rows.begin(), grid.rows.end());
  }
}

bool ClearCells::is_clear(std::uint32_t triangle, double u, double v) const {
  const auto entry = std::ranges::lower_bound(entries_, triangle, {}, &Entry::triangle);
  if (entry == entries_.end() || entry->triangle != triangle) return false;
  const auto cell_of = [&](double part) {
    return std::min(std::uint32_t(std::max(part, 0.0) * entry->cells), entry->cells - 1);
  };
  return ((rows_[entry->first + cell_of(u)] >> cell_of(v)) & 1U) != 0;
}

std::size_t ClearCells::bytes() const {
  return entries_.size() * sizeof(Entry) + rows_.size() * sizeof(std::uint64_t);
}

}  // namespace arris
