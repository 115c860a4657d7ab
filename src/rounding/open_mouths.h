// open_mouths.h — where air stays between two lips that balls can't pass
// What       A ball in an undercut groove touches both leaning walls and leaves what is above it, up to where the
//            planes of these meet. If the mesh ends before, this is the groove's mouth, and no crease is known between
//            its lips: filled, it would be a bar with one side. It stays open, as gaps do (thin_walls.h).
// In / Out   coordinates relative to the solid's centre; the solid is the space outside
// Limits     what lies within some five radii behind the balls is taken for the groove's end: then the mouth is filled
// Cost       to find them: some rays for each crease, on all cores; to ask: a search of those near
// Legend     c point of a crease, r radius, a and b directions from there to where the ball touches; the mouth is
//            c + v, |v| ≥ r, v between a and b, no farther than where the planes meet
#pragma once

#include <cstdint>
#include <vector>

#include "rounding/box_tree.h"
#include "rounding/crease_pipes.h"
#include "rounding/solid_surface.h"

namespace arris {

class OpenMouths {
 public:
  OpenMouths() = default;
  OpenMouths(const SolidSurface& surface, const CreasePipes& pipes, double tolerance);

  [[nodiscard]] bool hold(const SolidSurface& surface, Vec3d x) const;
  // Whether one may reach into a box.
  [[nodiscard]] bool is_near(Vec3d low, Vec3d high) const {
    return !mouths_.empty() && tree_.any_near(low, high, [](std::uint32_t) { return true; });
  }
  // Whether a part of the pipes, or some of it, has one behind it.
  [[nodiscard]] bool is_behind(std::uint32_t part) const;
  [[nodiscard]] std::size_t bytes() const { return mouths_.size() * sizeof(Mouth) + tree_.bytes(); }

 private:
  struct Mouth {
    std::uint32_t part;
    CreaseCurve curve;
    double height;  // from the crease, of where planes meet
  };

  double tolerance_ = 0;
  std::vector<Mouth> mouths_;  // by part
  BoxTree tree_{{}};
};

}  // namespace arris
