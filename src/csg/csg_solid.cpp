#include "csg/csg_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace arris {

namespace {

std::vector<std::optional<PlacedLeaf>> place_leaves(const CsgTree& tree, SurfaceTable& surfaces) {
  std::vector<std::optional<PlacedLeaf>> placed;
  placed.reserve(tree.leaves.size());
  for (const CsgLeaf& leaf : tree.leaves) placed.push_back(place_leaf(leaf, surfaces));
  return placed;
}

}  // namespace

CsgSolid::CsgSolid(const CsgTree& tree) {
  set(tree, place_leaves(tree, surfaces_));
}

CsgSolid::CsgSolid(const CsgTree& nodes, std::vector<std::optional<PlacedLeaf>> leaves,
                   SurfaceTable surfaces)
    : surfaces_(std::move(surfaces)) {
  set(nodes, std::move(leaves));
}

void CsgSolid::set(const CsgTree& nodes, std::vector<std::optional<PlacedLeaf>> leaves) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<bool> exists;
  leaves_.reserve(leaves.size());
  for (std::optional<PlacedLeaf>& leaf : leaves) {
    exists.push_back(leaf.has_value());
    leaves_.push_back(leaf ? std::move(*leaf)
                           : PlacedLeaf{{}, {Vec3d(kInfinity), Vec3d(-kInfinity)}, {}});
  }
  root_ = CsgExpression(nodes, exists);
  bounds_ = root_.bounds(boxes_of(root_));
}

bool CsgSolid::is_bounded() const {
  return bounds_.is_empty() || (is_finite(bounds_.low) && is_finite(bounds_.high));
}

std::vector<Cover> CsgSolid::covers_of(const CsgExpression& expression,
                                       const SpaceCell& cell) const {
  std::vector<Cover> covers;
  covers.reserve(expression.leaves().size());
  const Box3d box = box_of(cell);
  for (const std::uint32_t leaf : expression.leaves()) {
    // Most leaves are elsewhere, which plain comparisons tell.
    const bool apart = intersection(leaves_[leaf].bounds, box).is_empty();
    covers.push_back(apart ? Cover::out : cover_of(leaf, cell));
  }
  return covers;
}

namespace {

// The value of an expression whose leaves are each on one side of a surface, where leaves may share one; on if it
// depends. Slots: the surfaces by number, in ascending order of first use.
Cover value_over_surfaces(const CsgExpression& expression,
                          const std::vector<std::optional<SoleSurface>>& sole) {
  std::vector<SoleSurface> surfaces;
  std::vector<std::uint32_t> bit;
  for (std::uint32_t slot = 0; slot < sole.size(); ++slot) {
    std::uint32_t i = 0;
    while (i < surfaces.size() && !(sole[slot] && surfaces[i].kind == sole[slot]->kind &&
                                    surfaces[i].index == sole[slot]->index)) {
      ++i;
    }
    // Leaves with more than one surface get a number that no other has.
    if (i == surfaces.size())
      surfaces.push_back(sole[slot].value_or(SoleSurface{SoleSurface::Kind::other, slot, false}));
    bit.push_back(i);
  }
  if (surfaces.size() == sole.size()) return Cover::on;
  bool any_in = false, any_out = false;
  for (std::uint64_t state = 0; state < (std::uint64_t{1} << surfaces.size()); ++state) {
    const bool in = expression.eval([&](std::uint32_t slot) {
      return (((state >> bit[slot]) & 1) != 0) != (sole[slot] && sole[slot]->flipped);
    });
    (in ? any_in : any_out) = true;
  }
  return any_in && any_out ? Cover::on : any_in ? Cover::in : Cover::out;
}

}  // namespace

