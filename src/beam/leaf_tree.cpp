#include "beam/leaf_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kManyOperands = 32;

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
  std::vector<std::uint32_t> bounded;
  for (std::uint32_t i = 0; i < operands_.size(); ++i) {
    boxes_.push_back(reach_of(operands_[i], boxes));
    const bool is_finite_box = is_finite(boxes_[i].low) && is_finite(boxes_[i].high);
    (is_finite_box ? bounded : endless_).push_back(i);
  }
  tree_ = PlaceTree(std::move(bounded), boxes_, 0);
}

CsgExpression LeafTree::near(const std::function<bool(const Box3d&)>& meets) const {
  if (operands_.empty()) return whole_;
  std::vector<std::uint32_t> kept = endless_;
  tree_.visit(meets, [&](std::uint32_t i) {
    if (meets(boxes_[i])) kept.push_back(i);
    return true;
  });
  std::ranges::sort(kept);
  std::vector<const CsgExpression*> operands;
  for (const std::uint32_t i : kept) operands.push_back(&operands_[i]);
  return CsgExpression::unite(operands);
}

}  // namespace arris
