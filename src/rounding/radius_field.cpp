#include "rounding/radius_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace arris {
namespace {

// In largest radii: within the first edges are looked for at first.
constexpr double kReaches[] = {1, 4};

}  // namespace

double EdgeProfile::at(double v) const {
  const auto above = std::ranges::upper_bound(knots, v, {}, &RadiusKnot::v);
  if (above == knots.begin()) return knots.front().radius;
  if (above == knots.end()) return knots.back().radius;
  const RadiusKnot& low = above[-1];
  const double part = (v - low.v) / (above->v - low.v);
  return low.radius + (above->radius - low.radius) * part;
}

RadiusField::RadiusField(std::vector<EdgeProfile> edges) : edges_(std::move(edges)) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    const EdgeProfile& e = edges_[i];
    const Vec3d p1 = e.p0 + e.direction * e.length;
    boxes.push_back({min(e.p0, p1), max(e.p0, p1), i});
    for (const RadiusKnot& knot : e.knots) largest_ = std::max(largest_, knot.radius);
  }
  tree_ = BoxTree(std::move(boxes));
}

std::optional<RadiusField::Nearest> RadiusField::nearest(Vec3d x) const {
  for (const double part : kReaches) {
    Nearest found{part * largest_, -1};
    const Vec3d reach(found.distance);
    tree_.for_each_near(x - reach, x + reach, [&](std::uint32_t i) {
      const EdgeProfile& e = edges_[i];
      const double v = std::clamp(dot(x - e.p0, e.direction), 0.0, e.length);
      const double distance = length(x - e.p0 - e.direction * v);
      if (distance < found.distance) found = {distance, e.at(v)};
    });
    if (found.radius >= 0) return found;
  }
  return std::nullopt;
}

double RadiusField::at(Vec3d x) const {
  if (is_uniform()) return largest_;
  const std::optional<Nearest> found = nearest(x);
  return found ? found->radius : largest_;
}

// An edge that is the nearest to a place of the box is no farther from its middle than the nearest one of that, and
// the box's diagonal.
bool RadiusField::is_uniform_within(Vec3d low, Vec3d high) const {
  if (is_uniform()) return true;
  const Vec3d middle = (low + high) * 0.5;
  const std::optional<Nearest> found = nearest(middle);
  if (!found) return false;
  const Vec3d reach(found->distance + length(high - low));
  return !tree_.any_near(middle - reach, middle + reach, [&](std::uint32_t i) {
    return std::ranges::any_of(
        edges_[i].knots, [&](const RadiusKnot& knot) { return knot.radius != found->radius; });
  });
}

std::size_t RadiusField::bytes() const {
  std::size_t sum = edges_.size() * sizeof(EdgeProfile) + tree_.bytes();
  for (const EdgeProfile& e : edges_) sum += e.knots.size() * sizeof(RadiusKnot);
  return sum;
}

}  // namespace arris
