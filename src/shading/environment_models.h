// environment_models.h — the built-in environments as equirectangular maps
// In / Out   map frame: z up, azimuth from x towards y; row 0 at the zenith; W/(m² sr)
// Source     sky and sun: A. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight"
//            (1999), appendices 1 and 2
#pragma once

#include <optional>
#include <vector>

#include "arris/math.h"

namespace arris {

struct SunModel {
  Rgb irradiance;  // on a surface that faces it
  double angular_radius = 0;
};

struct SkyModel {
  int width_px = 0, height_px = 0;
  std::vector<Rgb> radiance;
  std::optional<SunModel> sun;  // nothing if it is below the horizon
};

// A clear sky; below the horizon a grey ground, lit by it. At strength 1 a white horizontal surface under a
// high sun has a radiance of about 1. Turbidities are taken into [1.7, 10], where the fits hold.
SkyModel make_sky_model(Vec3f towards_sun, double turbidity, double strength);

struct StudioModel {
  int width_px = 0, height_px = 0;
  std::vector<Rgb> radiance;
  std::vector<Rgb> backdrop;  // without the lamps
};

// A large soft key light above, to the left of a viewer who looks from -y; a wide fill on the right, two rim lights
// behind, in a light neutral room. At strength 1 a white horizontal surface has a radiance of about 1.
StudioModel make_studio_model(double strength);

}  // namespace arris
