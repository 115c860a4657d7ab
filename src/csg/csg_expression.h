// csg_expression.h — which points belong to a solid, as a formula over its leaves
// What       unions and intersections of leaves and of their complements, in postfix: differences are intersections
//            with complements, which are pushed down to the leaves. Parities are for volumes that are described by what
//            bounds them. prune() puts in what is known of some leaves.
// Guarantee  no recursion: chains of any depth. prune() keeps the formula's value for every state of the leaves left;
//            leaves on which the value no longer depends by a decided neighbour are gone.
// Cost       all linear in the steps
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "arris/csg.h"
#include "csg/cover.h"

namespace arris {

struct CsgStep {
  // odd and even: of how many of the operands hold
  enum class Kind : std::uint32_t { leaf, complement, unite, intersect, odd, even };
  Kind kind = Kind::leaf;
  std::uint32_t value =
      0;  // leaf and complement: which, an index of leaves(); others: how many operands
};

class CsgExpression {
 public:
  // Empty set.
  CsgExpression() = default;
  // Decided: everything or nothing. Precondition: not on.
  explicit CsgExpression(Cover decided) : decided_(decided) {}
  // Of the tree's root. `exists`, by leaf: leaves without points are left out. Throws Error{input} for nodes or leaves
  // that aren't there, children above their parent, and trees that branch into more than kMaxSteps.
  CsgExpression(const CsgTree& tree, const std::vector<bool>& exists);

  [[nodiscard]] bool is_decided() const { return steps_.empty(); }
  // on: it depends.
  [[nodiscard]] Cover value() const { return is_decided() ? decided_ : Cover::on; }
  // Of the tree, ascending, each once.
  [[nodiscard]] const std::vector<std::uint32_t>& leaves() const { return leaves_; }
  [[nodiscard]] const std::vector<CsgStep>& steps() const { return steps_; }
  [[nodiscard]] std::uint32_t depth() const;  // of operations in one another

  // With each leaf that is among `volumes` replaced by the parity of others: inside are points in an odd number of
  // them.
  [[nodiscard]] CsgExpression with_parities(
      const std::map<std::uint32_t, std::vector<std::uint32_t>>& volumes) const;
  // Precondition: not decided.
  [[nodiscard]] CsgExpression intersected_with(std::uint32_t leaf) const;
  // Those of the outermost union; the expression itself if it is none; decided: nothing.
  [[nodiscard]] std::vector<CsgExpression> union_operands() const;
  // Precondition: none is decided.
  static CsgExpression unite(std::span<const CsgExpression* const> operands);
  // `covers` by index of leaves().
  [[nodiscard]] CsgExpression prune(std::span<const Cover> covers) const;
  // `boxes` by index of leaves(). Contains the solid; infinite where a complement alone bounds it.
  [[nodiscard]] Box3d bounds(std::span<const Box3d> boxes) const;
  // is_in by index of leaves().
  template <class IsIn>
  [[nodiscard]] bool eval(const IsIn& is_in) const {
    if (is_decided()) return decided_ == Cover::in;
    return eval_steps(steps_, is_in);
  }
  template <class IsIn>
  static bool eval_steps(std::span<const CsgStep> steps, const IsIn& is_in);

 private:
  void number_leaves();

  std::vector<std::uint32_t> leaves_;
  std::vector<CsgStep> steps_;
  Cover decided_ = Cover::out;
};

inline constexpr std::size_t kMaxSteps = 50'000'000;

template <class IsIn>
bool CsgExpression::eval_steps(std::span<const CsgStep> steps, const IsIn& is_in) {
  thread_local std::vector<std::uint8_t> stack;
  stack.clear();
  for (const CsgStep& step : steps) {
    if (step.kind == CsgStep::Kind::leaf || step.kind == CsgStep::Kind::complement) {
      stack.push_back(is_in(step.value) == (step.kind == CsgStep::Kind::leaf) ? 1 : 0);
      continue;
    }
    const std::size_t first = stack.size() - step.value;
    std::uint8_t all = 1, any = 0, odd = 0;
    for (std::size_t i = first; i < stack.size(); ++i) {
      all = std::uint8_t(all & stack[i]);
      any = std::uint8_t(any | stack[i]);
      odd = std::uint8_t(odd ^ stack[i]);
    }
    stack.resize(first);
    switch (step.kind) {
      case CsgStep::Kind::unite:
        stack.push_back(any);
        break;
      case CsgStep::Kind::odd:
        stack.push_back(odd);
        break;
      case CsgStep::Kind::even:
        stack.push_back(odd ^ 1U);
        break;
      default:
        stack.push_back(all);
    }
  }
  return stack.back() != 0;
}

}  // namespace arris
