#include "shading/environment.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <variant>

#include "base/frame.h"
#include "base/scalar.h"
#include "base/trigonometry.h"
#include "shading/environment_models.h"

namespace arris {
namespace {

float relative_luminance(Rgb c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

// Mean over a cell and its eight neighbours, as bilinear lookups reach that far: none that sees light is left out.
std::vector<double> sampling_weights(const EnvironmentMap& map) {
  const int w = map.width_px;
  const int h = map.height_px;
  std::vector<double> weights(std::size_t(w) * std::size_t(h));
  for (int y = 0; y < h; ++y) {
    const double sin_theta = std::sin(kPi * (y + 0.5) / h);
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        const int row = y + dy < 0 ? 0 : y + dy < h ? y + dy : h - 1;
        for (int dx = -1; dx <= 1; ++dx) {
          const int column = (x + dx + w) % w;
          sum += double(relative_luminance(
              map.radiance[std::size_t(row) * std::size_t(w) + std::size_t(column)]));
        }
      }
      weights[std::size_t(y) * std::size_t(w) + std::size_t(x)] = sum * sin_theta / 9.0;
    }
  }
  return weights;
}

RowDistribution make_rows(std::span<const double> weights, int columns) {
  const std::size_t n = std::size_t(columns);
  const std::size_t row_count = weights.size() / n;
  RowDistribution d;
  d.columns = columns;
  d.cumulative.resize(row_count * (n + 1));
  d.guide.resize(row_count * n);
  for (std::size_t row = 0; row < row_count; ++row) {
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      total += weights[row * n + i];
    }
    float* cumulative = &d.cumulative[row * (n + 1)];
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      cumulative[i] = total > 0 ? float(sum / total) : float(i) / float(n);
      sum += weights[row * n + i];
    }
    cumulative[n] = 1.0F;
    std::size_t i = 0;
    for (std::size_t k = 0; k < n; ++k) {
      while (i + 1 < n && cumulative[i + 1] <= float(k) / float(n)) {
        ++i;
      }
      d.guide[row * n + k] = std::uint16_t(i);
    }
  }
  return d;
}

float cell_probability(const RowDistribution& d, std::size_t row, std::size_t cell) {
  const float* cumulative = &d.cumulative[row * (std::size_t(d.columns) + 1)];
  return cumulative[cell + 1] - cumulative[cell];
}

// The shortest rotation that takes z to up, then `rotation` about up, counter-clockwise from above.
MapFrame frame_about(Vec3d up_given, double rotation) {
  const Vec3d up = normalize(up_given);
  Vec3d x{1, 0, 0};
  Vec3d y{0, 1, 0};
  if (up.z < -0.999999) {
    y = {0, -1, 0};
  } else {
    const double a = 1.0 / (1.0 + up.z);
    x = {1.0 - up.x * up.x * a, -up.x * up.y * a, -up.x};
    y = {-up.x * up.y * a, 1.0 - up.y * up.y * a, -up.y};
  }
  const double c = std::cos(rotation);
  const double s = std::sin(rotation);
  return {Vec3f(x * c + y * s), Vec3f(y * c - x * s), Vec3f(up)};
}

SunDisc make_sun_disc(Vec3f direction, const SunModel& sun) {
  const Frame frame = make_frame(direction);
  const float solid_angle = float(2.0 * kPi * (1.0 - std::cos(sun.angular_radius)));
  return {direction,
          frame.tangent,
          frame.bitangent,
          sun.irradiance / solid_angle,
          float(std::cos(sun.angular_radius)),
          solid_angle};
}

struct EnvironmentMaker {
  EnvironmentLight operator()(const ConstantEnvironment& e) const {
    EnvironmentLight light;
    light.constant = e.radiance;
    return light;
  }
  EnvironmentLight operator()(const SkyEnvironment& e) const {
    EnvironmentLight light;
    const MapFrame frame = frame_about(e.up, 0);
    const Vec3d towards = normalize(e.sun_direction);
    const Vec3f sun{dot(Vec3f(towards), frame.x), dot(Vec3f(towards), frame.y),
                    dot(Vec3f(towards), frame.z)};
    SkyModel sky = make_sky_model(sun, e.turbidity, e.strength);
    light.kind = EnvironmentKind::map;
    light.map = make_environment_map(sky.width_px, sky.height_px, std::move(sky.radiance), frame);
    if (e.sun && sky.sun) {
      light.suns.push_back(make_sun_disc(Vec3f(towards), *sky.sun));
    }
    return light;
  }
  EnvironmentLight operator()(const HdrEnvironment& e) const {
    EnvironmentLight light;
    light.kind = EnvironmentKind::map;
    // Columns run clockwise seen from above, from -x: the picture's middle looks along +x.
    MapFrame frame = frame_about(e.up, e.rotation);
    frame.x = -frame.x;
    std::vector<Rgb> radiance = e.radiance;
    for (Rgb& c : radiance) {
      c = max(c, Rgb(0.0F)) * float(e.strength);
    }
    light.map = make_environment_map(e.width_px, e.height_px, std::move(radiance), frame);
    return light;
  }
  EnvironmentLight operator()(const StudioEnvironment& e) const {
    EnvironmentLight light;
    light.kind = EnvironmentKind::map;
    StudioModel studio = make_studio_model(e.strength);
    light.backdrop = std::move(studio.backdrop);
    light.map = make_environment_map(studio.width_px, studio.height_px, std::move(studio.radiance),
                                     frame_about(e.up, e.rotation));
    return light;
  }
};

}  // namespace

EnvironmentLight make_environment_light(const Environment& environment) {
  return std::visit(EnvironmentMaker{}, environment);
}

EnvironmentMap make_environment_map(int width_px, int height_px, std::vector<Rgb> radiance,
                                    const MapFrame& frame) {
  EnvironmentMap map;
  map.width_px = width_px;
  map.height_px = height_px;
  map.radiance = std::move(radiance);
  map.frame = frame;
  const std::vector<double> weights = sampling_weights(map);
  const std::size_t w = std::size_t(width_px);
  const std::size_t h = std::size_t(height_px);
  std::vector<double> row_sums(h, 0.0);
  double total = 0;
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      row_sums[y] += weights[y * w + x];
    }
    total += row_sums[y];
  }
  map.power = float(total * 2.0 * kPi * kPi / double(w * h));
  map.rows = make_rows(row_sums, height_px);
  map.columns = make_rows(weights, width_px);
  map.density.resize(w * h);
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      map.density[y * w + x] =
          cell_probability(map.rows, 0, y) * cell_probability(map.columns, y, x) * float(w * h);
    }
  }
  return map;
}

}  // namespace arris
