#include "rounding/stuck_places.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/frame.h"

namespace arris {
namespace {

// Of the radius.
constexpr double kSpacing = 1.0 / 8;
constexpr double kNormalSteps = 1024;
// Of the table: 8 bytes to a place.
constexpr int kLeastBits = 10, kMostBits = 19;

// One round of SplitMix64. G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators" (2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

StuckPlaces::StuckPlaces(double radius, double area)
    : spacing_(kSpacing * radius), table_(std::make_unique<Table>()) {
  const double places = 2 * area / (spacing_ * spacing_);
  bits_ = std::clamp(int(std::ceil(std::log2(std::max(places, 1.0)))), kLeastBits, kMostBits);
}

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
    hash = mixed(hash ^ std::bit_cast<std::uint32_t>(x));
  }
  for (const double x : cell)
    hash = mixed(hash ^ std::bit_cast<std::uint64_t>(x + 0.0));  // -0 is 0
  return hash;
}

std::atomic<std::uint64_t>& StuckPlaces::entry_of(std::uint64_t hash) const {
  std::call_once(table_->once, [&] {
    table_->entries = std::make_unique<std::atomic<std::uint64_t>[]>(std::size_t{1} << bits_);
  });
  return table_->entries[hash >> (64 - bits_)];
}

}  // namespace arris
