#include "random_solids.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

namespace arris::bench {
namespace {

constexpr int kSide = 20;

void add_pair(CsgTree& tree, CsgLeaf first, CsgLeaf bite) {
  const auto pair = std::uint32_t(tree.nodes.size());
  const auto leaf = std::uint32_t(tree.leaves.size());
  tree.nodes[0].children.push_back(pair);
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::subtract, {pair + 1, pair + 2}});
  tree.nodes.push_back({leaf, CsgOperation::unite, {}});
  tree.nodes.push_back({leaf + 1, CsgOperation::unite, {}});
  tree.leaves.push_back(std::move(first));
  tree.leaves.push_back(std::move(bite));
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

CsgTree union_of(std::vector<CsgLeaf> leaves, CsgOperation operation) {
  CsgTree tree;
  tree.name = "bench";
  tree.nodes.push_back({CsgNode::kInner, operation, {}});
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    tree.nodes[0].children.push_back(i + 1);
    tree.nodes.push_back({i, CsgOperation::unite, {}});
  }
  tree.leaves = std::move(leaves);
  return tree;
}

CsgTree make_heap(int primitives, double least) {
  Random random(1);
  CsgTree tree;
  tree.name = fmt::format("{} primitives", primitives);
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  const double largest = 0.35 / std::cbrt(double(primitives));
  for (int i = 0; i < primitives; i += 2) {
    const Vec3d at{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
    const double size = largest * (least < 1 ? uniform(random, least, 1) : 1);
    CsgPrimitive first = CsgSphere{size};
    if (i % 3 == 1) first = CsgBox{Vec3d(-0.8 * size), Vec3d(0.8 * size)};
    if (i % 3 == 2) first = CsgCone{-size, size, 0.7 * size, 0.7 * size};
    add_pair(tree, {first, {{}, at}, {}},
             {CsgSphere{0.7 * size}, {{}, at + Vec3d(0.6 * size)}, {}});
  }
  return tree;
}

CsgTree make_plate(PlateForm form) {
  std::vector<CsgLeaf> leaves;
  CsgTree tiles;
  tiles.name = "tiles";
  tiles.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  leaves.push_back({CsgBox{{0, 0, 0}, {1, 1, 0.1}}, {}, {}});
  for (int i = 0; i < kSide * kSide; ++i) {
    const double step = 1.0 / kSide;
    const Vec3d low{(i % kSide) * step, (i / kSide) * step, 0};
    const CsgLeaf hole{
        CsgCone{-1, 1, 0.3 * step, 0.3 * step}, {{}, low + Vec3d(step / 2, step / 2, 0)}, {}};
    leaves.push_back(hole);
    add_pair(tiles, {CsgBox{low, low + Vec3d(step, step, 0.1)}, {}, {}}, hole);
  }
  return form == PlateForm::one_difference ? union_of(std::move(leaves), CsgOperation::subtract)
                                           : tiles;
}

}  // namespace arris::bench
