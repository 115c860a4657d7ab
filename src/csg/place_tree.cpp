#include "csg/place_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace arris {
namespace {

constexpr std::uint32_t kFewItems = 4;  // at an end of the tree

Vec3d middle_of(const Box3d& box) {
  return box.low * 0.5 + box.high * 0.5;
}

}  // namespace

PlaceTree::PlaceTree(std::vector<std::uint32_t> items, std::span<const Box3d> boxes, double slack)
    : items_(std::move(items)) {
  nodes_.reserve(items_.size());
  if (!items_.empty()) build(0, std::uint32_t(items_.size()), boxes, slack);
}

void PlaceTree::build(std::uint32_t first, std::uint32_t count, std::span<const Box3d> boxes,
                      double slack) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::size_t index = nodes_.size();
  Box3d box = boxes[items_[first]];
  Box3d middles{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (std::uint32_t i = first; i < first + count; ++i) {
    box = hull(box, boxes[items_[i]]);
    const Vec3d m = middle_of(boxes[items_[i]]);
    middles = hull(middles, {m, m});
  }
  nodes_.push_back({{box.low - Vec3d(slack), box.high + Vec3d(slack)}, first, count, 0});
  if (count <= kFewItems) return;
  const Vec3d extent = middles.high - middles.low;
  const int axis =
      extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  const auto begin = items_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double x = middle_of(boxes[a])[axis], y = middle_of(boxes[b])[axis];
    return x != y ? x < y : a < b;
  });
  nodes_[index].count = 0;
  build(first, half, boxes, slack);
  nodes_[index].second_child = std::uint32_t(nodes_.size());
  build(first + half, count - half, boxes, slack);
}

}  // namespace arris