CsgExpression CsgSolid::prune(const CsgExpression& expression, const SpaceCell& cell) const {
  CsgExpression pruned = expression.prune(covers_of(expression, cell));
  const std::size_t count = pruned.leaves().size();
  if (count < 2 || count > kTruthLeaves) return pruned;
  std::vector<std::optional<SoleSurface>> sole;
  for (const std::uint32_t leaf : pruned.leaves()) {
    sole.push_back(sole_surface_of(leaves_[leaf], surfaces_, cell));
  }
  const Cover value = value_over_surfaces(pruned, sole);
  return value == Cover::on ? pruned : CsgExpression(value);
}

std::vector<Box3d> CsgSolid::boxes_of(const CsgExpression& expression) const {
  std::vector<Box3d> boxes;
  boxes.reserve(expression.leaves().size());
  for (const std::uint32_t leaf : expression.leaves()) boxes.push_back(leaves_[leaf].bounds);
  return boxes;
}

bool CsgSolid::contains(const CsgExpression& expression, Vec3d p) const {
  return expression.eval([&](std::uint32_t slot) {
    return arris::contains(leaves_[expression.leaves()[slot]], surfaces_, p);
  });
}

Vec3d CsgSolid::outward_normal(const CsgBoundary& boundary, const Ray& ray) const {
  const Vec3d p = ray.origin + ray.direction * boundary.t;
  const Vec3d n = normal_at(leaves_[boundary.leaf], surfaces_, boundary.face, p);
  const double size = length(n);
  // At an apex or where a surface has no direction: straight back along the ray.
  const Vec3d unit = size > 0 && std::isfinite(size) ? n * (1 / size) : normalize(ray.direction);
  const bool against = dot(unit, ray.direction) < 0;
  return against == boundary.entering ? unit : -unit;
}

std::uint64_t truth_table(const CsgExpression& expression) {
  const std::size_t count = expression.leaves().size();
  if (count > kTruthLeaves) return 0;
  std::uint64_t table = 0;
  for (std::uint64_t state = 0; state < (std::uint64_t{1} << count); ++state) {
    const bool in = expression.eval([&](std::uint32_t slot) { return ((state >> slot) & 1) != 0; });
    table |= std::uint64_t(in ? 1 : 0) << state;
  }
  return table;
}

const std::vector<CsgBoundary>& BoundarySearch::find(const CsgSolid& solid,
                                                     const CsgExpressionView& expression,
                                                     const Ray& ray) {
  found_.clear();
  events_.clear();
  const std::size_t count = expression.leaves.size();
  inside_.assign(count, 0);
  std::uint64_t state = 0;
  const auto toggle = [&](std::uint32_t slot) {
    inside_[slot] ^= 1U;
    if (count <= kTruthLeaves) state ^= std::uint64_t{1} << slot;
  };
  const auto value = [&] {
    if (count <= kTruthLeaves) return ((expression.truth >> state) & 1) != 0;
    return CsgExpression::eval_steps(expression.steps,
                                     [&](std::uint32_t slot) { return inside_[slot] != 0; });
  };
  for (std::uint32_t slot = 0; slot < count; ++slot) {
    for (const Crossing& c :
         crossings_.find(solid.leaf(expression.leaves[slot]), solid.surfaces(), ray)) {
      if (c.t == -std::numeric_limits<double>::infinity()) {
        toggle(slot);
      } else if (std::isfinite(c.t)) {
        events_.push_back({c.t, slot, c.face});
      }
    }
  }
  if (events_.empty()) return found_;
  std::ranges::sort(events_, [](const Event& a, const Event& b) {
    return a.t != b.t ? a.t < b.t : a.slot < b.slot;
  });
  bool now = value();
  for (std::size_t i = 0; i < events_.size();) {
    const double t = events_[i].t;
    const bool before = now;
    // One leaf after the other, so that leaves that make no difference never seem to.
    std::size_t decider = i;
    for (; i < events_.size() && events_[i].t == t; ++i) {
      toggle(events_[i].slot);
      const bool next = value();
      if (next != now) decider = i;
      now = next;
    }
    if (now != before) {
      const Event& event = events_[decider];
      found_.push_back({t, expression.leaves[event.slot], event.face, now});
    }
  }
  return found_;
}

}  // namespace arris
