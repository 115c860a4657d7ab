// environment.h — light from infinitely far: constant, sky, HDR map, studio
// What       all but the constant one are brought into one form: an equirectangular map of radiance
//            with a piecewise constant density, and for the sky a sun disc as an emitter of its own
// In / Out   world directions, unit, towards the environment; pdfs per solid angle
// Guarantee  wherever the map has radiance its density is positive
//            (tests/shading/environment_test.cpp)
// Cost       sampling: two guided table searches, about three comparisons each; evaluation: one
//            bilinear lookup
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"

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

struct SunDisc {
  Vec3f direction;  // towards it
  Vec3f tangent, bitangent;
  Rgb radiance;
  float cos_radius = 1;
  float solid_angle = 0;
};

enum class EnvironmentKind : std::uint8_t { constant, map };

struct EnvironmentLight {
  EnvironmentKind kind = EnvironmentKind::constant;
  Rgb constant;
  EnvironmentMap map;
  std::vector<Rgb> backdrop;  // map that the camera sees instead, same size, or empty
  std::vector<SunDisc> suns;  // none or one
};

EnvironmentLight make_environment_light(const Environment& environment);

// Radiance: width × height, row 0 at the frame's zenith.
EnvironmentMap make_environment_map(int width_px, int height_px, std::vector<Rgb> radiance,
                                    const MapFrame& frame);

// A place on the map: both 0…1, v = 0 at the zenith.
struct MapPoint {
  float u = 0, v = 0;
  float sin_theta = 1;  // of the angle from the zenith
};
MapPoint map_point(const EnvironmentMap& map, Vec3f wi);

// radiance: the map's own or another of its size.
Rgb eval_environment_map(const EnvironmentMap& map, std::span<const Rgb> radiance, MapPoint at);
float pdf_environment_map(const EnvironmentMap& map, MapPoint at);

struct EnvironmentMapSample {
  Vec3f wi;
  MapPoint at;
};
EnvironmentMapSample sample_environment_map(const EnvironmentMap& map, Vec2f u);

Vec3f sample_sun(const SunDisc& sun, Vec2f u);
inline bool is_in_sun(const SunDisc& sun, Vec3f wi) {
  return dot(wi, sun.direction) >= sun.cos_radius;
}

}  // namespace arris
