#include "edgepoint/edge_code.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace arris {

Vec2d boundary_point(double along) {
  const int side = int(along) & 3;
  const double t = along - std::floor(along);
  switch (side) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

namespace {

double segment_start(std::uint32_t segment) {
  return segment / 8.0;
}
double segment_middle(std::uint32_t segment) {
  return (segment + 0.5) / 8;
}

double area_of(const std::vector<Vec2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

double area_a(std::uint32_t code) {
  const double from = segment_middle(first_end(code)), to = segment_middle(last_end(code));
  std::vector<Vec2d> polygon{boundary_point(from)};
  for (int corner = int(std::floor(from)) + 1; corner < to; ++corner) {
    polygon.push_back(boundary_point(corner));
  }
  polygon.push_back(boundary_point(to));
  return area_of(polygon);
}

double side_of(Vec2d a, Vec2d b, Vec2d p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Positive: the cell lies wholly on the right of a → b as one looks along it with y down, which is region B's side or
// A's; zero: it is cut.
int cell_side(Vec2d a, Vec2d b, std::uint32_t cell) {
  int positive = 0, negative = 0;
  for (std::uint32_t corner = 0; corner < 4; ++corner) {
    const Vec2d p{(cell % 4 + corner % 2) / 4.0, (cell / 4 + corner / 2) / 4.0};
    const double side = side_of(a, b, p);
    positive += side > 1e-12 ? 1 : 0;
    negative += side < -1e-12 ? 1 : 0;
  }
  return positive > 0 && negative > 0 ? 0 : positive > 0 ? 1 : -1;
}

// A line between two segments of the boundary lies between the four that join their ends.
std::uint32_t cells_of(std::uint32_t code) {
  std::uint32_t cells = 0;
  for (std::uint32_t cell = 0; cell < 16; ++cell) {
    int least = 1, most = -1;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec2d a = boundary_point(segment_start(first_end(code) + (i & 1U)));
      const Vec2d b = boundary_point(std::fmod(segment_start(last_end(code) + (i >> 1U)), 4.0));
      const int side = cell_side(a, b, cell);
      least = std::min(least, side);
      most = std::max(most, side);
    }
    // Going clockwise with y down, the way that A's boundary takes bulges to the left of the chord.
    const RegionOf region = least != most || least == 0 ? RegionOf::ambiguous
                            : least > 0                 ? RegionOf::b
                                                        : RegionOf::a;
    cells |= std::uint32_t(region) << (2 * cell);
  }
  return cells;
}

EdgeTables::Sides sides_of(std::uint32_t code, bool of_a) {
  const double from = segment_middle(first_end(code)), to = segment_middle(last_end(code));
  struct Side {
    std::uint8_t side;
    double length;
  };
  std::vector<Side> sides;
  for (std::uint8_t side = 0; side < 4; ++side) {
    const double in_a = std::max(0.0, std::min(to, side + 1.0) - std::max(from, double(side)));
    const double length = of_a ? in_a : 1 - in_a;
    if (length > 0) sides.push_back({side, length});
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.length > b.length; });
  EdgeTables::Sides out;
  for (const Side& side : sides) {
    out.order = std::uint8_t(out.order | side.side << (2 * out.count));
    ++out.count;
  }
  return out;
}

EdgeTables make_edge_tables() {
  EdgeTables tables;
  for (std::uint32_t first = 0; first < 32; ++first) {
    for (std::uint32_t last = first + 1; last < 32; ++last) {
      if (first / 8 == last / 8) continue;
      const std::uint32_t code = edge_code(first, last);
      tables.area_a[code] = float(area_a(code));
      std::uint32_t corners = 0;
      for (std::uint32_t corner = 1; corner < 4; ++corner) {
        if (first < 8 * corner && last >= 8 * corner) corners |= 1U << corner;
      }
      tables.corners_a[code] = std::uint8_t(corners);
      tables.cells[code] = cells_of(code);
      tables.sides_a[code] = sides_of(code, true);
      tables.sides_b[code] = sides_of(code, false);
    }
  }
  return tables;
}

}  // namespace

const EdgeTables& edge_tables() {
  static const EdgeTables kTables = make_edge_tables();
  return kTables;
}

}  // namespace arris
