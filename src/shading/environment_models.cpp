#include "shading/environment_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace arris {
namespace {

constexpr int kSkyWidth = 512;
constexpr int kSkyHeight = 256;
constexpr int kStudioWidth = 512;
constexpr int kStudioHeight = 256;

// Radiance that one kcd/m² becomes: sunlit white is about 32 kcd/m² and shall be about 1.
constexpr double kRadiancePerKcd = 1.0 / 32.0;
constexpr double kGroundAlbedo = 0.25;
constexpr double kSolarIlluminanceKlx = 128;
constexpr double kSunAngularRadius = radians(0.2665);
// Below this height the fits' 1/cosθ runs away; the horizon's own value is used.
constexpr double kHorizonCosine = 0.01;

Vec3d direction_of_texel(int x, int y, int width, int height) {
  const double theta = kPi * (y + 0.5) / height;
  const double phi = 2.0 * kPi * (x + 0.5) / width;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Perez et al.'s five-parameter distribution.
struct Perez {
  double a, b, c, d, e;

  [[nodiscard]] double at(double cos_theta, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    return (1.0 + a * std::exp(b / cos_theta)) *
           (1.0 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
  }
};

// Zenith chromaticity: rows for T², T, 1; columns for θ³, θ², θ, 1.
using ZenithMatrix = std::array<std::array<double, 4>, 3>;
constexpr ZenithMatrix kZenithX = {{{0.00166, -0.00375, 0.00209, 0},
                                    {-0.02903, 0.06377, -0.03202, 0.00394},
                                    {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr ZenithMatrix kZenithY = {{{0.00275, -0.00610, 0.00317, 0},
                                    {-0.04214, 0.08970, -0.04153, 0.00516},
                                    {0.15346, -0.26756, 0.06670, 0.26688}}};

double zenith_chromaticity(const ZenithMatrix& m, double t, double theta) {
  std::array<double, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    rows[i] = ((m[i][0] * theta + m[i][1]) * theta + m[i][2]) * theta + m[i][3];
  }
  return (rows[0] * t + rows[1]) * t + rows[2];
}

Vec3d rgb_of_xyy(double x, double y, double luminance) {
  const double scale = luminance / y;
  const Vec3d xyz{x * scale, luminance, (1.0 - x - y) * scale};
  const Vec3d rgb{3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                  -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                  0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
  return max(rgb, Vec3d(0.0));
}

// Preetham et al., appendix 1; luminance in kcd/m².
class PreethamSky {
 public:
  PreethamSky(Vec3d towards_sun, double turbidity)
      : sun_(towards_sun), theta_sun_(std::acos(towards_sun.z)) {
    const double t = turbidity;
    luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                  0.1206 * t - 2.5771, -0.0670 * t + 0.3703};
    x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
          -0.0033 * t + 0.0452};
    y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
          -0.0109 * t + 0.0529};
    const double chi = (4.0 / 9.0 - t / 120.0) * (kPi - 2.0 * theta_sun_);
    zenith_luminance_ = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    zenith_x_ = zenith_chromaticity(kZenithX, t, theta_sun_);
    zenith_y_ = zenith_chromaticity(kZenithY, t, theta_sun_);
  }

  [[nodiscard]] Vec3d radiance(Vec3d w) const {
    const double cos_theta = std::fmax(w.z, kHorizonCosine);
    const double gamma = std::acos(std::fmin(std::fmax(dot(w, sun_), -1.0), 1.0));
    const auto relative = [&](const Perez& f) {
      return f.at(cos_theta, gamma) / f.at(1.0, theta_sun_);
    };
    const double luminance = std::fmax(0.0, zenith_luminance_ * relative(luminance_));
    return rgb_of_xyy(zenith_x_ * relative(x_), zenith_y_ * relative(y_), luminance);
  }

 private:
  Vec3d sun_;
  double theta_sun_;
  Perez luminance_{}, x_{}, y_{};
  double zenith_luminance_, zenith_x_, zenith_y_;
};

// Preetham et al., appendix 2, at the wavelengths (µm) that stand for red, green and blue.
Vec3d sun_illuminance_klx(double theta, double turbidity) {
  constexpr std::array<double, 3> kWavelength = {0.615, 0.535, 0.445};
  constexpr std::array<double, 3> kOzoneDepth = {0.042, 0.023, 0.001};  // of 0.35 cm
  const double air_mass =
      1.0 / (std::cos(theta) + 0.15 * std::pow(93.885 - degrees(theta), -1.253));
  const double beta = 0.04608 * turbidity - 0.04586;
  Vec3d result;
  for (int c = 0; c < 3; ++c) {
    const double wavelength = kWavelength[std::size_t(c)];
    const double rayleigh = 0.008735 * std::pow(wavelength, -4.08);
    const double aerosol = beta * std::pow(wavelength, -1.3);
    result[c] = kSolarIlluminanceKlx *
                std::exp(-air_mass * (rayleigh + aerosol + kOzoneDepth[std::size_t(c)]));
  }
  return result;
}

double smoothstep(double edge0, double edge1, double x) {
  const double t = std::fmin(std::fmax((x - edge0) / (edge1 - edge0), 0.0), 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A rectangle on a sphere about the model, with soft edges; sizes are tangents of half angles.
struct Softbox {
  double azimuth_deg, elevation_deg;
  double half_width, half_height;
  double softness;  // share of the half size over which it fades
  double radiance;
};

// Its axes, each divided so that the box's edges are at 1.
struct PlacedSoftbox {
  Vec3d x, y, z;
  double start, radiance;
};

PlacedSoftbox place(const Softbox& box) {
  const double azimuth = radians(box.azimuth_deg);
  const double elevation = radians(box.elevation_deg);
  const Vec3d z{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation)};
  const Vec3d x{-std::sin(azimuth), std::cos(azimuth), 0.0};
  return {x / box.half_width, cross(z, x) / box.half_height, z, 1.0 - box.softness, box.radiance};
}

double softbox_radiance(const PlacedSoftbox& box, Vec3d w) {
  const double depth = dot(w, box.z);
  const double x = std::fabs(dot(w, box.x));
  const double y = std::fabs(dot(w, box.y));
  if (depth <= 0.0 || x >= depth || y >= depth) {
    return 0.0;
  }
  return box.radiance * (1.0 - smoothstep(box.start, 1.0, x / depth)) *
         (1.0 - smoothstep(box.start, 1.0, y / depth));
}

// Azimuths are those of a viewer at -60°, where the automatic camera stands.
constexpr std::array<Softbox, 4> kSoftboxes = {{
    {-125, 58, 0.70, 0.50, 0.35, 3.2},  // key
    {15, 22, 0.45, 0.70, 0.60, 0.8},    // fill
    {95, 30, 0.22, 0.60, 0.40, 2.6},    // rims
    {165, 24, 0.18, 0.55, 0.40, 2.0},
}};

// The room: light above the horizon, a grey floor below.
double room_radiance(Vec3d w) {
  const double above = 0.30 + 0.12 * std::fabs(w.z);
  const double below = 0.22;
  return below + (above - below) * smoothstep(-0.35, 0.15, w.z);
}

double backdrop_radiance(Vec3d w) {
  return 0.80 - 0.35 * smoothstep(-0.1, 0.9, w.z) - 0.10 * smoothstep(0.1, 0.9, -w.z);
}

}  // namespace

SkyModel make_sky_model(Vec3f towards_sun, double turbidity_given, double strength) {
  const double turbidity = std::fmin(std::fmax(turbidity_given, 1.7), 10.0);
  // A sun below the horizon lights the sky as one on it.
  Vec3d sun(towards_sun);
  if (sun.z < kHorizonCosine) {
    sun.z = kHorizonCosine;
  }
  sun = normalize(sun);
  const PreethamSky sky(sun, turbidity);
  const double scale = kRadiancePerKcd * strength;
  SkyModel model;
  model.width_px = kSkyWidth;
  model.height_px = kSkyHeight;
  model.radiance.resize(std::size_t(kSkyWidth) * std::size_t(kSkyHeight));
  Vec3d horizontal_irradiance;
  for (int y = 0; y < kSkyHeight / 2; ++y) {
    for (int x = 0; x < kSkyWidth; ++x) {
      const Vec3d w = direction_of_texel(x, y, kSkyWidth, kSkyHeight);
      const Vec3d radiance = sky.radiance(w) * scale;
      model.radiance[std::size_t(y) * std::size_t(kSkyWidth) + std::size_t(x)] = Rgb(radiance);
      const double sin_theta = std::sqrt(1.0 - w.z * w.z);
      horizontal_irradiance +=
          radiance * (w.z * sin_theta * 2.0 * kPi * kPi / (double(kSkyWidth) * kSkyHeight));
    }
  }
  if (towards_sun.z > 0.0F) {
    const double theta = std::acos(std::fmin(double(towards_sun.z), 1.0));
    const Vec3d irradiance = sun_illuminance_klx(theta, turbidity) * scale;
    model.sun = SunModel{Rgb(irradiance), kSunAngularRadius};
    horizontal_irradiance += irradiance * double(towards_sun.z);
  }
  const Rgb ground(horizontal_irradiance * (kGroundAlbedo / kPi));
  for (std::size_t i = model.radiance.size() / 2; i < model.radiance.size(); ++i) {
    model.radiance[i] = ground;
  }
  return model;
}

StudioModel make_studio_model(double strength) {
  std::array<PlacedSoftbox, kSoftboxes.size()> boxes{};
  std::ranges::transform(kSoftboxes, boxes.begin(), place);
  StudioModel model;
  model.width_px = kStudioWidth;
  model.height_px = kStudioHeight;
  const std::size_t count = std::size_t(kStudioWidth) * std::size_t(kStudioHeight);
  model.radiance.reserve(count);
  model.backdrop.reserve(count);
  for (int y = 0; y < kStudioHeight; ++y) {
    for (int x = 0; x < kStudioWidth; ++x) {
      const Vec3d w = direction_of_texel(x, y, kStudioWidth, kStudioHeight);
      double radiance = room_radiance(w);
      for (const PlacedSoftbox& box : boxes) {
        radiance += softbox_radiance(box, w);
      }
      model.radiance.emplace_back(float(radiance * strength));
      model.backdrop.emplace_back(float(backdrop_radiance(w) * strength));
    }
  }
  return model;
}

}  // namespace arris
