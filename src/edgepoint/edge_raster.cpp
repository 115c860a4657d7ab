#include "edgepoint/edge_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace arris {
namespace {

// Pixels. Interpolation has a reach of two.
constexpr double kWidestPenumbra = 2;
constexpr double kNarrowestPenumbra = 1;
struct Clip {
  double from = 0, to = 1;
  // Keeps where start + t·change ≥ 0; false if that is nowhere.
  [[nodiscard]] bool keep(double start, double end) {
    if (start >= 0 && end >= 0) return true;
    if (start < 0 && end < 0) return false;
    const double t = start / (start - end);
    if (start < 0) {
      from = std::max(from, t);
    } else {
      to = std::min(to, t);
    }
    return from < to;
  }
};

// Rounds half away from zero, as std::round(), which is a call, does.
float on_grid(double v) {
  const double places = v * kScreenGrid;
  const int below = int(places);
  const double rest = places - below;
  return float((below + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0)) / kScreenGrid);
}

// Much less than the distance of a crossing from a corner that it does not pass through.
constexpr double kAside = 1e-11;

// Most edges cross no more lines of a direction.
constexpr int kFewLines = 4;
// Edges whose crossings are found before they are marked.
constexpr std::size_t kEdgesAtOnce = 256;

bool is_corner(double v) {
  return std::floor(2 * v) == 2 * v;
}

// place: along the side, 0 to 1.
unsigned eighth(double place) {
  return 1U << unsigned(std::clamp(int(place * 8), 0, 7));
}

// Segments, and the lines of one band.
class Marker {
 public:
  Marker(const DepthCells& depth, RowBand band, int width, int height, Crossings& crossings)
      : depth_(depth),
        band_(band),
        width_(width),
        height_(height),
        columns_{lines_of(crossings.left), lines_of(crossings.mid_column)},
        rows_{lines_of(crossings.upper), lines_of(crossings.mid_row)} {}

  // How many lines a short edge crosses can't be guessed, so what crosses what is listed first, always as if there were
  // kFewLines of them of which the next edge's overwrite those that aren't; and then marked without a branch.
  void mark(std::span<const ScreenEdge> edges) {
    struct Crossing {
      std::uint32_t edge;
      int line;
    };
    std::array<Crossing, kEdgesAtOnce * kFewLines> columns, rows;
    std::size_t column_count = 0, row_count = 0;
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      const LineRange c = columns_of(edges[i]), r = rows_of(edges[i]);
      if (std::max(c.count(), r.count()) > kFewLines) {
        for (int j = c.first; j <= c.last; ++j) mark_column(edges[i], j);
        for (int j = r.first; j <= r.last; ++j) mark_row(edges[i], j);
        continue;
      }
      for (int k = 0; k < kFewLines; ++k) {
        columns[column_count + std::size_t(k)] = {i, c.first + k};
        rows[row_count + std::size_t(k)] = {i, r.first + k};
      }
      column_count += std::size_t(std::max(c.count(), 0));
      row_count += std::size_t(std::max(r.count(), 0));
    }
    for (std::size_t k = 0; k < column_count; ++k) {
      mark_column(edges[columns[k].edge], columns[k].line);
    }
    for (std::size_t k = 0; k < row_count; ++k) mark_row(edges[rows[k].edge], rows[k].line);
  }

 private:
  struct LineRange {
    int first, last;

    [[nodiscard]] int count() const { return last - first + 1; }
  };

  // Lines x = j / 2 that an edge crosses.
  [[nodiscard]] LineRange columns_of(const ScreenEdge& e) const {
    const float lower = std::min(e.x0, e.x1), upper = std::max(e.x0, e.x1);
    LineRange range{std::max(int(std::floor(2 * lower)) + 1, 0),
                    std::min(int(std::floor(2 * upper)), 2 * width_)};
    if (range.count() > kFewLines && e.y0 != e.y1) limit_to_band(e, range);
    return range;
  }
  // Lines y = j / 2, of the band.
  [[nodiscard]] LineRange rows_of(const ScreenEdge& e) const {
    const float lower = std::min(e.y0, e.y1), upper = std::max(e.y0, e.y1);
    const int past = band_.last == height_ ? 2 * height_ : 2 * band_.last - 1;
    return {std::max(int(std::floor(2 * lower)) + 1, 2 * band_.first),
            std::min(int(std::floor(2 * upper)), past)};
  }

  void mark_column(const ScreenEdge& e, int j) {
    const double dx = double(e.x1) - double(e.x0), dy = double(e.y1) - double(e.y0);
    const double x = 0.5 * j, from = x - double(e.x0);
    double y = double(e.y0) + from * dy / dx;
    // Exactly through a corner: as if everything lay a little to the right.
    if (is_corner(y) && dy * dx > 0) y -= kAside;
    const int row = int(std::floor(y));
    if (row < band_.first || row >= band_.last) return;
    mark(columns_[j & 1], row, j / 2, bit_seen(e, {float(x), float(y)}, float(from / dx), y - row));
  }

  void mark_row(const ScreenEdge& e, int j) {
    const double dx = double(e.x1) - double(e.x0), dy = double(e.y1) - double(e.y0);
    const double y = 0.5 * j, from = y - double(e.y0);
    const double x = double(e.x0) + from * dx / dy;
    const int column = int(std::floor(x));
    if (column < 0 || column >= width_) return;
    mark(rows_[j & 1], j / 2, column,
         bit_seen(e, {float(x), float(y)}, float(from / dy), x - column));
  }

  // Leaves out lines that are met outside of the band by more than a pixel.
  void limit_to_band(const ScreenEdge& e, LineRange& range) const {
    const double dx = double(e.x1) - double(e.x0), dy = double(e.y1) - double(e.y0);
    const auto slope = float(dy / dx);
    const float at_first = e.x0 + (float(band_.first) - 1 - e.y0) / slope;
    const float at_last = e.x0 + (float(band_.last) + 1 - e.y0) / slope;
    const float lower = std::clamp(std::min(at_first, at_last), -1.0F, float(width_) + 1);
    const float upper = std::clamp(std::max(at_first, at_last), -1.0F, float(width_) + 1);
    range.first = std::max(range.first, int(std::floor(2 * lower)) - 1);
    range.last = std::min(range.last, int(std::ceil(2 * upper)) + 1);
  }

  // Of lines between pixels, or through their middles.
  struct Lines {
    std::uint8_t* start;
    std::size_t stride;
  };
  static Lines lines_of(CrossingRows& rows) { return {rows.row(0), rows.stride()}; }

  static void mark(const Lines& lines, int y, int x, unsigned bit) {
    std::uint8_t& at = lines.start[std::size_t(y) * lines.stride + std::size_t(x)];
    at = std::uint8_t(at | bit);
  }

  // The bit of a crossing, 0 where it is hidden: which of them are can't be guessed, so there is no branch.
  [[nodiscard]] unsigned bit_seen(const ScreenEdge& e, Vec2f at, float t, double place) const {
    const float inverse =
        e.inverse_depth0 + std::clamp(t, 0.0F, 1.0F) * (e.inverse_depth1 - e.inverse_depth0);
    const bool hidden = inverse * depth_.limit_at(std::clamp(at.x, 0.0F, float(width_)),
                                                  std::clamp(at.y, 0.0F, float(height_))) <
                        1;
    return eighth(place) & (unsigned(hidden) - 1U);
  }

  const DepthCells& depth_;
  RowBand band_;
  int width_, height_;
  std::array<Lines, 2> columns_, rows_;
};

