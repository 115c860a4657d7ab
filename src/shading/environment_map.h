// environment_map.h — an equirectangular map of radiance that can be sampled
// In / Out   world directions, unit, towards the environment; pdfs per solid angle
// Guarantee  wherever the map has radiance its density is positive
//            (tests/shading/environment_test.cpp)
// Cost       sampling: two guided table searches, about three comparisons each; evaluation: one
//            bilinear lookup
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "arris/math.h"
#include "base/scalar.h"
#include "base/trigonometry.h"

namespace arris {

// Axes of the map's own frame: z up; azimuth 0 along x, growing towards y.
struct MapFrame {
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

// Draws a cell of a row of weights; the guide starts the search of the cumulative sums.
struct RowDistribution {
  std::vector<float> cumulative;     // rows × (columns + 1), each row from 0 to 1
  std::vector<std::uint16_t> guide;  // rows × columns
  int columns = 0;
};

struct EnvironmentMap {
  int width_px = 0, height_px = 0;
  std::vector<Rgb> radiance;  // row 0 at the zenith; column 0 starts at azimuth 0
  MapFrame frame;
  RowDistribution rows;        // one row: which line of the map
  RowDistribution columns;     // of each line
  std::vector<float> density;  // per cell, over the unit square of (u, v)
  float power = 0;             // ∫ luminance dω
};

// Radiance: width × height, row 0 at the frame's zenith.
EnvironmentMap make_environment_map(int width_px, int height_px, std::vector<Rgb> radiance,
                                    const MapFrame& frame);

// A place on the map: both 0…1, v = 0 at the zenith.
struct MapPoint {
  float u = 0, v = 0;
  float sin_theta = 1;  // of the angle from the zenith
};
inline int cell_of(float x, int count) {
  const int cell = int(x * float(count));
  return cell < count ? cell : count - 1;
}

inline MapPoint map_point(const EnvironmentMap& map, Vec3f wi) {
  const float x = dot(wi, map.frame.x);
  const float y = dot(wi, map.frame.y);
  const float z = clamp_to(dot(wi, map.frame.z), -1.0F, 1.0F);
  return {turn_of(y, x), angle_of_cosine(z) * std::numbers::inv_pi_v<float>,
          std::sqrt(max_of(x * x + y * y, 1e-14F))};
}

// radiance: the map's own or another of its size.
inline Rgb eval_environment_map(const EnvironmentMap& map, std::span<const Rgb> radiance,
                                MapPoint at) {
  const int w = map.width_px;
  const int h = map.height_px;
  const float x = at.u * float(w) - 0.5F;
  const float y = at.v * float(h) - 0.5F;
  // Truncation is the floor of x + 1 > 0.
  const int left = int(x + 1.0F) - 1;
  const int top = int(y + 1.0F) - 1;
  const int x0 = left < 0 ? w - 1 : left;
  const int x1 = left + 1 < w ? left + 1 : 0;
  const int y0 = top < 0 ? 0 : top;
  const int y1 = top + 1 < h ? top + 1 : h - 1;
  const float fx = x - float(left);
  const float fy = y - float(top);
  const Rgb* row0 = radiance.data() + std::size_t(y0) * std::size_t(w);
  const Rgb* row1 = radiance.data() + std::size_t(y1) * std::size_t(w);
  return (row0[x0] * (1.0F - fx) + row0[x1] * fx) * (1.0F - fy) +
         (row1[x0] * (1.0F - fx) + row1[x1] * fx) * fy;
}

inline constexpr float kTwoPiSquared = float(2.0 * kPi * kPi);

inline float pdf_environment_map(const EnvironmentMap& map, MapPoint at) {
  const std::size_t cell = std::size_t(cell_of(at.v, map.height_px)) * std::size_t(map.width_px) +
                           std::size_t(cell_of(at.u, map.width_px));
  return map.density[cell] / (kTwoPiSquared * at.sin_theta);
}

struct CellSample {
  std::size_t cell;
  float position;  // 0…1 over the whole row
};

inline CellSample sample_row(const RowDistribution& d, std::size_t row, float u) {
  const std::size_t n = std::size_t(d.columns);
  const float* cumulative = &d.cumulative[row * (n + 1)];
  std::size_t i = d.guide[row * n + std::size_t(cell_of(u, d.columns))];
  while (cumulative[i + 1] <= u && i + 1 < n) {
    ++i;
  }
  const float within = (u - cumulative[i]) / (cumulative[i + 1] - cumulative[i]);
  return {i, (float(i) + min_of(within, 0x1.fffffep-1F)) / float(n)};
}

struct EnvironmentMapSample {
  Vec3f wi;
  MapPoint at;
};

inline EnvironmentMapSample sample_environment_map(const EnvironmentMap& map, Vec2f u) {
  const CellSample row = sample_row(map.rows, 0, u.y);
  const CellSample column = sample_row(map.columns, row.cell, u.x);
  const Vec2f azimuth = unit_circle(column.position);
  const Vec2f polar = unit_circle(0.5F * row.position);
  const Vec3f horizontal = map.frame.x * azimuth.x + map.frame.y * azimuth.y;
  return {horizontal * polar.y + map.frame.z * polar.x,
          {column.position, row.position, max_of(polar.y, 1e-7F)}};
}

}  // namespace arris
