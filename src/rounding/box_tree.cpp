#include "rounding/box_tree.h"

#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr std::size_t kLeafSize = 8;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes) {
  items_.reserve(boxes.size());
  if (!boxes.empty()) build(boxes);
}

bool BoxTree::reaches(const Node& node, const SlabBounds& slab) {
  const Vec3d& n = slab.normal;
  const double middle = dot(n, node.middle);
  const double half = dot(Vec3d(std::abs(n.x), std::abs(n.y), std::abs(n.z)), node.half);
  return middle + half >= slab.low && middle - half <= slab.high;
}

bool BoxTree::is_met(const Node& node, Vec3d origin, Vec3d direction, double begin, double end) {
  for (int axis = 0; axis < 3; ++axis) {
    const double half = node.half[axis] * (1 + 1e-12) + 1e-300;
    const double from = node.middle[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (std::abs(from) > half) return false;
      continue;
    }
    const double t0 = (from - half) / direction[axis], t1 = (from + half) / direction[axis];
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  return begin <= end;
}

void BoxTree::build(std::span<Box> boxes) {
  Vec3d low(std::numeric_limits<double>::infinity());
  Vec3d high = -low;
  for (const Box& box : boxes) {
    low = min(low, box.low);
    high = max(high, box.high);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back({(low + high) * 0.5, (high - low) * 0.5});
  if (boxes.size() <= kLeafSize) {
    nodes_[index].first = std::uint32_t(items_.size());
    nodes_[index].count = std::uint32_t(boxes.size());
    for (const Box& box : boxes) items_.push_back(box.item);
  } else {
    const Vec3d e = high - low;
    const int axis = e.x >= e.y ? (e.x >= e.z ? 0 : 2) : (e.y >= e.z ? 1 : 2);
    const std::size_t half = boxes.size() / 2;
    std::ranges::nth_element(boxes, boxes.begin() + std::ptrdiff_t(half), {},
                             [&](const Box& box) { return box.low[axis] + box.high[axis]; });
    build(boxes.first(half));
    build(boxes.subspan(half));
  }
  nodes_[index].next = std::uint32_t(nodes_.size());
}

}  // namespace arris
