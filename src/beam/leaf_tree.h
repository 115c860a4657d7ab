// leaf_tree.h — the leaves of a shape by place, and the part of its expression that matters somewhere
// What       A tree of boxes over the leaves. Of an expression that is a union of many operands, near() keeps those
//            that have a leaf in a piece of space; of any other it keeps everything.
// Guarantee  near() has the value of the whole wherever meets() holds for every box that holds the place
//            (tests/beam/leaf_tree_test.cpp)
// Cost       about logarithmic in the operands, and linear in those that are kept
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "csg/csg_expression.h"
#include "csg/place_tree.h"

namespace arris {

class LeafTree {
 public:
  LeafTree() = default;
  // `boxes`, by number of the leaf; infinite: it matters everywhere.
  LeafTree(const CsgExpression& whole, const std::vector<Box3d>& boxes);

  [[nodiscard]] CsgExpression near(const std::function<bool(const Box3d&)>& meets) const;

 private:
  CsgExpression whole_;  // if it is no union of many
  std::vector<CsgExpression> operands_;
  std::vector<Box3d> boxes_;            // of operands
  PlaceTree tree_;                      // of operands with finite boxes
  std::vector<std::uint32_t> endless_;  // the others
};

}  // namespace arris
