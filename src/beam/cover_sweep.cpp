#include "beam/cover_sweep.h"

#include <cstddef>

namespace arris {

CoverSweep::CoverSweep(const CsgExpression& expression)
    : nodes_(expression.steps().size()), at_(expression.leaves().size()) {
  std::vector<std::uint32_t> stack;
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const CsgStep& step = expression.steps()[i];
    Node& node = nodes_[i];
    node.kind = step.kind;
    if (step.kind == CsgStep::Kind::leaf || step.kind == CsgStep::Kind::complement) {
      at_[step.value].push_back(i);
      node.value = step.kind == CsgStep::Kind::leaf ? Cover::out : Cover::in;
    } else {
      for (std::size_t k = stack.size() - step.value; k < stack.size(); ++k) {
        nodes_[stack[k]].parent = i;
        ++node.counts[std::size_t(nodes_[stack[k]].value)];
      }
      stack.resize(stack.size() - step.value);
      node.value = value_of(node);
    }
    stack.push_back(i);
  }
}

Cover CoverSweep::value_of(const Node& node) {
  const auto [out, in, on] = node.counts;
  switch (node.kind) {
    case CsgStep::Kind::unite:
      return in > 0 ? Cover::in : on > 0 ? Cover::on : Cover::out;
    case CsgStep::Kind::intersect:
      return out > 0 ? Cover::out : on > 0 ? Cover::on : Cover::in;
    default:  // parities
      if (on > 0) return Cover::on;
      return (in % 2 == 1) == (node.kind == CsgStep::Kind::odd) ? Cover::in : Cover::out;
  }
}

void CoverSweep::set(std::uint32_t slot, Cover cover) {
  for (const std::uint32_t i : at_[slot]) {
    climb(i, nodes_[i].kind == CsgStep::Kind::leaf ? cover : !cover);
  }
}

void CoverSweep::climb(std::uint32_t node, Cover value) {
  while (nodes_[node].value != value) {
    const Cover before = nodes_[node].value;
    nodes_[node].value = value;
    const std::uint32_t parent = nodes_[node].parent;
    if (parent == kRoot) return;
    --nodes_[parent].counts[std::size_t(before)];
    ++nodes_[parent].counts[std::size_t(value)];
    value = value_of(nodes_[parent]);
    node = parent;
  }
}

}  // namespace arris
