#include "beam/unresolved_regions.h"

#include <algorithm>
#include <map>
#include <set>

#include "beam/aimed_points.h"
#include "beam/ray_sight.h"

namespace arris {
namespace {

// Rays that a pixel aims at what was found in it and no ray has met.
constexpr int kAimedRays = 48;
// Of the regions that a leaf may be in, so many have a ray aimed at the middle of its part.
constexpr std::size_t kAimedRegions = 2;

bool holds(const Rect& rect, Vec2d p) {
  return p.x >= rect.x0 && p.x <= rect.x1 && p.y >= rect.y0 && p.y <= rect.y1;
}

}  // namespace

// Anything in the window may be seen, or nothing; a ray says what to take for it, until others are aimed.
void UnresolvedRegions::add(const LookTree& tree, const EndArea& end, const Rect& rect,
                            const std::vector<BeamPart>& parts) {
  const LookNode& node = tree.nodes[end.node];
  PixelSurface open;
  open.hi = end.hi;
  open.sample = end.sample;
  open.sample_weight = 0;
  surfaces_.add(open);
  for (std::uint32_t i = 0; i < node.count; ++i) {
    add_candidate(tree.candidates[node.first + i], end, rect);
  }
  if (node.count == 0) {
    for (const BeamPart& part : parts) add_all_faces(part, end, rect);
  }
  const std::optional<SeenSurface> seen = seen_by_ray(parts, end.sample);
  surfaces_.add_estimate(seen, end.sample, end.estimate);
  Region& region = regions_.emplace_back();
  region = {rect, seen, end.estimate, {}};
  for (std::uint32_t i = 0; i < node.count; ++i) {
    const SeenSurface& candidate = tree.candidates[node.first + i];
    region.leaves.push_back({candidate.solid, candidate.leaf});
  }
  std::ranges::sort(region.leaves);
  region.leaves.erase(std::unique(region.leaves.begin(), region.leaves.end()), region.leaves.end());
}

// It is seen nowhere but in its leaf's window.
void UnresolvedRegions::add_candidate(const SeenSurface& seen, const EndArea& end,
                                      const Rect& rect) {
  PixelSurface open;
  open.seen = seen;
  open.hi = std::min(end.hi, part_in_window(view_, {seen.solid, seen.leaf}, rect).area());
  open.sample = end.sample;
  open.sample_weight = 0;
  surfaces_.add(open);
}

void UnresolvedRegions::add_all_faces(const BeamPart& part, const EndArea& end, const Rect& rect) {
  for (const std::uint32_t leaf : part.expression.leaves()) {
    const BeamShape& shape = *solids_[part.solid].shape;
    const ConvexLeaf* convex = shape.convex(leaf);
    const std::size_t faces =
        convex == nullptr ? 1 : convex->planes.size() + (convex->quadric ? 1 : 0);
    for (std::uint32_t face = 0; face < faces; ++face) {
      for (const bool entering : {true, false}) {
        const std::uint32_t number = shape.is_whole(leaf) ? kAnyFace : face;
        add_candidate({part.solid, leaf, number, {}, entering}, end, rect);
      }
    }
  }
}

// What was found shows: rays are aimed at the leaves that may be seen in regions that stayed unknown and that no
// ray has met. Those they meet take a part of what the region's own ray stood for.
void UnresolvedRegions::add_forced_samples(const std::vector<BeamPart>& parts) {
  if (regions_.empty()) return;
  std::set<LeafName> done;  // met, or tried
  for (const PixelSurface& s : surfaces_.entries()) {
    if (s.seen && s.estimate > 0) done.insert({s.seen->solid, s.seen->leaf});
  }
  int left = kAimedRays;
  for (std::size_t i = 0; i < surfaces_.entries().size() && left > 0; ++i) {  // it grows
    const PixelSurface& s = surfaces_.entries()[i];
    if (!s.seen || s.mirror_number != 0 || !(s.hi > 0)) continue;
    const LeafPlace leaf{s.seen->solid, s.seen->leaf};
    if (!done.insert({leaf.solid, leaf.leaf}).second) continue;
    const auto try_aims = [&](const std::vector<Aim>& aims) {
      for (const Aim& aim : aims) {
        if (left-- <= 0) return true;
        const std::optional<SeenSurface> seen = force(aim, parts);
        if (!seen) continue;
        done.insert({seen->solid, seen->leaf});
        if (seen->solid == leaf.solid && seen->leaf == leaf.leaf) return true;
      }
      return false;
    };
    if (!try_aims(aims_at(leaf))) try_aims(aims_at_contacts(leaf, left));
  }
}

std::vector<UnresolvedRegions::Aim> UnresolvedRegions::aims_at(const LeafPlace& place) const {
  std::vector<Aim> aims;
  const std::vector<Vec2d> points = aimed_points(eye_, solids_[place.solid], place.leaf);
  std::vector<std::pair<double, Aim>> widest;  // by minus the area
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const Rect part = part_in_window(view_, place, regions_[i].rect);
    if (!(part.area() > 0)) continue;
    for (const Vec2d& p : points) {
      if (holds(part, p)) aims.push_back({i, p});
    }
    widest.push_back({-part.area(), {i, {part.middle_x(), part.middle_y()}}});
  }
  std::ranges::stable_sort(widest, {}, &std::pair<double, Aim>::first);
  widest.resize(std::min(widest.size(), kAimedRegions));
  for (const auto& [area, aim] : widest) aims.push_back(aim);
  return aims;
}

