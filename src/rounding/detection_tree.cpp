#include "rounding/detection_tree.h"

#include <cmath>

namespace arris {
namespace {

constexpr std::size_t kLeafSize = 6;
constexpr int kMaxDepth = 24;

}  // namespace

DetectionTree::DetectionTree(std::span<const std::vector<DetectionEntry>> entries_by_solid) {
  roots_.reserve(entries_by_solid.size());
  for (const std::vector<DetectionEntry>& entries : entries_by_solid) {
    roots_.push_back(std::uint32_t(nodes_.size()));
    nodes_.emplace_back();
    build(roots_.back(), entries, 0);
  }
}

void DetectionTree::build(std::uint32_t node, std::span<const DetectionEntry> items, int depth) {
  Vec3f low(INFINITY);
  Vec3f high(-INFINITY);
  for (const DetectionEntry& entry : items) {
    low = min(low, entry.low);
    high = max(high, entry.high);
  }
  const Vec3f extent = high - low;
  const int longest =
      extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
  const float split = (low[longest] + high[longest]) * 0.5F;
  std::vector<DetectionEntry> left, right;
  if (items.size() > kLeafSize && depth < kMaxDepth) {
    for (const DetectionEntry& entry : items) {
      if (entry.low[longest] <= split) left.push_back(entry);
      if (entry.high[longest] >= split) right.push_back(entry);
    }
  }
  const bool is_leaf = left.empty() || left.size() == items.size() || right.size() == items.size();
  if (is_leaf) {
    nodes_[node] = {0, 3, std::uint32_t(entries_.size()), std::uint32_t(items.size())};
    entries_.insert(entries_.end(), items.begin(), items.end());
    return;
  }
  const auto first = std::uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {split, std::uint32_t(longest), first, 0};
  build(first, left, depth + 1);
  build(first + 1, right, depth + 1);
}

std::span<const DetectionEntry> DetectionTree::find(std::uint32_t solid, Vec3f point) const {
  const TreeNode* node = &nodes_[roots_[solid]];
  while (node->axis_or_leaf < 3) {
    node = &nodes_[node->first + (point[int(node->axis_or_leaf)] > node->split ? 1U : 0U)];
  }
  return std::span(entries_).subspan(node->first, node->count);
}

std::size_t DetectionTree::bytes() const {
  return nodes_.size() * sizeof(TreeNode) + roots_.size() * sizeof(std::uint32_t) +
         entries_.size() * sizeof(DetectionEntry);
}

}  // namespace arris
