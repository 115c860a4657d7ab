#include "rounding/clear_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>

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

  [[nodiscard]] std::vector<std::uint64_t> make(std::uint32_t cells_u, std::uint32_t cells_v) {
    cell_u_ = 1.0 / cells_u;
    cell_v_ = 1.0 / cells_v;
    rows_.assign(cells_u, 0);
    fill({0, 0, cells_u, cells_v}, std::nullopt);
    return std::move(rows_);
  }

 private:
  // Of cells.
  struct Rectangle {
    std::uint32_t i, j, extent_u, extent_v;
  };
  // Of found_.
  struct Range {
    std::size_t begin, end;
  };

  // others: what is near to a rectangle that this one is part of.
  void fill(const Rectangle& at, std::optional<Range> others) {
    const auto [i, j, extent_u, extent_v] = at;
    const double u = i * cell_u_, v = j * cell_v_;
    if (u + v >= 1) return;  // beyond the triangle
    const Vec3d side_u = along_u_ * (extent_u * cell_u_), side_v = along_v_ * (extent_v * cell_v_);
    const Vec3d middle = corner_ + along_u_ * u + along_v_ * v + (side_u + side_v) * 0.5;
    const double half = 0.5 * std::max(length(side_u + side_v), length(side_u - side_v));
    const std::size_t begin = found_.size();
    bool is_settled = extent_u == 1 && extent_v == 1;
    if (half < kLarge * r_) {
      const double nearest = find_near(middle, (1 + kPositionError) * r_ + half, others);
      others = Range{begin, found_.size()};
      if (others->begin == others->end) set_clear(at);
      is_settled = is_settled || others->begin == others->end || nearest < r_ - half;
    }
    if (!is_settled) {
      const bool is_longer = length_squared(side_u) > length_squared(side_v);
      if (extent_v == 1 || (is_longer && extent_u > 1)) {
        const std::uint32_t h = extent_u / 2;
        fill({i, j, h, extent_v}, others);
        fill({i + h, j, h, extent_v}, others);
      } else {
        const std::uint32_t h = extent_v / 2;
        fill({i, j, extent_u, h}, others);
        fill({i, j + h, extent_u, h}, others);
      }
    }
    found_.resize(begin);
  }

  // Appends what a ball that touches the face may not reach into, and is nearer to x than `distance`. Returns how near
  // it is.
  double find_near(Vec3d x, double distance, std::optional<Range> among) {
    double nearest = distance;
    const auto look_at = [&](const SurfaceTriangle& t) {
      if (t.region == region_ || is_plainly_beyond(x, t, distance)) return;
      const double d = length(x - nearest_on_triangle(x, t));
      if (!(d < distance) || surface_.is_joined(region_, t.region)) return;
      nearest = std::min(nearest, d);
      found_.push_back(&t);
    };
    if (among) {
      for (std::size_t k = among->begin; k < among->end; ++k) look_at(*found_[k]);
    } else {
      surface_.for_each_near(x - Vec3d(distance), x + Vec3d(distance), look_at);
    }
    return nearest;
  }

  void set_clear(const Rectangle& at) {
    const std::uint64_t bits =
        (at.extent_v == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << at.extent_v) - 1);
    for (std::uint32_t k = at.i; k < at.i + at.extent_u; ++k) rows_[k] |= bits << at.j;
  }

  const SolidSurface& surface_;
  std::uint32_t region_;
  double r_;
  Vec3d corner_, along_u_, along_v_;
  double cell_u_ = 1, cell_v_ = 1;
  std::vector<std::uint64_t> rows_;
  std::vector<const SurfaceTriangle*> found_;
};

// A power of two.
std::uint32_t cells_along(double extent, double radius) {
  const double wanted = extent / (kCell * radius);
  if (!(wanted < kMostCells)) return kMostCells;
  return std::bit_ceil(std::max(std::uint32_t(wanted), 1U));
}

}  // namespace

ClearCells::Grid ClearCells::make_grid(const SolidSurface& surface, const SurfaceTriangle& t,
                                       Vec3d normal, double radius) {
  const std::uint32_t cells_u = cells_along(length(t.p1 - t.p0), radius);
  const std::uint32_t cells_v = cells_along(length(t.p2 - t.p0), radius);
  if (std::max(cells_u, cells_v) < kLeastCells) return {};
  return {t.index, cells_v, GridMaker(surface, t, normal, radius).make(cells_u, cells_v)};
}

ClearCells::ClearCells(std::vector<Grid> grids) {
  std::ranges::sort(grids, {}, &Grid::triangle);
  for (const Grid& grid : grids) {
    const auto is_empty = [](std::uint64_t row) { return row == 0; };
    if (std::ranges::all_of(grid.rows, is_empty)) continue;
    entries_.push_back({grid.triangle, std::uint32_t(rows_.size()), std::uint16_t(grid.rows.size()),
                        std::uint16_t(grid.cells_v)});
    rows_.insert(rows_.end(), grid.rows.begin(), grid.rows.end());
  }
}

bool ClearCells::is_clear(std::uint32_t triangle, double u, double v) const {
  const auto entry = std::ranges::lower_bound(entries_, triangle, {}, &Entry::triangle);
  if (entry == entries_.end() || entry->triangle != triangle) return false;
  const auto cell_of = [](double part, std::uint32_t cells) {
    return std::min(std::uint32_t(std::max(part, 0.0) * cells), cells - 1);
  };
  const std::uint64_t row = rows_[entry->first + cell_of(u, entry->cells_u)];
  return ((row >> cell_of(v, entry->cells_v)) & 1U) != 0;
}

std::size_t ClearCells::bytes() const {
  return entries_.size() * sizeof(Entry) + rows_.size() * sizeof(std::uint64_t);
}

}  // namespace arris
