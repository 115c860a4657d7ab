#include "rounding/contacts.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// How far beside the plane of two contacts a direction may lie.
constexpr double kBeside = 1e-4;
// Weights of contacts may be this much below 0: fillets and faces meet without a gap.
constexpr double kLeastWeight = -1e-6;
// Two faces' contacts on their common edge are one.
constexpr double kSame = 1e-5;

bool is_between(Vec3d n, Vec3d a, Vec3d b, Vec3d c) {
  const double volume = dot(a, cross(b, c));
  if (std::abs(volume) < 1e-9) return false;
  return dot(n, cross(b, c)) / volume >= kLeastWeight &&
         dot(n, cross(c, a)) / volume >= kLeastWeight &&
         dot(n, cross(a, b)) / volume >= kLeastWeight;
}

}  // namespace

bool is_between(Vec3d n, Vec3d a, Vec3d b) {
  const double c = dot(a, b), s2 = 1 - c * c;
  if (!(s2 > 1e-12)) return false;
  const double na = dot(n, a), nb = dot(n, b);
  const double alpha = (na - c * nb) / s2, beta = (nb - c * na) / s2;
  if (alpha < kLeastWeight || beta < kLeastWeight) return false;
  return length_squared(n - a * alpha - b * beta) < kBeside * kBeside;
}

Contacts::Contacts(const SolidSurface& surface, Vec3d c, double most) {
  struct Nearest {
    double squared;
    Vec3d foot;
  };
  std::array<Nearest, kMost> nearest;
  surface.for_each_near(c - Vec3d(most), c + Vec3d(most), [&](const SurfaceTriangle& t) {
    if (is_plainly_beyond(c, t, most)) return;
    const Vec3d foot = nearest_on_triangle(c, t) - c;
    const double squared = length_squared(foot);
    if (squared > most * most) return;
    const auto end = regions_.begin() + std::ptrdiff_t(region_count_);
    const auto k = std::size_t(std::find(regions_.begin(), end, t.region) - regions_.begin());
    if (k == region_count_) {
      if (k == kMost) return;
      regions_[region_count_++] = t.region;
    } else if (squared >= nearest[k].squared) {
      return;
    }
    nearest[k] = {squared, foot};
  });
  for (std::size_t k = 0; k < region_count_; ++k) {
    const Vec3d toward = normalize(nearest[k].foot);
    const auto is_same = [&](Vec3d other) {
      return length_squared(other - toward) < kSame * kSame;
    };
    const auto known = this->toward();
    if (std::none_of(known.begin(), known.end(), is_same)) toward_[count_++] = toward;
  }
}

bool Contacts::hold(Vec3d n) const {
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = i + 1; j < count_; ++j) {
      if (arris::is_between(n, toward_[i], toward_[j])) return true;
      for (std::size_t k = j + 1; k < count_; ++k) {
        if (is_between(n, toward_[i], toward_[j], toward_[k])) return true;
      }
    }
  }
  return false;
}

bool Contacts::are_at_smooth_edge(const SolidSurface& surface) const {
  for (std::size_t k = 0; k < region_count_; ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      if (surface.is_joined(regions_[i], regions_[k])) return true;
    }
  }
  return false;
}

Contacts::Spread Contacts::spread() const {
  Vec3d sum;
  double least_cosine = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    sum += toward_[i];
    for (std::size_t j = 0; j < i; ++j) {
      least_cosine = std::min(least_cosine, dot(toward_[i], toward_[j]));
    }
  }
  const double half_cosine = std::sqrt(std::clamp(0.5 * (1 + least_cosine), 0.0, 1.0));
  return {length(sum) < kSame ? Vec3d() : normalize(sum), half_cosine};
}

}  // namespace arris
