#include "csg/csg_expression.h"

#include <algorithm>
#include <limits>
#include <string>

#include "arris/error.h"

namespace arris {
namespace {

using Kind = CsgStep::Kind;

[[noreturn]] void fail(const CsgTree& tree, const std::string& what) {
  throw Error(Error::Kind::input, "CSG solid \"" + tree.name + "\"", what);
}

bool is_of_leaf(const CsgStep& step) {
  return step.kind == Kind::leaf || step.kind == Kind::complement;
}

// A node on the way down.
struct Visit {
  std::uint32_t node = 0;
  bool complement = false;
  std::size_t next_child = 0;
  std::uint32_t operands = 0;  // that its step will have
};

// The operation that a node is once its complement is pushed below it.
Kind kind_of(const CsgNode& node, bool complement) {
  return (node.operation == CsgOperation::unite) != complement ? Kind::unite : Kind::intersect;
}

class Flattener {
 public:
  Flattener(const CsgTree& tree, const std::vector<bool>& exists) : tree_(tree), exists_(exists) {}

  std::vector<CsgStep> flatten() {
    if (!tree_.nodes.empty()) enter(0, false);
    while (!visits_.empty()) {
      Visit& visit = visits_.back();
      const CsgNode& node = tree_.nodes[visit.node];
      if (visit.next_child == node.children.size()) {
        leave();
        continue;
      }
      const std::size_t i = visit.next_child++;
      const std::uint32_t child = node.children[i];
      if (child <= visit.node) {
        fail(tree_, "node " + std::to_string(visit.node) + " has node " + std::to_string(child) +
                        " as its child; children must have greater numbers");
      }
      enter(child, visit.complement != (node.operation == CsgOperation::subtract && i > 0));
    }
    return std::move(steps_);
  }

 private:
  void enter(std::uint32_t index, bool complement) {
    if (index >= tree_.nodes.size()) {
      fail(tree_, "refers to node " + std::to_string(index) + ", but there are " +
                      std::to_string(tree_.nodes.size()));
    }
    if (steps_.size() > kMaxSteps) {
      fail(tree_, "has more than " + std::to_string(kMaxSteps) +
                      " uses of its parts; share fewer nodes between parents");
    }
    const CsgNode& node = tree_.nodes[index];
    if (node.leaf == CsgNode::kInner && !node.children.empty()) {
      visits_.push_back({index, complement, 0, 0});
      return;
    }
    if (node.leaf != CsgNode::kInner && node.leaf >= tree_.leaves.size()) {
      fail(tree_, "node " + std::to_string(index) + " is leaf " + std::to_string(node.leaf) +
                      ", but there are " + std::to_string(tree_.leaves.size()));
    }
    const bool empty = node.leaf == CsgNode::kInner || !exists_[node.leaf];
    // The empty set is a union of nothing, all of space an intersection of nothing.
    if (empty) {
      emit({complement ? Kind::intersect : Kind::unite, 0});
    } else {
      emit({complement ? Kind::complement : Kind::leaf, node.leaf});
    }
  }
  void emit(CsgStep step) {
    steps_.push_back(step);
    if (!visits_.empty()) ++visits_.back().operands;
  }
  // A union in a union, or an intersection in an intersection, hands its operands to its parent.
  void leave() {
    const Visit done = visits_.back();
    visits_.pop_back();
    const Kind kind = kind_of(tree_.nodes[done.node], done.complement);
    if (!visits_.empty() &&
        kind == kind_of(tree_.nodes[visits_.back().node], visits_.back().complement)) {
      visits_.back().operands += done.operands;
    } else if (done.operands != 1) {
      emit({kind, done.operands});
    } else if (!visits_.empty()) {
      ++visits_.back().operands;
    }
  }

