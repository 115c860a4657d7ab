#include "rounding/narrow_cells.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "rounding/thin_walls.h"

namespace arris {
namespace {

// Of the radius: a cell's size; and the largest balls that are asked about.
constexpr double kCell = 0.5, kLargest = 2.5;

}  // namespace

bool NarrowCells::may_be_between_walls(const SolidSurface& surface, Vec3d center,
                                       double radius) const {
  if (!surface.has_walls()) return false;
  if (radius > kLargest * radius_) return true;
  const double cell = kCell * radius_;
  Vec3d middle;
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor(center[axis] / cell);
    hash = hash_with(hash, std::bit_cast<std::uint64_t>(at + 0.0));  // -0 is 0
    middle[axis] = (at + 0.5) * cell;
  }
  const double beside = 0.5 * std::sqrt(3.0) * cell;
  return table_.answer(hash, [&] {
    return is_between_walls(surface, middle, kLargest * radius_ + beside) ? 1U : 0U;
  }) != 0;
}

}  // namespace arris
