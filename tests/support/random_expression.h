// random_expression.h — formulas over leaves that are nothing but numbers
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "csg/csg_expression.h"
#include "support/csg_oracle.h"

namespace arris::test {

// Leaves are shared between nodes, and some do not exist.
inline CsgExpression random_boolean_expression(CsgRandom& random, std::uint32_t leaves) {
  CsgTree tree;
  tree.name = "random";
  tree.leaves.resize(leaves);
  struct Open {
    std::uint32_t node;
    int depth;
  };
  std::vector<Open> open{{0, 3}};
  tree.nodes.emplace_back();
  while (!open.empty()) {
    const auto [index, depth] = open.back();
    open.pop_back();
    if (depth == 0 || random() % 5 == 0) {
      tree.nodes[index].leaf = std::uint32_t(random() % leaves);
      continue;
    }
    tree.nodes[index].operation = CsgOperation(random() % 3);
    for (std::uint64_t i = random() % 4; i < 4; ++i) {
      tree.nodes[index].children.push_back(std::uint32_t(tree.nodes.size()));
      open.push_back({std::uint32_t(tree.nodes.size()), depth - 1});
      tree.nodes.emplace_back();
    }
  }
  std::vector<bool> exists(leaves);
  for (std::uint32_t i = 0; i < leaves; ++i) exists[i] = random() % 8 != 0;
  return CsgExpression(tree, exists);
}

// About a third of the leaves, as parities of new ones, some of which are shared.
using Volumes = std::map<std::uint32_t, std::vector<std::uint32_t>>;
inline Volumes random_volumes(CsgRandom& random, const CsgExpression& expression) {
  Volumes volumes;
  for (const std::uint32_t leaf : expression.leaves()) {
    if (random() % 3 != 0) continue;
    std::vector<std::uint32_t>& parts = volumes[leaf];
    for (std::uint64_t k = random() % 4; k < 4; ++k) {
      parts.push_back(100 + 4 * leaf + std::uint32_t(random() % 6));
    }
  }
  return volumes;
}

inline CsgExpression random_expression(CsgRandom& random) {
  const CsgExpression plain = random_boolean_expression(random, 2 + std::uint32_t(random() % 12));
  return plain.with_parities(random_volumes(random, plain));
}

}  // namespace arris::test
