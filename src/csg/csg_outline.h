// csg_outline.h — where the curved surfaces of a solid turn away from an eye
// What       CsgOutline holds a solid's curved patches; find() gives their outlines from an eye, clipped to what of
//            them is the solid's surface
// In / Out   the tree's space
// Guarantee  lines and circles are exact: the outline of a quadric lies in the eye's polar plane, for cylinders and
//            cones on two straight lines, for ellipsoids (spheres in their unit space) on a circle. The outline of a
//            torus has a closed form along the ring: with the eye e in its frame and E = e·(cos φ, sin φ, 0) it is
//            (R - E) cos ψ - e_z sin ψ = -r. Chords turn by at most kChordTurn (tests/render/csg_edges_test.cpp).
// Limits     along ellipsoids, tori and curved walls, what is shorter than a step of kSteps may be lost or added;
//            along lines nothing is. Outlines that only rays from within the solid could touch are left out, but for
//            those of tori and walls.
// Cost       a few microseconds for each patch; parallel over them
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "csg/cell_probe.h"
#include "csg/smooth_patches.h"

namespace arris {

struct OutlineSegment {
  Vec3d a, b;
  std::uint32_t cell = 0;
};

class CsgOutline {
 public:
  CsgOutline(std::shared_ptr<const CellProbe> probe, std::shared_ptr<const SmoothPatches> patches);

  [[nodiscard]] std::vector<OutlineSegment> find(Vec3d eye, int threads) const;
  [[nodiscard]] std::size_t patch_count() const;

 private:
  std::shared_ptr<const CellProbe> probe_;
  std::shared_ptr<const SmoothPatches> patches_;
  std::vector<Affine3d> object_from_unit_;  // of patches_->curved()
};

}  // namespace arris
