#include "rounding/stuck_places.h"

#include <bit>
#include <cmath>

#include "base/frame.h"

namespace arris {
namespace {

// Of the radius.
constexpr double kSpacing = 1.0 / 8;
constexpr double kNormalSteps = 1024;

}  // namespace

StuckPlaces::StuckPlaces(double radius) : spacing_(kSpacing * radius) {}

// Nearly the same for normals that are computed in other ways. The frame jumps between 0 and −0.
StuckPlaces::Axes StuckPlaces::axes_across(Vec3d normal) {
  const auto coarse = [](double x) {
    return float(std::round(x * kNormalSteps) / kNormalSteps + 0.0);
  };
  const Vec3f about(coarse(normal.x), coarse(normal.y), coarse(normal.z));
  const Vec3d u = normalize(cross(Vec3d(make_frame(normalize(about)).tangent), normal));
  return {about, u, cross(normal, u)};
}

std::uint64_t StuckPlaces::hash_of(std::uint32_t face, const Axes& axes,
                                   const std::array<double, 2>& cell) {
  std::uint64_t hash = face;
  for (const float x : {axes.about.x, axes.about.y, axes.about.z}) {
    hash = hash_with(hash, std::bit_cast<std::uint32_t>(x));
  }
  for (const double x : cell)
    hash = hash_with(hash, std::bit_cast<std::uint64_t>(x + 0.0));  // -0 is 0
  return hash;
}

}  // namespace arris
