// detection_tree.h — the paper's kd-tree over detection cylinders (§3.1, §3.2)
// What       finds the arcs whose detection cylinder contains a point of the surface
// Legend     v1, v2 ends of the edge; p1, p2 = v + dH on the axis; the detection cylinder runs from
//            (v1+p1)/2 to (v2+p2)/2 with radius d/2 (Thales: it cuts both faces exactly at the touching lines)
// Source     Courtin et al. §3.1 and §3.2: binary splits along the longest axis, one tree per object (here: per solid)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/math.h"

namespace arris {

struct DetectionCylinder {
  Vec3f end0, end1;
  float radius;
  std::uint32_t arc;
};

class DetectionTree {
 public:
  // cylinders_by_solid: one vector for each solid, in its local coordinates.
  explicit DetectionTree(std::span<const std::vector<DetectionCylinder>> cylinders_by_solid);

  // Arcs of detection cylinders that contain the point (within `slack`): up to `found.size()` of them; returns how
  // many.
  std::size_t find(std::uint32_t solid, Vec3f point, float slack,
                   std::span<std::uint32_t> found) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct TreeNode {
    float split = 0;
    std::uint32_t axis_or_leaf = 0;  // 0..2: axis; 3: leaf
    std::uint32_t first = 0;         // child (second one follows) or first entry
    std::uint32_t count = 0;
  };
  void build(std::uint32_t node, std::vector<std::uint32_t>& items, int depth);

  std::vector<TreeNode> nodes_;
  std::vector<std::uint32_t> roots_;    // per solid
  std::vector<std::uint32_t> entries_;  // indices into cylinders_
  std::vector<DetectionCylinder> cylinders_;
};

}  // namespace arris
