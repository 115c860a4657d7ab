// uniform_rule.h — do four rays meet a list alike?
// What       The second half of the paper's test (§2.1), of vision and of light: without the operations the four rays
//            meet the same faces in the same order, and every primitive of the list.
// Guarantee  none for what is between the rays: see docs/beam.md
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §2.1
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "beam/region_look.h"
#include "csg/leaf_crossings.h"

namespace arris {

// Of a ray's length: crossings elsewhere don't count.
struct Reach {
  double from = 0;
  double to = std::numeric_limits<double>::infinity();
};

// Buffers for one thread.
class UniformRule {
 public:
  explicit UniformRule(std::span<const BeamSolid> solids) : solids_(solids) {}

  [[nodiscard]] bool are_alike(const std::vector<BeamPart>& parts, const std::array<Ray, 4>& rays,
                               const Reach& reach);

 private:
  // A crossing of a ray with a primitive, whatever the operations make of it.
  struct Bare {
    double t;
    std::uint32_t solid, leaf, face;

    // Wherever it is.
    friend bool operator==(const Bare& a, const Bare& b) {
      return a.solid == b.solid && a.leaf == b.leaf && a.face == b.face;
    }
  };

  std::vector<Bare> cross_all(const std::vector<BeamPart>& parts, const Ray& ray,
                              const Reach& reach);

  std::span<const BeamSolid> solids_;
  LeafCrossings crossings_;
};

}  // namespace arris
