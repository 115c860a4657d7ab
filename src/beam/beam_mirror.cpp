#include "beam/beam_mirror.h"

#include <limits>
#include <utility>

namespace arris {
namespace {

struct WorldPlane {
  Vec3d normal;  // unit
  double d = 0;
};

WorldPlane to_world(const BeamSolid& solid, const CsgPlane& plane) {
  const Vec3d normal = transpose(solid.object_from_world.linear) * plane.normal;
  const double d = plane.d - dot(plane.normal, solid.object_from_world.translation);
  const double scale = 1 / length(normal);
  return {normal * scale, d * scale};
}

EyeRays mirror_eye(const EyeRays& eye, const WorldPlane& plane) {
  const auto turn = [&](Vec3d v) { return v - plane.normal * (2 * dot(plane.normal, v)); };
  return {turn(eye.position) + plane.normal * (2 * plane.d), turn(eye.corner), turn(eye.step_x),
          turn(eye.step_y)};
}

}  // namespace

MirrorLooker::MirrorLooker(std::span<const BeamSolid> solids, const EyeRays& eye,
                           IsMirror is_mirror)
    : solids_(solids), eye_(eye), is_mirror_(std::move(is_mirror)) {}

bool MirrorLooker::is_mirror(const LookNode& node) const {
  return is_mirror_ && node.kind == LookNode::Kind::surface && node.seen.surface.is_plane() &&
         is_mirror_(node.seen);
}

bool MirrorLooker::add_mirrors(LookTree& tree, const Rect& rect, MirrorLists& lists,
                               std::uint64_t& regions) const {
  if (!is_mirror_) return true;
  bool complete = true;
  // Nodes that take the place of a mirror, or are added, are looked at in their turn.
  for (std::uint32_t i = 0; i < tree.nodes.size();) {
    const LookNode mirror = tree.nodes[i];
    const bool deep = mirror.mirrors != 0 && lists.chain(mirror.mirrors).size() >= kMostMirrors;
    if (deep || mirror.mirror_open || !is_mirror(mirror)) {
      ++i;
      continue;
    }
    const std::uint32_t number = list_for(mirror, lists);
    const MirrorLists::List& list = lists.lists_[number - 1];
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const BeamList beam = prune_parts(list.view, list.parts, rect, kInfinity);
    const LookTree seen = look(list.view, beam, rect, kInfinity);
    ++regions;
    complete = complete && seen.complete;
    replace_node(tree, i, seen, [&](const LookNode& end) {
      // By rounding a ray may start inside what touches the mirror.
      const bool is_open = end.kind == LookNode::Kind::unknown ||
                           (end.kind == LookNode::Kind::surface && end.seen.leaf == kStartLeaf);
      LookNode node = is_open ? mirror : end;
      node.mirror_open = is_open;
      if (!is_open) node.mirrors = number;
      return node;
    });
  }
  return complete;
}

std::uint32_t MirrorLooker::list_for(const LookNode& mirror, MirrorLists& lists) const {
  const SeenSurface& seen = mirror.seen;
  const MirrorLists::Key key{mirror.mirrors, seen.solid, seen.leaf, seen.face};
  const auto known = lists.known_.find(key);
  if (known != lists.known_.end()) return known->second;
  const EyeRays eye = mirror.mirrors == 0 ? eye_ : lists.eye(mirror.mirrors);
  MirrorChain chain;
  if (mirror.mirrors != 0) chain = lists.chain(mirror.mirrors);
  chain.push_back(seen);
  const BeamSolid& solid = solids_[seen.solid];
  const EyeRays mirrored =
      mirror_eye(eye, to_world(solid, solid.shape->planes()[seen.surface.index]));
  BeamView view(solids_, mirrored, LitPlane{seen.solid, seen.surface.index});
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const CsgExpression& root = solids_[i].shape->root();
    if (!root.is_decided()) roots.push_back({i, root.intersected_with(kStartLeaf)});
  }
  std::vector<BeamPart> parts =
      prune_parts(view, roots, lists.tile_, std::numeric_limits<double>::infinity()).parts;
  lists.lists_.push_back({std::move(chain), mirrored, std::move(view), std::move(parts)});
  return lists.known_[key] = std::uint32_t(lists.lists_.size());
}

}  // namespace arris
