// fitting_radius.cpp — a radius with which no edge stays sharp for want of room, found by trying
#include <algorithm>
#include <cmath>

#include "arris/rounding.h"

namespace arris {
namespace {

// Halvings of the radius before none is said to fit, and of the ratio between one that fits and one that doesn't.
constexpr int kMostHalvings = 10, kFinerSteps = 4;
constexpr std::size_t kManyTriangles = 2000;

}  // namespace

std::optional<double> find_fitting_radius(const MeshView& mesh, const RoundingOptions& options,
                                          const std::string& name) {
  MeshView plain = mesh;
  plain.edge_radii = {};
  RoundingOptions tried = options;
  tried.too_large = TooLarge::leave_sharp;
  tried.on_overlap = OnOverlap::report;
  tried.rules.clear();
  const auto fits = [&](double radius) {
    tried.radius = radius;
    return make_rounding(plain, tried, name).report().narrow_edges == 0;
  };
  Vec3d low(INFINITY), high(-INFINITY);
  for (const Vec3f& p : mesh.positions) {
    low = min(low, Vec3d(p));
    high = max(high, Vec3d(p));
  }
  double large = std::min(options.radius, length(high - low));
  for (int i = 0; i < kMostHalvings; ++i) {
    double small = 0.5 * large;
    if (!fits(small)) {
      large = small;
      continue;
    }
    const int steps = mesh.triangles.size() > kManyTriangles ? 0 : kFinerSteps;
    for (int k = 0; k < steps; ++k) {
      const double middle = std::sqrt(small * large);
      (fits(middle) ? small : large) = middle;
    }
    return small;
  }
  return std::nullopt;
}

}  // namespace arris