  const CsgTree& tree_;
  const std::vector<bool>& exists_;
  std::vector<Visit> visits_;
  std::vector<CsgStep> steps_;
};

// Postfix operands while steps are put in: their value, and where their own steps begin in the output.
struct Operand {
  Cover value = Cover::out;
  std::size_t first = 0;
};

// Of the operands from `base` on. Those that are known are nowhere in the steps; returns the value.
Cover join_parity(CsgStep::Kind kind, std::span<const Operand> operands,
                  std::vector<CsgStep>& out) {
  bool odd = kind == Kind::odd;
  std::uint32_t left = 0;
  for (const Operand& operand : operands) {
    odd ^= operand.value == Cover::in;
    left += operand.value == Cover::on ? 1 : 0;
  }
  if (left == 0) return odd ? Cover::out : Cover::in;
  if (left > 1) {
    out.push_back({odd ? Kind::odd : Kind::even, left});
  } else if (!odd) {
    // One operand, turned round: operands of parities are leaves.
    CsgStep& only = out.back();
    only.kind = only.kind == Kind::leaf ? Kind::complement : Kind::leaf;
  }
  return Cover::on;
}

// Puts in what is known; returns the value, and leaves the steps of what is not.
template <class CoverOf>
Cover simplify(std::span<const CsgStep> steps, const CoverOf& cover_of, std::vector<CsgStep>& out) {
  std::vector<Operand> stack;
  for (const CsgStep& step : steps) {
    if (is_of_leaf(step)) {
      const Cover cover = step.kind == Kind::leaf ? cover_of(step.value) : !cover_of(step.value);
      stack.push_back({cover, out.size()});
      if (cover == Cover::on) out.push_back(step);
      continue;
    }
    const std::size_t base = stack.size() - step.value;
    const bool is_union = step.kind == Kind::unite;
    const std::size_t first = step.value > 0 ? stack[base].first : out.size();
    if (step.kind == Kind::odd || step.kind == Kind::even) {
      const Cover parity = join_parity(step.kind, std::span(stack).subspan(base), out);
      stack.resize(base);
      stack.push_back({parity, first});
      continue;
    }
    Cover value = is_union ? Cover::out : Cover::in;
    std::uint32_t left = 0;
    for (std::size_t i = base; i < stack.size(); ++i) {
      value = is_union ? value | stack[i].value : value & stack[i].value;
      left += stack[i].value == Cover::on ? 1 : 0;
    }
    if (value != Cover::on) {
      out.resize(first);
    } else if (left > 1) {
      out.push_back({step.kind, left});
    }
    stack.resize(base);
    stack.push_back({value, first});
  }
  return stack.empty() ? Cover::out : stack.back().value;
}

}  // namespace

CsgExpression::CsgExpression(const CsgTree& tree, const std::vector<bool>& exists) {
  const std::vector<CsgStep> flat = Flattener(tree, exists).flatten();
  decided_ = simplify(
      flat, [](std::uint32_t) { return Cover::on; }, steps_);
  number_leaves();
}

// Steps name leaves of the tree, and then indices of leaves().
void CsgExpression::number_leaves() {
  for (const CsgStep& step : steps_) {
    if (is_of_leaf(step)) leaves_.push_back(step.value);
  }
  std::ranges::sort(leaves_);
  leaves_.erase(std::unique(leaves_.begin(), leaves_.end()), leaves_.end());
  for (CsgStep& step : steps_) {
    if (!is_of_leaf(step)) continue;
    step.value = std::uint32_t(std::ranges::lower_bound(leaves_, step.value) - leaves_.begin());
  }
}

CsgExpression CsgExpression::intersected_with(std::uint32_t leaf) const {
  CsgExpression both;
  both.decided_ = decided_;
  for (CsgStep step : steps_) {
    if (is_of_leaf(step)) step.value = leaves_[step.value];
    both.steps_.push_back(step);
  }
  both.steps_.push_back({Kind::leaf, leaf});
  both.steps_.push_back({Kind::intersect, 2});
  both.number_leaves();
  return both;
}

std::vector<CsgExpression> CsgExpression::union_operands() const {
  if (is_decided()) return {};
  if (steps_.back().kind != Kind::unite) return {*this};
  // Where the steps of each operand begin: those of the last operations on the stack.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i + 1 < steps_.size(); ++i) {
    const std::size_t taken = is_of_leaf(steps_[i]) ? 0 : steps_[i].value;
    const std::size_t start = taken == 0 ? i : starts[starts.size() - taken];
    starts.resize(starts.size() - taken);
    starts.push_back(start);
  }
  std::vector<CsgExpression> operands;
  starts.push_back(steps_.size() - 1);
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    CsgExpression& operand = operands.emplace_back();
    operand.decided_ = Cover::on;
    for (std::size_t i = starts[k]; i < starts[k + 1]; ++i) {
      CsgStep step = steps_[i];
      if (is_of_leaf(step)) step.value = leaves_[step.value];
      operand.steps_.push_back(step);
    }
    operand.number_leaves();
  }
  return operands;
}

