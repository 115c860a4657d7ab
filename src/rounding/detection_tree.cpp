#include "rounding/detection_tree.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr int kMaxDepth = 24;

struct Bounds {
  Vec3f low, high;
};

// Of the cylinder's capsule: a little larger, never too small.
Bounds bounds_of(const DetectionCylinder& c) {
  const Vec3f r(c.radius * 1.0001F);
  return {min(c.end0, c.end1) - r, max(c.end0, c.end1) + r};
}

bool contains(const DetectionCylinder& c, Vec3f p, float slack) {
  const Vec3d axis = Vec3d(c.end1) - Vec3d(c.end0);
  const Vec3d rel = Vec3d(p) - Vec3d(c.end0);
  const double along = dot(rel, axis) / length_squared(axis);
  const double margin = double(slack) / length(axis);
  if (along < -margin || along > 1 + margin) return false;
  const double radius = double(c.radius) + double(slack);
  return length_squared(rel - axis * along) <= radius * radius;
}

}  // namespace

DetectionTree::DetectionTree(std::span<const std::vector<DetectionCylinder>> cylinders_by_solid) {
  roots_.reserve(cylinders_by_solid.size());
  std::vector<std::uint32_t> items;
  for (const std::vector<DetectionCylinder>& cylinders : cylinders_by_solid) {
    items.clear();
    for (const DetectionCylinder& c : cylinders) {
      items.push_back(std::uint32_t(cylinders_.size()));
      cylinders_.push_back(c);
    }
    roots_.push_back(std::uint32_t(nodes_.size()));
    nodes_.emplace_back();
    build(roots_.back(), items, 0);
  }
}

void DetectionTree::build(std::uint32_t node, std::vector<std::uint32_t>& items, int depth) {
  Vec3f low(INFINITY);
  Vec3f high(-INFINITY);
  for (const std::uint32_t i : items) {
    const Bounds b = bounds_of(cylinders_[i]);
    low = min(low, b.low);
    high = max(high, b.high);
  }
  const Vec3f extent = high - low;
  const int axis =
      extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  std::vector<std::uint32_t> left, right;
  const float split =
      (low[axis] + high[axis]) * 0.5F;  // the paper's middle cut along the longest axis
  if (items.size() > kLeafSize && depth < kMaxDepth) {
    for (const std::uint32_t i : items) {
      const Bounds b = bounds_of(cylinders_[i]);
      if (b.low[axis] <= split) left.push_back(i);
      if (b.high[axis] >= split) right.push_back(i);
    }
  }
  if (left.size() + right.size() == 0 || left.size() == items.size() ||
      right.size() == items.size()) {
    nodes_[node] = {0, 3, std::uint32_t(entries_.size()), std::uint32_t(items.size())};
    entries_.insert(entries_.end(), items.begin(), items.end());
    return;
  }
  const auto first = std::uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {split, std::uint32_t(axis), first, 0};
  build(first, left, depth + 1);
  build(first + 1, right, depth + 1);
}

std::size_t DetectionTree::find(std::uint32_t solid, Vec3f point, float slack,
                                std::span<std::uint32_t> found) const {
  std::uint32_t node = roots_[solid];
  while (nodes_[node].axis_or_leaf < 3) {
    const TreeNode& n = nodes_[node];
    node = n.first + (point[int(n.axis_or_leaf)] > n.split ? 1U : 0U);
  }
  std::size_t count = 0;
  const TreeNode& leaf = nodes_[node];
  for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count && count < found.size(); ++i) {
    const DetectionCylinder& c = cylinders_[entries_[i]];
    if (contains(c, point, slack)) found[count++] = c.arc;
  }
  return count;
}

std::size_t DetectionTree::bytes() const {
  return nodes_.size() * sizeof(TreeNode) +
         (roots_.size() + entries_.size()) * sizeof(std::uint32_t) +
         cylinders_.size() * sizeof(DetectionCylinder);
}

}  // namespace arris
