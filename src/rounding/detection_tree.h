// detection_tree.h — the paper's kd-tree over the regions where edges round the faces (§3.1, §3.2)
// What       finds the arcs whose band on a face holds a point of that face
// Source     Courtin et al. §3.2: binary splits along the longest axis (here: in its middle), one tree per object or
//            group of simple objects (here: per solid).
//            The paper's entries are detection cylinders from vertex to vertex. By Thales such a cylinder
//            cuts its faces exactly along the bands (bands.h), but beside obtuse corners and at corners of more than
//            three faces it leaves void points out. So the entries here are boxes of the bands themselves, and
//            the test is the bands' own.
// Guarantee  finds what the bands of the hit's triangle find, on exact solids and others
//            (tests/rounding/bands_test.cpp)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/math.h"

namespace arris {

// Part of a face that one arc's rounding takes away; box in the solid's coordinates.
struct DetectionEntry {
  Vec3f low, high;
  std::uint32_t face;
  std::uint32_t arc;
  bool whole_face;
};

class DetectionTree {
 public:
  // entries_by_solid: one vector for each solid.
  explicit DetectionTree(std::span<const std::vector<DetectionEntry>> entries_by_solid);

  // Entries whose box may hold the point.
  [[nodiscard]] std::span<const DetectionEntry> find(std::uint32_t solid, Vec3f point) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct TreeNode {
    float split = 0;
    std::uint32_t axis_or_leaf = 0;  // 0..2: axis; 3: leaf
    std::uint32_t first = 0;         // child (the second follows) or first entry
    std::uint32_t count = 0;
  };
  void build(std::uint32_t node, std::span<const DetectionEntry> items, int depth);

  std::vector<TreeNode> nodes_;
  std::vector<std::uint32_t> roots_;     // per solid
  std::vector<DetectionEntry> entries_;  // copied into every leaf that they reach into
};

}  // namespace arris