CsgExpression CsgExpression::unite(std::span<const CsgExpression* const> operands) {
  CsgExpression all;
  if (operands.empty()) return all;
  if (operands.size() == 1) return *operands[0];
  all.decided_ = Cover::on;
  for (const CsgExpression* operand : operands) {
    for (CsgStep step : operand->steps_) {
      if (is_of_leaf(step)) step.value = operand->leaves_[step.value];
      all.steps_.push_back(step);
    }
  }
  all.steps_.push_back({Kind::unite, std::uint32_t(operands.size())});
  all.number_leaves();
  return all;
}

CsgExpression CsgExpression::with_parities(
    const std::map<std::uint32_t, std::vector<std::uint32_t>>& volumes) const {
  CsgExpression replaced;
  replaced.decided_ = decided_;
  for (CsgStep step : steps_) {
    if (is_of_leaf(step)) {
      step.value = leaves_[step.value];
      const auto volume = volumes.find(step.value);
      if (volume != volumes.end()) {
        for (const std::uint32_t leaf : volume->second) {
          replaced.steps_.push_back({Kind::leaf, leaf});
        }
        step = {step.kind == Kind::leaf ? Kind::odd : Kind::even,
                std::uint32_t(volume->second.size())};
      }
    }
    replaced.steps_.push_back(step);
  }
  replaced.number_leaves();
  return replaced;
}

CsgExpression CsgExpression::prune(std::span<const Cover> covers) const {
  CsgExpression pruned;
  pruned.decided_ = decided_;
  if (is_decided()) return pruned;
  pruned.decided_ = simplify(
      steps_, [&](std::uint32_t i) { return covers[i]; }, pruned.steps_);
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> renamed(leaves_.size(), kUnused);
  for (const CsgStep& step : pruned.steps_) {
    if (is_of_leaf(step)) renamed[step.value] = 0;
  }
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (renamed[i] == kUnused) continue;
    renamed[i] = std::uint32_t(pruned.leaves_.size());
    pruned.leaves_.push_back(leaves_[i]);
  }
  for (CsgStep& step : pruned.steps_) {
    if (is_of_leaf(step)) step.value = renamed[step.value];
  }
  return pruned;
}

Box3d CsgExpression::bounds(std::span<const Box3d> boxes) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Box3d none{Vec3d(kInfinity), Vec3d(-kInfinity)}, all{Vec3d(-kInfinity), Vec3d(kInfinity)};
  if (is_decided()) return decided_ == Cover::in ? all : none;
  std::vector<Box3d> stack;
  for (const CsgStep& step : steps_) {
    if (is_of_leaf(step)) {
      stack.push_back(step.kind == Kind::leaf ? boxes[step.value] : all);
      continue;
    }
    const std::size_t base = stack.size() - step.value;
    const bool grows = step.kind == Kind::unite || step.kind == Kind::odd;
    Box3d box = grows ? none : all;
    for (std::size_t i = base; i < stack.size(); ++i) {
      if (step.kind == Kind::even) break;
      box = grows ? hull(box, stack[i]) : intersection(box, stack[i]);
    }
    // Infinities of an empty box would grow a later union.
    if (box.is_empty()) box = none;
    stack.resize(base);
    stack.push_back(box);
  }
  return stack.back();
}

std::uint32_t CsgExpression::depth() const {
  std::vector<std::uint32_t> stack;
  for (const CsgStep& step : steps_) {
    if (is_of_leaf(step)) {
      stack.push_back(0);
      continue;
    }
    std::uint32_t deepest = 0;
    for (std::size_t i = stack.size() - step.value; i < stack.size(); ++i) {
      deepest = std::max(deepest, stack[i]);
    }
    stack.resize(stack.size() - step.value);
    stack.push_back(deepest + 1);
  }
  return stack.empty() ? 0 : stack.back();
}

}  // namespace arris