void clear(CrossingRows& rows, int first, int last) {
  std::memset(rows.row(first), 0, std::size_t(last - first) * rows.stride());
}

}  // namespace

ScreenEdge project_edge(const PixelView& view, const WorldEdge& edge) {
  const Vec3d a = project(view, Vec3d(edge.a)), b = project(view, Vec3d(edge.b));
  const double near = kNearest * std::max(a.z, b.z);
  if (!(near > 0)) return {};
  Clip clip;
  const double right = view.width_px + kAroundPicture, bottom = view.height_px + kAroundPicture;
  const bool inside = clip.keep(a.z - near, b.z - near) &&
                      clip.keep(a.x + kAroundPicture * a.z, b.x + kAroundPicture * b.z) &&
                      clip.keep(a.y + kAroundPicture * a.z, b.y + kAroundPicture * b.z) &&
                      clip.keep(right * a.z - a.x, right * b.z - b.x) &&
                      clip.keep(bottom * a.z - a.y, bottom * b.z - b.y);
  if (!inside) return {};
  const Vec3d p = clip.from == 0 ? a : a + (b - a) * clip.from;
  const Vec3d q = clip.to == 1 ? b : a + (b - a) * clip.to;
  return {on_grid(p.x / p.z), on_grid(p.y / p.z), float(1 / p.z),
          on_grid(q.x / q.z), on_grid(q.y / q.z), float(1 / q.z)};
}

bool penumbra_matters(const PixelView& view, const SoftEdge& edge, const ScreenEdge& e) {
  if (edge.penumbra == Vec3f{}) return true;
  const Vec2d along{double(e.x1) - double(e.x0), double(e.y1) - double(e.y0)};
  if (along.x == 0 && along.y == 0) return false;
  const Vec3d middle = (Vec3d(edge.edge.a) + Vec3d(edge.edge.b)) / 2;
  const Vec3d beyond = project(view, middle + Vec3d(edge.penumbra));
  // The other side lies behind the eye.
  if (!(beyond.z > 0)) return false;
  const Vec2d across{beyond.x / beyond.z - double(e.x0), beyond.y / beyond.z - double(e.y0)};
  const double area = std::abs(across.x * along.y - across.y * along.x);
  // Most penumbras are wide, which is seen without a root.
  constexpr double kSurelyWide = 1.001 * kWidestPenumbra * kWidestPenumbra;
  if (area * area > kSurelyWide * (along.x * along.x + along.y * along.y)) return false;
  const double width = area / std::hypot(along.x, along.y);
  return width <= kWidestPenumbra && !(edge.is_umbra && width < kNarrowestPenumbra);
}

ScreenEdge project_edge(const PixelView& view, const SoftEdge& edge) {
  const ScreenEdge e = project_edge(view, edge.edge);
  return penumbra_matters(view, edge, e) ? e : ScreenEdge{};
}

void clear_crossings(RowBand band, int height_px, Crossings& crossings) {
  clear(crossings.left, band.first, band.last);
  clear(crossings.mid_column, band.first, band.last);
  clear(crossings.mid_row, band.first, band.last);
  clear(crossings.upper, band.first, band.last == height_px ? height_px + 1 : band.last);
}

void rasterize_edges(std::span<const ScreenEdge> edges, const DepthCells& depth, RowBand band,
                     int width_px, int height_px, Crossings& crossings) {
  Marker marker(depth, band, width_px, height_px, crossings);
  for (std::size_t at = 0; at < edges.size(); at += kEdgesAtOnce) {
    marker.mark(edges.subspan(at, std::min(kEdgesAtOnce, edges.size() - at)));
  }
}

}  // namespace arris
