// region_look.h — what all rays through a part of the picture see first
// What       The certificate: spans of the leaves (leaf_span.h) give the depths in which a leaf is certainly inside or
//            outside; the tree is evaluated in three-valued logic over the depths, from the front, until it certainly
//            has changed; the leaves that are left in that window are put in order along the ray. Where an order or a
//            hit depends on a sign that changes within the rectangle, both ways are followed: the answer is a small
//            tree of polynomials, whose ends are surfaces.
// Guarantee  at every point of the rectangle that follows the tree's signs to a surface, the ray meets that surface
//            first; `nothing` likewise. What could not be decided ends in `unknown`, with all the surfaces that may
//            be seen there. (tests/beam/region_look_test.cpp)
// Limits     where two quadrics, or anything and a leaf that is not convex, may be met in either order, the end is
//            unknown: cut the rectangle
// Cost       one span for each leaf, and again for each sign that is followed both ways
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "beam/beam_view.h"
#include "beam/leaf_span.h"
#include "csg/csg_expression.h"

namespace arris {

// What of a solid is undecided in some beam.
struct BeamPart {
  std::uint32_t solid = 0;
  CsgExpression expression;
};

// What a ray meets: a face of a leaf (csg_leaf.h), from outside the solid or from inside.
struct SeenSurface {
  std::uint32_t solid = 0, leaf = 0, face = 0;
  BeamSurface surface;
  bool entering = true;

  friend bool operator==(const SeenSurface&, const SeenSurface&) = default;
};

struct LookNode {
  enum class Kind : std::uint8_t { nothing, surface, unknown, sign };
  Kind kind = Kind::nothing;
  SeenSurface seen;                          // surface
  Quadratic polynomial;                      // sign
  std::uint32_t negative = 0, positive = 0;  // sign: the nodes for either
  std::uint32_t first = 0, count = 0;        // unknown: of LookTree::candidates
  bool is_noise = false;                     // unknown: a matter of rounding
  std::uint32_t lit = 0;                     // surface: which lights reach it, see beam_shadow.h
  std::uint32_t lit_known = 0;
  bool light_open = false;  // surface: one of the lights that were looked from may reach it or not
  std::uint32_t mirrors = 0;  // surface or nothing: in which it is seen, see beam_mirror.h; 0: none
  bool mirror_open = false;   // surface: a mirror in which something unknown is seen
};

struct LookTree {
  std::vector<LookNode> nodes;  // [root] first in the end: node 0 is the root
  std::vector<SeenSurface> candidates;
  bool complete = true;   // nothing is unknown
  bool refines = false;   // a smaller rectangle knows its signs better
  bool hopeless = false;  // all that is unknown is a matter of rounding, in smaller rectangles, too
  double depth_end = std::numeric_limits<double>::infinity();  // no ray sees farther
};

struct LookOptions {
  // Set: only whether the rays meet this plane before any surface of `parts`. What they meet before it counts as one
  // surface, which is no plane, so that its order does not matter. Precondition: every ray meets the plane.
  std::optional<LitPlane> only;
  std::uint32_t most_signs = 4;  // followed both ways, one below the other
  // That are put in order along the ray. Of more, all is unknown; of many more, without candidates.
  std::uint32_t most_leaves = 8;
};

// `by` in the place of a node, with make_end(end) for each of its ends. Its `unknown` ends lose their candidates.
template <class MakeEnd>
void replace_node(LookTree& tree, std::uint32_t at, const LookTree& by, const MakeEnd& make_end) {
  const auto base = std::uint32_t(tree.nodes.size()) - 1;
  const auto place = [&](std::uint32_t i) { return i == 0 ? at : base + i; };
  tree.nodes.resize(tree.nodes.size() + by.nodes.size() - 1);
  for (std::uint32_t i = 0; i < by.nodes.size(); ++i) {
    LookNode node = by.nodes[i];
    if (node.kind == LookNode::Kind::sign) {
      node.negative = place(node.negative);
      node.positive = place(node.positive);
    } else {
      node = make_end(node);
    }
    tree.nodes[place(i)] = node;
  }
}

// What a beam may meet.
struct BeamList {
  std::vector<BeamPart> parts;  // undecided
  std::vector<LeafSpan> spans;  // of the leaves of all parts in turn
};

// `parts` as the beam meets them before depth_end.
BeamList prune_parts(const BeamView& view, const std::vector<BeamPart>& parts, const Rect& rect,
                     double depth_end);

// Precondition: the list is that of the rectangle and depth_end.
LookTree look(const BeamView& view, const BeamList& list, const Rect& rect, double depth_end,
              const LookOptions& options = {});

}  // namespace arris
