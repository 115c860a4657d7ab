// leaf_crossings.h — where a line enters and leaves a leaf
// What       all crossings of a line with one leaf's surface, and the face of each
// Guarantee  t depends on ray and surface alone: leaves that share a surface meet it at the same t, to the last bit.
//            Agrees with contains() but within rounding of the surface (tests/csg/leaf_test.cpp)
// Limits     a line that only touches a surface may cross it twice or not at all
// Cost       convex kinds: one dot product for each plane. Prisms and revolutions: linear in the region's edges.
//            Meshes: about linear in what is crossed. No allocation once the buffers have grown.
// Source     intervals: Roth 1982; quadrics from the point nearest to their center, so that nothing cancels
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "arris/rounding.h"
#include "csg/csg_leaf.h"

namespace arris {

struct Crossing {
  double t = 0;
  std::uint32_t face = 0;
};

// Buffers for one thread.
class LeafCrossings {
 public:
  // Ascending, entering and leaving by turns. A half-space may begin or end at infinity. Valid until the next call.
  const std::vector<Crossing>& find(const PlacedLeaf& leaf, const SurfaceTable& surfaces,
                                    const Ray& ray);

 private:
  struct Finder;
  // A ray meets the cells of a solid one after the other, and each asks for the whole line's crossings.
  struct MeshMemo {
    std::uint64_t mesh = 0;  // its digest
    Ray ray;
    std::vector<ClosedMesh::Crossing> crossings;
  };
  const std::vector<ClosedMesh::Crossing>& cross_mesh(const ClosedMesh& mesh, const Ray& ray);

  std::vector<Crossing> candidates_, found_;
  std::vector<ClosedMesh::Crossing> mesh_;
  std::array<MeshMemo, 256> memos_;  // by the digest's last bits
};

}  // namespace arris
