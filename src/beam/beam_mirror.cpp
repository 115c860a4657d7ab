#include "beam/beam_mirror.h"

#include <limits>
#include <map>
#include <utility>

#include "beam/taylor_model.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostNodes = 128;  // of a region's tree

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

// A mesh by itself is entered wherever it is met. Do the rays come from where the facet's corners turn
// counter-clockwise?
std::optional<bool> from_outside(const RayBundle& bundle, const BeamSolid& solid,
                                 const Facet& facet) {
  const BundlePlane form = make_form(map_bundle(solid.object_from_world, bundle),
                                     solid.shape->planes()[facet.plane.plane]);
  const Interval slope = range_of(form.slope), height = range_of(form.height);
  const bool towards = slope.hi < 0 || height.lo > 0, away = slope.lo > 0 || height.hi < 0;
  if (towards == away) return std::nullopt;
  return towards != facet.plane.flipped;
}

EyeRays mirror_eye(const EyeRays& eye, const WorldPlane& plane) {
  const auto turn = [&](Vec3d v) { return v - plane.normal * (2 * dot(plane.normal, v)); };
  return {turn(eye.position) + plane.normal * (2 * plane.d), turn(eye.corner), turn(eye.step_x),
          turn(eye.step_y)};
}

}  // namespace

MirrorLooker::MirrorLooker(std::span<const BeamSolid> solids, const EyeRays& eye, OpticsOf optics)
    : solids_(solids), eye_(eye), optics_(std::move(optics)) {}

bool MirrorLooker::is_mirror(const LookNode& node) const {
  return optics_ && node.kind == LookNode::Kind::surface &&
         optics_(node.seen).kind != Optics::Kind::scatters;
}

