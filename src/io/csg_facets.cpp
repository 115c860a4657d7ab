#include "io/csg_facets.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// OpenSCAD's grid: circles below it have three facets.
constexpr double kGrid = 0.00000095367431640625;
constexpr double kMinAngle = 0.01, kMinSize = 0.01;  // OpenSCAD's, for $fa and $fs

}  // namespace

double fragments(const FacetSettings& settings, double radius) {
  if (!(radius >= kGrid) || !std::isfinite(settings.fn)) return 3;
  if (settings.fn > 0) return std::max(std::floor(settings.fn), 3.0);
  const double fa = std::max(settings.fa, kMinAngle), fs = std::max(settings.fs, kMinSize);
  return std::ceil(std::max(std::min(360 / fa, 2 * kPi * radius / fs), 5.0));
}

bool means_facets(const FacetSettings& settings) {
  return settings.fn > 0 && settings.fn < kMaxMeantFacets + 1;
}

double twist_slices(const FacetSettings& settings, double radius, double height, double twist_deg) {
  const double twist = std::abs(twist_deg);
  const double least = std::max(std::ceil(twist / 120), 1.0);
  if (!(radius >= kGrid) || !std::isfinite(settings.fn)) return least;
  if (settings.fn > 0) return std::max(std::ceil(twist / 360 * settings.fn), least);
  const double helix = std::hypot(radians(twist) * radius, height);
  const double fa = std::max(settings.fa, kMinAngle), fs = std::max(settings.fs, kMinSize);
  return std::max(std::min(std::ceil(twist / fa), std::ceil(helix / fs)), least);
}

std::vector<Vec3d> sphere_points(double radius, int facets) {
  std::vector<Vec3d> points;
  const int rings = (facets + 1) / 2;
  for (int i = 0; i < rings; ++i) {
    const double polar = kPi * (i + 0.5) / rings;
    for (int k = 0; k < facets; ++k) {
      const double angle = 2 * kPi * k / facets;
      points.emplace_back(radius * std::sin(polar) * std::cos(angle),
                          radius * std::sin(polar) * std::sin(angle), radius * std::cos(polar));
    }
  }
  return points;
}

std::vector<Vec3d> cone_points(const CsgCone& cone, int facets) {
  std::vector<Vec3d> points;
  const auto ring = [&](double z, double radius) {
    if (radius == 0) {
      points.emplace_back(0.0, 0.0, z);
      return;
    }
    for (int k = 0; k < facets; ++k) {
      const double angle = 2 * kPi * k / facets;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  };
  ring(cone.z_low, cone.radius_low);
  ring(cone.z_high, cone.radius_high);
  return points;
}

}  // namespace arris
