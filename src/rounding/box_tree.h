// box_tree.h — boxes in a tree, to find those that reach into slabs
// Cost       building n log n; a search visits the boxes near the slabs alone, so that a face of many edges
//            does not cost the product of its edges and triangles
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "arris/math.h"

namespace arris {

// All x with low ≤ normal·x ≤ high.
struct SlabBounds {
  Vec3d normal;
  double low, high;
};

struct Box {
  Vec3d low, high;
  std::uint32_t item;  // what is in it
};

// Boxes around a triangle: one, or some around parts of it where one would be mostly empty, as around a long thin
// triangle askew. No part is shorter than `shortest`.
void append_triangle_boxes(const std::array<Vec3d, 3>& corners, double shortest, std::uint32_t item,
                           std::vector<Box>& boxes);

class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes);

  // Visits the item of every box that reaches into all the slabs, and some beside it.
  template <class Visit>
  void for_each_near(std::span<const SlabBounds> slabs, Visit&& visit) const {
    for_each_where(
        [&](const Node& node) {
          return std::ranges::all_of(slabs, [&](const SlabBounds& s) { return reaches(node, s); });
        },
        visit);
  }
  // The same for those that reach into a box.
  template <class Visit>
  void for_each_near(Vec3d low, Vec3d high, Visit&& visit) const {
    const Vec3d middle = (low + high) * 0.5;
    const Vec3d half = (high - low) * 0.5;
    for_each_where([&](const Node& node) { return reaches(node, middle, half); }, visit);
  }
  // The same for those nearer to a place than a distance, which the visitor may make smaller.
  template <class Visit>
  void for_each_within(Vec3d x, double& distance, Visit&& visit) const {
    for_each_where(
        [&](const Node& node) {
          Vec3d beside;
          for (int axis = 0; axis < 3; ++axis) {
            beside[axis] = std::max(std::abs(node.middle[axis] - x[axis]) - node.half[axis], 0.0);
          }
          return length_squared(beside) <= distance * distance;
        },
        visit);
  }
  // Whether one of these is what is looked for; no more are visited then.
  template <class IsIt>
  [[nodiscard]] bool any_near(Vec3d low, Vec3d high, IsIt&& is_it) const {
    const Vec3d middle = (low + high) * 0.5;
    const Vec3d half = (high - low) * 0.5;
    return any_where([&](const Node& node) { return reaches(node, middle, half); }, is_it);
  }
  // Visits the item of every box that the ray meets between two of its t, and some beside it. The visitor may bring
  // the end nearer.
  template <class Visit>
  void for_each_along(Vec3d origin, Vec3d direction, double begin, double& end,
                      Visit&& visit) const {
    const Vec3d inverse(1 / direction.x, 1 / direction.y, 1 / direction.z);
    for_each_where([&](const Node& node) { return is_met(node, origin, inverse, begin, end); },
                   visit);
  }
  // Whether one of the items along a ray, within [begin, end], is it.
  template <class IsIt>
  [[nodiscard]] bool any_along(Vec3d origin, Vec3d direction, double begin, double end,
                               IsIt&& is_it) const {
    const Vec3d inverse(1 / direction.x, 1 / direction.y, 1 / direction.z);
    return any_where([&](const Node& node) { return is_met(node, origin, inverse, begin, end); },
                     is_it);
  }
  [[nodiscard]] bool is_empty() const { return items_.empty(); }
  // Gives the items, which are 0, 1, … and each in some box, numbers in the order of the tree, so that what lies
  // together in space may do so in memory. Returns the old number of each.
  std::vector<std::uint32_t> renumber();
  [[nodiscard]] std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + items_.size() * sizeof(std::uint32_t);
  }

 private:
  struct Node {
    Vec3d middle, half;                  // of the box
    std::uint32_t first = 0, count = 0;  // its items, of a leaf
    std::uint32_t next = 0;              // the node after this one's children
  };

  template <class IsNear, class Visit>
  void for_each_where(IsNear&& is_near, Visit&& visit) const {
    (void)any_where(is_near, [&](std::uint32_t item) {
      visit(item);
      return false;
    });
  }
  template <class IsNear, class IsIt>
  [[nodiscard]] bool any_where(IsNear&& is_near, IsIt&& is_it) const {
    for (std::uint32_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      const bool near = is_near(node);
      if (near) {
        for (std::uint32_t k = 0; k < node.count; ++k) {
          if (is_it(items_[node.first + k])) return true;
        }
      }
      i = near ? i + 1 : node.next;
    }
    return false;
  }

  static bool reaches(const Node& node, const SlabBounds& slab);
  static bool reaches(const Node& node, Vec3d middle, Vec3d half) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(node.middle[axis] - middle[axis]) > node.half[axis] + half[axis]) return false;
    }
    return true;
  }
  // inverse: one over the direction, by axis; infinite across it.
  static bool is_met(const Node& node, Vec3d origin, Vec3d inverse, double begin, double end) {
    for (int axis = 0; axis < 3; ++axis) {
      const double half = node.half[axis] * (1 + 1e-12) + 1e-300;
      const double from = node.middle[axis] - origin[axis];
      if (std::isinf(inverse[axis])) {
        if (std::abs(from) > half) return false;
        continue;
      }
      const double t0 = (from - half) * inverse[axis], t1 = (from + half) * inverse[axis];
      begin = std::max(begin, std::min(t0, t1));
      end = std::min(end, std::max(t0, t1));
    }
    return begin <= end;
  }
  void build(std::span<Box> boxes);

  std::vector<Node> nodes_;  // each before its children
  std::vector<std::uint32_t> items_;
};

}  // namespace arris
