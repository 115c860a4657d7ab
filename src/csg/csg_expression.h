// csg_expression.h — which points belong to a solid, as a formula over its leaves
// What       unions and intersections of leaves and of their complements, in postfix: differences are intersections
//            with complements, which are pushed down to the leaves. prune() puts in what is known of some leaves.
// Guarantee  no recursion: chains of any depth. prune() keeps the formula's value for every state of the leaves left;
//            leaves on which the value no longer depends by a decided neighbour are gone.
// Cost       all linear in the steps
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/csg.h"
#include "csg/cover.h"

namespace arris {

struct CsgStep {
  enum class Kind : std::uint32_t { leaf, complement, unite, intersect };
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
    std::uint8_t all = 1, any = 0;
    for (std::size_t i = first; i < stack.size(); ++i) {
      all = std::uint8_t(all & stack[i]);
      any = std::uint8_t(any | stack[i]);
    }
    stack.resize(first);
    stack.push_back(step.kind == CsgStep::Kind::unite ? any : all);
  }
  return stack.back() != 0;
}

}  // namespace arris
