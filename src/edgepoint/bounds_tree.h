// bounds_tree.h — the tree that edge and face trees are made of
// What       orders records and bounds ranges of them by nodes in depth-first order: node i's children are i + 1 and
//            the one after that one's subtree, and i + size skips both. A node may hold records of its own.
// Guarantee  same nodes and order with any number of threads
// Cost       n log n, each split of 16,384 records or more on two threads
// Source     Bala, Walter, Greenberg 2003, section 6.4: top-down, split on one axis where the children are smallest.
//            Size counts by the records a child has; places to split at lie in 16 equal parts, on the two axes that
//            spread records most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edgepoint/face_bounds.h"

namespace arris {

struct BoundsRecord {
  FaceBounds bounds;
  std::uint32_t item;
};

struct alignas(64) BoundsNode {        // a cache line
  FaceBounds bounds;                   // of all below
  std::uint32_t first = 0, count = 0;  // its own records
  std::uint32_t size = 1;              // of nodes: itself and all below; 1: a leaf
};

// normals_and_positions: for sets of edges; a record whose normals span more than half of its node's stays there.
enum class SplitBy { normals_and_positions, positions };

std::vector<BoundsNode> build_bounds_tree(std::span<BoundsRecord> records, SplitBy by);

}  // namespace arris
