// separation.h — is there a plane between a beam and a primitive?
// What       The paper's position tests (§2.3): the planes of the beam, then planes through each of its edges that
//            touch the primitive. A primitive lies on one side of a plane if its extreme points do: of a sphere
//            along the plane's normal, of a cylinder the points Q on both rims, of a cone those and the apex, of a
//            facet its corners, of any other the corners of its box.
//            A beam is four rays in turn and what is between them: from an eye, or from a light to what it lights
//            (light_pyramid.h), and then it ends at its base.
// Guarantee  a plane that is found separates, but for rounding. None may be found though there is one.
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996, §2.3
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "beam/region_look.h"

namespace arris {

// The beam is where `toward` points from a plane. What touches the plane from behind is behind it.
struct PyramidBase {
  Vec3d origin, along[2];
  Vec3d toward;  // any vector that leads to that side
};

struct Pyramid {
  std::array<Ray, 4> edges;  // from one apex, or parallel
  std::optional<PyramidBase> base;
};

Pyramid transform(const Affine3d& m, const Pyramid& beam);

// Tests the leaves of one solid.
class BeamSeparation {
 public:
  // In the space of the solid.
  explicit BeamSeparation(const Pyramid& beam);

  [[nodiscard]] bool is_separated(const BeamShape& shape, std::uint32_t leaf) const;

 private:
  [[nodiscard]] bool is_box_outside(const Box3d& box) const;

  Pyramid beam_;
  // The beam's own planes, where they don't cut it: it is behind, normal·x <= d.
  std::vector<CsgPlane> planes_;
};

// What of the parts may be in a beam of the world.
std::vector<BeamPart> parts_near(std::span<const BeamSolid> solids,
                                 const std::vector<BeamPart>& parts, const Pyramid& beam);

}  // namespace arris
