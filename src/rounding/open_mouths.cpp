#include "rounding/open_mouths.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/contacts.h"
#include "rounding/stretches.h"

namespace arris {
namespace {

constexpr std::size_t kPartsAtOnce = 64;
// Of the radius: what lies behind the end of a fillet, along it, is longer by no more than this.
constexpr double kWayAtEnd = 3;
// Of the radius: steps in which a crease is looked at.
constexpr double kStep = 1;
constexpr int kMostSteps = 64;
// Cosine of half the angle between contacts below which their planes don't meet.
constexpr double kLeastCosine = 1e-5;
// Relative to the radius: what lies nearer to a ball is on it, and so far beside the end of a crease is beside it.
constexpr double kOnBall = 1e-6;

}  // namespace

OpenMouths::OpenMouths(const SolidSurface& surface, const CreasePipes& pipes, double tolerance)
    : tolerance_(tolerance) {
  // Whether what lies behind a ball ends at the mesh, or at balls on the other side.
  const auto is_backed = [&](const CreaseCurve& curve, double u) {
    const double r = curve.radius_at(u);
    const Vec3d c = curve.at(u);
    const auto [n, half_cosine] = Contacts(surface, c, r + tolerance).spread();
    if (half_cosine < kLeastCosine || length_squared(n) == 0) return true;
    const double most = 2 * (r / half_cosine - r) + kWayAtEnd * r;
    const Vec3d x = c + n * r;
    return std::isfinite(surface.first_exit(x, n, -tolerance, most).t) ||
           pipes.first_entry(x + n * tolerance, n, most).has_value();
  };
  const auto find = [&](std::size_t i, std::vector<Mouth>& list) {
    const CreaseCurve& curve = pipes.curve_of(std::uint32_t(i));
    const double middle = 0.5 * (curve.u0 + curve.u1), r = curve.radius_at(middle);
    const Contacts contacts(surface, curve.at(middle), r + tolerance);
    if (contacts.toward().size() < 2 || contacts.are_at_smooth_edge(surface)) return;
    const double extent = length(curve.at(curve.u1) - curve.at(curve.u0));
    const int steps = std::clamp(int(std::ceil(extent / (kStep * r))), 1, kMostSteps);
    const auto place = [&](double part) { return curve.u0 + (curve.u1 - curve.u0) * part; };
    const auto is_open = [&](double part) { return !is_backed(curve, place(part)); };
    for (const auto& [from, to] : find_stretches(steps, is_open)) {
      CreaseCurve part = curve;
      part.u0 = place(from);
      part.u1 = place(to);
      part.r0 = curve.radius_at(part.u0);
      part.r1 = curve.radius_at(part.u1);
      list.push_back({std::uint32_t(i), part, r / contacts.spread().half_cosine});
    }
  };
  mouths_ = parallel_collect<Mouth>(pipes.part_count(), kPartsAtOnce, find);
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < mouths_.size(); ++i) {
    const CreaseCurve& c = mouths_[i].curve;
    const Vec3d p0 = c.at(c.u0), p1 = c.at(c.u1);
    const Vec3d reach(mouths_[i].height + pipes.bulge_of(mouths_[i].part));
    boxes.push_back({min(p0, p1) - reach, max(p0, p1) + reach, i});
  }
  tree_ = BoxTree(std::move(boxes));
}

bool OpenMouths::hold(const SolidSurface& surface, Vec3d x) const {
  if (mouths_.empty()) return false;
  return tree_.any_near(x, x, [&](std::uint32_t i) {
    const CreaseCurve& curve = mouths_[i].curve;
    const double u = nearest_parameter(curve, x), r = curve.radius_at(u);
    const Vec3d c = curve.at(u), v = x - c;
    const double distance = length(v);
    if (distance < (1 - kOnBall) * r) return false;
    // Beyond an end.
    if (std::abs(dot(v, normalize(curve.derivative(u)))) > kOnBall * r) return false;
    const Contacts contacts(surface, c, r + tolerance_);
    const auto [middle, half_cosine] = contacts.spread();
    return dot(v, middle) * half_cosine <= (1 + kOnBall) * r && contacts.hold(v / distance);
  });
}

bool OpenMouths::is_behind(std::uint32_t part) const {
  return std::ranges::binary_search(mouths_, part, {}, &Mouth::part);
}

}  // namespace arris
