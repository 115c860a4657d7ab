// contacts.h — where a ball within a solid touches its surface, and which directions lie between these places
// In / Out   coordinates relative to the solid's centre; directions are unit, from the ball's centre
// Limits     twelve faces; those that are found later are left out
// Cost       a search of the surface
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rounding/solid_surface.h"

namespace arris {

// Whether n = α a + β b, nearly, with α, β ≥ 0.
bool is_between(Vec3d n, Vec3d a, Vec3d b);

class Contacts {
 public:
  // Of each face the nearest place within `most` of c: beside its foot on a plane, a ball is within the tolerance of
  // other triangles, too.
  Contacts(const SolidSurface& surface, Vec3d c, double most);

  [[nodiscard]] std::span<const Vec3d> toward() const { return {toward_.data(), count_}; }
  // Whether a direction lies in their cone.
  [[nodiscard]] bool hold(Vec3d n) const;
  // Whether two are on faces that meet in a smooth edge.
  [[nodiscard]] bool are_at_smooth_edge(const SolidSurface& surface) const;
  // Their middle, and the cosine of half the widest angle between two; nothing of fewer.
  struct Spread {
    Vec3d middle;
    double half_cosine = 1;
  };
  [[nodiscard]] Spread spread() const;

 private:
  static constexpr std::size_t kMost = 12;
  std::array<Vec3d, kMost> toward_;
  std::array<std::uint32_t, kMost> regions_;
  std::size_t count_ = 0, region_count_ = 0;
};

}  // namespace arris