// Where the leaf changes its order with another that is unknown in one region with it. Each try costs a ray.
std::vector<UnresolvedRegions::Aim> UnresolvedRegions::aims_at_contacts(const LeafPlace& place,
                                                                        int& left) const {
  std::map<LeafName, std::vector<std::size_t>> regions;  // by the other leaf
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const std::vector<LeafName>& leaves = regions_[i].leaves;
    if (!std::ranges::binary_search(leaves, LeafName{place.solid, place.leaf})) continue;
    for (const LeafName& leaf : leaves) regions[leaf].push_back(i);
  }
  std::vector<Aim> aims;
  for (const auto& [leaf, of_leaf] : regions) {
    const LeafPlace other{leaf.first, leaf.second};
    if (leaf == LeafName{place.solid, place.leaf} || left-- <= 0) continue;
    const Rect& start = regions_[of_leaf[of_leaf.size() / 2]].rect;
    for (const Vec2d& p : points_of_contact(solids_, eye_, {place, other}, start)) {
      const auto at =
          std::ranges::find_if(of_leaf, [&](std::size_t i) { return holds(regions_[i].rect, p); });
      if (at != of_leaf.end()) aims.push_back({*at, p});
    }
  }
  return aims;
}

// A surface that had no share has half of what its leaf may fill of the region from now on, if the ray meets it.
std::optional<SeenSurface> UnresolvedRegions::force(const Aim& aim,
                                                    const std::vector<BeamPart>& parts) {
  Region& region = regions_[aim.region];
  const std::optional<SeenSurface> seen = seen_by_ray(parts, aim.at);
  if (!seen) return seen;
  PixelSurface surface;
  surface.seen = seen;
  if (surfaces_.entry_of(surface).estimate > 0) return seen;
  const Rect part = part_in_window(view_, {seen->solid, seen->leaf}, region.rect);
  const double share = std::min(part.area(), region.left) / 2;
  region.left -= share;
  surfaces_.add_estimate(seen, aim.at, share);
  surface.seen = region.seen;
  surface.estimate = -share;
  surfaces_.add(surface);
  return seen;
}

std::optional<SeenSurface> UnresolvedRegions::seen_by_ray(const std::vector<BeamPart>& parts,
                                                          Vec2d at) {
  ++ray_count_;
  const std::optional<RaySight> sight = see(solids_, parts, ray_through(eye_, at));
  return sight ? std::optional(sight->seen) : std::nullopt;
}

}  // namespace arris
