#include "beam/leaf_tree.h"

#include <algorithm>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kManyOperands = 32;
constexpr std::uint32_t kFewOperands = 4;  // at an end of the tree

Vec3d middle_of(const Box3d& box) {
  return box.low * 0.5 + box.high * 0.5;
}

// Holds everything that the operand does: where no box of a leaf is, it has the value that it has far away.
Box3d reach_of(const CsgExpression& operand, const std::vector<Box3d>& boxes) {
  Box3d all{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const std::uint32_t leaf : operand.leaves()) all = hull(all, boxes[leaf]);
  const bool is_out_far_away = !operand.eval([](std::uint32_t) { return false; });
  return is_out_far_away ? all : Box3d{Vec3d(-kInfinity), Vec3d(kInfinity)};
}

}  // namespace

LeafTree::LeafTree(const CsgExpression& whole, const std::vector<Box3d>& boxes) {
  operands_ = whole.union_operands();
  if (operands_.size() < kManyOperands) {
    operands_.clear();
    whole_ = whole;
    return;
  }
  for (std::uint32_t i = 0; i < operands_.size(); ++i) {
    boxes_.push_back(reach_of(operands_[i], boxes));
    const bool is_finite_box = is_finite(boxes_[i].low) && is_finite(boxes_[i].high);
    (is_finite_box ? order_ : endless_).push_back(i);
  }
  if (!order_.empty()) build(0, std::uint32_t(order_.size()));
}

void LeafTree::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t index = nodes_.size();
  Box3d box = boxes_[order_[first]];
  Box3d middles{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (std::uint32_t i = first; i < first + count; ++i) {
    box = hull(box, boxes_[order_[i]]);
    const Vec3d m = middle_of(boxes_[order_[i]]);
    middles = hull(middles, {m, m});
  }
  nodes_.push_back({box, first, count, 0});
  if (count <= kFewOperands) return;
  const Vec3d extent = middles.high - middles.low;
  const int axis =
      extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double x = middle_of(boxes_[a])[axis], y = middle_of(boxes_[b])[axis];
    return x != y ? x < y : a < b;
  });
  nodes_[index].count = 0;
  build(first, half);
  nodes_[index].second_child = std::uint32_t(nodes_.size());
  build(first + half, count - half);
}

CsgExpression LeafTree::near(const std::function<bool(const Box3d&)>& meets) const {
  if (operands_.empty()) return whole_;
  std::vector<std::uint32_t> kept = endless_;
  std::vector<std::uint32_t> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const std::uint32_t at = stack.back();
    stack.pop_back();
    const Node& node = nodes_[at];
    if (!meets(node.box)) continue;
    if (node.count == 0) {
      stack.push_back(node.second_child);
      stack.push_back(at + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (meets(boxes_[order_[i]])) kept.push_back(order_[i]);
    }
  }
  std::ranges::sort(kept);
  std::vector<const CsgExpression*> operands;
  for (const std::uint32_t i : kept) operands.push_back(&operands_[i]);
  return CsgExpression::unite(operands);
}

}  // namespace arris
