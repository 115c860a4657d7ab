// csg_solid.h — a tree of solids prepared for evaluation
// What       leaves placed, coincident surfaces made one, the tree flattened to an expression. Renderers ask for the
//            boundaries along a ray, or for what of the tree is undecided in a piece of space:
//                pruned = solid.prune(expression, cell);
//            and hand the pruned expression to the parts of that piece. Leaves of which one and the same surface is
//            left in the cell count as one there: A - A is out also where A's face passes through.
// Frames     the tree's own space
// Guarantee  in and out of covers_of() are certain. A boundary's t, leaf and face don't depend on what else is in the
//            expression, as long as that says the same near it (tests/csg/cells_test.cpp: to the last bit)
// Errors     Error{input} naming the tree, for trees that refer to what isn't there (csg_expression.h)
// Source     S. D. Roth, "Ray Casting for Modeling Solids", 1982; three-valued evaluation and pruning: J. M. Snyder,
//            "Interval Analysis for Computer Graphics", 1992
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "csg/csg_expression.h"
#include "csg/csg_leaf.h"
#include "csg/leaf_crossings.h"

namespace arris {

// Where a ray enters or leaves the solid.
struct CsgBoundary {
  double t = 0;
  std::uint32_t leaf =
      0;  // whose surface it is; of coincident ones, that which decides, in the order of leaves
  std::uint32_t face = 0;  // of the leaf, see csg_leaf.h
  bool entering = true;
};

class CsgSolid {
 public:
  explicit CsgSolid(const CsgTree& tree);
  // Of the tree's nodes, with leaves that are placed already; nothing: without points. Errors: as above.
  CsgSolid(const CsgTree& nodes, std::vector<std::optional<PlacedLeaf>> leaves,
           SurfaceTable surfaces);

  [[nodiscard]] const CsgExpression& root() const { return root_; }
  // By number in the tree; those without points have empty bounds and are in no expression.
  [[nodiscard]] const PlacedLeaf& leaf(std::uint32_t index) const { return leaves_[index]; }
  [[nodiscard]] std::size_t leaf_count() const { return leaves_.size(); }
  [[nodiscard]] const SurfaceTable& surfaces() const { return surfaces_; }
  // Contains the solid; infinite if nothing bounds it.
  [[nodiscard]] const Box3d& bounds() const { return bounds_; }
  [[nodiscard]] bool is_bounded() const;

  [[nodiscard]] Cover cover_of(std::uint32_t leaf, const SpaceCell& cell) const {
    return arris::cover_of(leaves_[leaf], surfaces_, cell);
  }
  // By index of expression.leaves().
  [[nodiscard]] std::vector<Cover> covers_of(const CsgExpression& expression,
                                             const SpaceCell& cell) const;
  [[nodiscard]] CsgExpression prune(const CsgExpression& expression, const SpaceCell& cell) const;
  [[nodiscard]] std::vector<Box3d> boxes_of(const CsgExpression& expression) const;
  // On the surface either answer may come.
  [[nodiscard]] bool contains(const CsgExpression& expression, Vec3d p) const;
  // Unit, outward from the solid.
  [[nodiscard]] Vec3d outward_normal(const CsgBoundary& boundary, const Ray& ray) const;

 private:
  void set(const CsgTree& nodes, std::vector<std::optional<PlacedLeaf>> leaves);

  SurfaceTable surfaces_;
  std::vector<PlacedLeaf> leaves_;
  CsgExpression root_;
  Box3d bounds_;
};

// An expression as the boundary search reads it: of a CsgExpression, or of a cell.
struct CsgExpressionView {
  std::span<const std::uint32_t> leaves;
  std::span<const CsgStep> steps;
  std::uint64_t truth =
      0;  // bit i: the value where the leaves inside are the bits of i; of up to kTruthLeaves leaves
};
inline constexpr std::size_t kTruthLeaves = 6;
std::uint64_t truth_table(const CsgExpression& expression);
inline CsgExpressionView view_of(const CsgExpression& expression) {
  return {expression.leaves(), expression.steps(), truth_table(expression)};
}

// The boundaries of an expression along a line. Buffers for one thread.
class BoundarySearch {
 public:
  // Ascending, entering and leaving by turns, over the whole line; decided expressions have none. Valid until the next
  // call.
  const std::vector<CsgBoundary>& find(const CsgSolid& solid, const CsgExpressionView& expression,
                                       const Ray& ray);

 private:
  struct Event {
    double t;
    std::uint32_t slot, face;
  };
  LeafCrossings crossings_;
  std::vector<Event> events_;
  std::vector<std::uint8_t> inside_;
  std::vector<CsgBoundary> found_;
};

}  // namespace arris