bool MirrorLooker::add_mirrors(LookTree& tree, const Rect& rect, MirrorLists& lists,
                               std::uint64_t& regions) const {
  if (!optics_) return true;
  bool complete = true;
  std::map<std::uint32_t, std::optional<LookTree>> looked;  // a mirror may be at several ends
  // Nodes that take the place of a mirror, or are added, are looked at in their turn.
  for (std::uint32_t i = 0; i < tree.nodes.size();) {
    const LookNode mirror = tree.nodes[i];
    const bool deep = mirror.mirrors != 0 && lists.chain(mirror.mirrors).size() >= kMostMirrors;
    if (deep || mirror.mirror_open || !is_mirror(mirror)) {
      ++i;
      continue;
    }
    if (mirror.seen.surface.is_whole()) {
      tree.nodes[i].mirror_open = true;
      continue;
    }
    const std::optional<MirrorLink> link = link_of(mirror, rect, lists);
    if (!link) {
      complete = false;
      tree.nodes[i].mirror_open = true;
      continue;
    }
    const std::uint32_t number = list_for(mirror.mirrors, *link, lists);
    if (!looked.contains(number)) {
      looked[number] = look_into(lists.lists_[number - 1], rect, lists.tile_);
      ++regions;
    }
    const std::optional<LookTree>& seen = looked[number];
    complete = complete && seen && seen->complete;
    // Trees below trees grow as their product.
    const bool is_small = seen && tree.nodes.size() + seen->nodes.size() <= kMostNodes;
    complete = complete && is_small;
    if (!is_small) {
      tree.nodes[i].mirror_open = true;
      continue;
    }
    tree.refines = tree.refines || seen->refines;
    replace_node(tree, i, *seen, [&](const LookNode& end) {
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

std::optional<LookTree> MirrorLooker::look_into(MirrorLists::List& list, const Rect& rect,
                                                const Rect& tile) const {
  if (!list.flat) return look_by_bundle(list, rect, tile);
  const BeamList beam = prune_parts(list.flat->view, list.flat->parts, rect, kInfinity);
  return look(list.flat->view, beam, rect, kInfinity);
}

std::optional<LookTree> MirrorLooker::look_by_bundle(MirrorLists::List& list, const Rect& rect,
                                                     const Rect& tile) const {
  const std::optional<RayBundle> bundle = bundle_of(list.chain, rect);
  if (!bundle) return std::nullopt;
  const auto holds = [&](const MirrorLists::Level& level) {
    const Rect& r = level.rect;
    return r.x0 <= rect.x0 && r.y0 <= rect.y0 && r.x1 >= rect.x1 && r.y1 >= rect.y1;
  };
  while (!list.levels.empty() && !holds(list.levels.back())) list.levels.pop_back();
  if (list.levels.empty()) {
    const std::optional<RayBundle> whole = bundle_of(list.chain, tile);
    list.levels.push_back(whole ? MirrorLists::Level{tile, parts_near(*whole)}
                                : MirrorLists::Level{rect, parts_near(*bundle)});
  }
  const BeamView view(solids_, *bundle);
  BeamList beam = prune_parts(view, list.levels.back().parts, kUnitSquare, kInfinity);
  LookTree seen = look(view, beam, kUnitSquare, kInfinity);
  const Rect& last = list.levels.back().rect;
  if (last.width() > rect.width()) list.levels.push_back({rect, std::move(beam.parts)});
  for (LookNode& node : seen.nodes) {
    if (node.kind != LookNode::Kind::sign) continue;
    seen.refines = true;
    node.polynomial = on_picture(node.polynomial, rect);
  }
  return seen;
}

std::optional<RayBundle> MirrorLooker::bundle_of(const MirrorChain& chain, const Rect& rect) const {
  std::optional<RayBundle> bundle = make_bundle(eye_, rect);
  for (const MirrorLink& link : chain) {
    bundle = link.refracted ? refract(*bundle, solids_, link.seen.surface, link.relative_ior)
                            : reflect(*bundle, solids_, link.seen.surface);
    if (!bundle) break;
  }
  return bundle;
}

std::optional<MirrorLink> MirrorLooker::link_of(const LookNode& mirror, const Rect& rect,
                                                const MirrorLists& lists) const {
  SeenSurface seen = mirror.seen;
  if (optics_(seen).kind == Optics::Kind::reflects) return MirrorLink{seen, false, 1};
  const MirrorChain none;
  const std::optional<RayBundle> bundle =
      bundle_of(mirror.mirrors == 0 ? none : lists.chain(mirror.mirrors), rect);
  if (!bundle) return std::nullopt;
  const BeamShape& shape = *solids_[seen.solid].shape;
  if (shape.is_mesh()) {
    const std::optional<bool> outside =
        from_outside(*bundle, solids_[seen.solid], *shape.facet(seen.leaf));
    if (!outside) return std::nullopt;
    seen.entering = *outside;
  }
  const Optics optics = optics_(seen);
  const Passing passing = passing_of(*bundle, solids_, seen.surface, optics.relative_ior);
  if (passing == Passing::unknown) return std::nullopt;
  return MirrorLink{seen, passing == Passing::all, optics.relative_ior};
}

std::vector<BeamPart> MirrorLooker::parts_near(const RayBundle& bundle) const {
  std::vector<BeamPart> parts;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const RayBundle own = map_bundle(solids_[i].object_from_world, bundle);
    const Vec3i origin = ranges_of(own.origin), direction = ranges_of(own.direction);
    CsgExpression root = solids_[i].shape->root_near(
        [&](const Box3d& box) { return depths_in(box, origin, direction, kInfinity).has_value(); });
    if (!root.is_decided()) parts.push_back({i, std::move(root)});
  }
  return parts;
}

std::uint32_t MirrorLooker::list_for(std::uint32_t mirrors, const MirrorLink& link,
                                     MirrorLists& lists) const {
  const SeenSurface& seen = link.seen;
  const MirrorLists::Key key{mirrors,           seen.solid,    seen.leaf,     seen.face,
                             seen.surface.root, seen.entering, link.refracted};
  const auto known = lists.known_.find(key);
  if (known != lists.known_.end()) return known->second;
  MirrorLists::List list;
  const MirrorLists::List* before = mirrors != 0 ? &lists.lists_[mirrors - 1] : nullptr;
  if (before != nullptr) list.chain = before->chain;
  list.chain.push_back(link);
  // From within a solid the rays begin inside of it, which the flat mirror's view has not.
  if (seen.surface.is_plane() && seen.entering && !link.refracted &&
      (before == nullptr || before->flat)) {
    list.flat = make_flat(before == nullptr ? eye_ : before->flat->eye, seen, lists.tile_);
  }
  lists.lists_.push_back(std::move(list));
  return lists.known_[key] = std::uint32_t(lists.lists_.size());
}

MirrorLists::FlatView MirrorLooker::make_flat(const EyeRays& eye, const SeenSurface& mirror,
                                              const Rect& tile) const {
  const BeamSolid& solid = solids_[mirror.solid];
  const EyeRays mirrored =
      mirror_eye(eye, to_world(solid, solid.shape->planes()[mirror.surface.index]));
  BeamView view(solids_, mirrored, LitPlane{mirror.solid, mirror.surface.index});
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const CsgExpression& root = solids_[i].shape->root();
    if (!root.is_decided()) roots.push_back({i, root.intersected_with(kStartLeaf)});
  }
  std::vector<BeamPart> parts = prune_parts(view, roots, tile, kInfinity).parts;
  return {mirrored, std::move(view), std::move(parts)};
}

}  // namespace arris
