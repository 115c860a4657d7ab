#include "beam/beam_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/hash.h"
#include "base/parallel_for.h"
#include "beam/aimed_points.h"
#include "beam/lit_regions.h"
#include "beam/ray_sight.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How often a pixel's outlines are followed again, each time four times as closely.
constexpr int kCloserLooks = 4;
// As long as that leaves at most this part of what was open.
constexpr double kGain = 0.7;

// Rays that a pixel aims at what was found in it and no ray has met.
constexpr int kAimedRays = 48;
// Of the regions that a leaf may be in, so many have a ray aimed at the middle of its part.
constexpr std::size_t kAimedRegions = 2;

}  // namespace

void BeamStats::add(const BeamStats& other) {
  regions += other.regions;
  rays += other.rays;
  pixels += other.pixels;
  uncertified_pixels += other.uncertified_pixels;
  certified_area += other.certified_area;
}

// One tile under way.
class BeamTracer::Tracer {
 public:
  Tracer(const BeamTracer& shared, const Rect& tile,
         const std::function<void(const BeamPixel&)>& sink)
      : shared_(shared), sink_(sink), lists_(tile), mirror_lists_(tile) {}

  // Of at least a pixel.
  void visit(const Rect& rect, const std::vector<BeamPart>& above, double depth_end) {
    if (rect.x0 >= shared_.width_px_ || rect.y0 >= shared_.height_px_ || is_stopped()) return;
    const BeamList list = prune_parts(shared_.view_, above, rect, depth_end);
    const std::vector<BeamPart>& parts = list.parts;
    ++stats_.regions;
    LookTree tree = look(shared_.view_, list, rect, depth_end);
    const double next_end = std::min(depth_end, tree.depth_end);
    if ((tree.complete || tree.hopeless) && add_light(tree, rect)) {
      if (!shared_.shadows_.is_joint()) {
        lit_regions_.look(shared_.shadows_, tree, rect, lists_, stats_.regions,
                          [&](const LookNode& node) { return is_unlit(node); });
      }
      for (double y = rect.y0; y < rect.y1; ++y) {
        for (double x = rect.x0; x < rect.x1; ++x)
          add_pixel(tree, {x, y, x + 1, y + 1}, rect, parts, next_end);
      }
    } else if (rect.width() > 1) {
      for (const Rect& part : quarters_of(rect)) visit(part, parts, next_end);
    } else {
      visit_parts_of(rect, parts, next_end);
    }
  }

  [[nodiscard]] const BeamStats& stats() const { return stats_; }

 private:
  [[nodiscard]] bool is_stopped() const {
    return shared_.options_.stop != nullptr && shared_.options_.stop->load();
  }
  void visit_parts_of(const Rect& pixel, const std::vector<BeamPart>& parts, double depth_end) {
    clear_pixel();
    smallest_part_ = 1;
    pixel_rays_ = 0;
    pixel_looks_ = 0;
    for (const Rect& part : quarters_of(pixel)) visit_part(part, parts, depth_end);
    add_forced_samples(parts);
    finish_pixel(pixel, {pixel.x0, pixel.y0, pixel.x0 + smallest_part_, pixel.y0 + smallest_part_});
  }
  // Of less than a pixel.
  void visit_part(const Rect& rect, const std::vector<BeamPart>& above, double depth_end) {
    if (is_stopped()) return;
    const BeamList list = prune_parts(shared_.view_, above, rect, depth_end);
    const std::vector<BeamPart>& parts = list.parts;
    ++stats_.regions;
    LookTree tree = look(shared_.view_, list, rect, depth_end);
    const bool smallest = tree.hopeless || rect.width() <= least_region(parts);
    const bool complete = (tree.complete || smallest) && add_light(tree, rect);
    if (complete || smallest) {
      const std::vector<EndArea> ends = areas_of(tree, rect, {.with_samples = any_varies(tree)});
      // An outline crosses one region after the other: each has its part of the tolerance.
      const double most_open = shared_.options_.tolerance * rect.width() / 2;
      if (smallest || !tree.refines || open_area(ends) <= most_open) {
        smallest_part_ = std::min(smallest_part_, rect.width());
        add_ends(tree, ends, rect, parts);
        add_lit_shares(tree, rect);
        return;
      }
    }
    for (const Rect& part : quarters_of(rect)) {
      visit_part(part, parts, std::min(depth_end, tree.depth_end));
    }
  }

  // Outlines of leaves that aren't convex stay open however small the regions are; so do pixels with much that is
  // unknown.
  [[nodiscard]] double least_region(const std::vector<BeamPart>& parts) const {
    const bool any_whole = std::ranges::any_of(parts, [&](const BeamPart& part) {
      return std::ranges::any_of(part.expression.leaves(), [&](std::uint32_t leaf) {
        return shared_.solids_[part.solid].shape->is_whole(leaf);
      });
    });
    const BeamOptions& options = shared_.options_;
    double least = options.least_region;
    if (any_whole) least = std::max(least, options.least_open_region);
    if (pixel_looks_ > 4 * options.many_looks) least = std::max(least, options.least_open_region);
    if (pixel_rays_ > options.many_rays || pixel_looks_ > options.many_looks)
      least = std::max(least, options.least_crowded_region);
    return least;
  }

  // Shadows, and what is seen in mirrors.
  bool add_light(LookTree& tree, const Rect& rect) {
    const bool shadows = shared_.shadows_.add_shadows(
        tree, rect, lists_, stats_.regions, [&](const LookNode& node) { return is_unlit(node); });
    std::uint64_t looks = 0;
    const bool mirrored = shared_.mirrors_.add_mirrors(tree, rect, mirror_lists_, looks);
    pixel_looks_ += looks;
    stats_.regions += looks;
    return mirrored && shadows;
  }
  [[nodiscard]] bool is_unlit(const LookNode& node) const {
    return shared_.mirrors_.is_mirror(node);
  }

  void add_pixel(const LookTree& tree, const Rect& pixel, const Rect& region,
                 const std::vector<BeamPart>& parts, double depth_end) {
    if (pixel.x0 >= shared_.width_px_ || pixel.y0 >= shared_.height_px_) return;
    AreaOptions options{.with_samples = any_varies(tree)};
    double before = kInfinity;
    for (int i = 0; i <= kCloserLooks; ++i) {
      clear_pixel();
      add_ends(tree, areas_of(tree, pixel, options), pixel, parts);
      const double open = open_area();
      if (tree.hopeless || is_certified() || open > kGain * before) break;
      before = open;
      options.tolerance /= 4;
      options.least_side /= 4;
    }
    if (tree.refines && !is_certified()) {
      visit_parts_of(pixel, parts, depth_end);
      return;
    }
    add_forced_samples(parts);
    add_lit_shares_of_pixel(tree, pixel);
    finish_pixel(pixel, region);
  }

  void clear_pixel() {
    surfaces_.clear();
    unresolved_.clear();
  }

  // Is it curved, or seen in a mirror, so that rays tell its light?
  static bool varies(const LookNode& node) {
    return node.mirrors != 0 ||
           (node.kind == LookNode::Kind::surface && !node.seen.surface.is_plane());
  }
  static bool any_varies(const LookTree& tree) { return std::ranges::any_of(tree.nodes, varies); }

  static double open_area(const std::vector<EndArea>& ends) {
    double open = 0;
    for (const EndArea& end : ends) open += end.hi - end.lo;
    return open;
  }
  [[nodiscard]] double open_area() const {
    double open = 0;
    for (const PixelSurface& s : surfaces_) open += s.hi - s.lo;
    return open;
  }
  [[nodiscard]] bool is_certified() const {
    return std::ranges::all_of(surfaces_, [&](const PixelSurface& s) {
      return s.hi - s.lo <= shared_.options_.tolerance &&
             !((s.mirror_open || s.light_open) && s.hi > shared_.options_.tolerance) &&
             std::ranges::none_of(s.lit_shares, [&](const LitShare& share) {
               return share.hi - share.lo > shared_.options_.tolerance ||
                      share.doubtful > shared_.options_.tolerance;
             });
    });
  }

  void add_ends(const LookTree& tree, const std::vector<EndArea>& ends, const Rect& rect,
                const std::vector<BeamPart>& parts) {
    for (const EndArea& end : ends) {
      const LookNode& node = tree.nodes[end.node];
      if (node.kind == LookNode::Kind::unknown) {
        add_unknown(tree, node, end, rect, parts);
        continue;
      }
      PixelSurface surface;
      if (node.kind == LookNode::Kind::surface) surface.seen = node.seen;
      surface.lit = node.lit;
      surface.lit_known = node.lit_known;
      surface.lo = end.lo;
      surface.hi = end.hi;
      surface.estimate = end.estimate;
      surface.sample = end.sample;
      surface.sample_weight = end.estimate;
      surface.mirror_open = node.mirror_open;
      surface.light_open = node.light_open;
      surface.mirror_number = node.mirrors;
      if (varies(node)) surface.samples = end.samples;
      add(surface);
    }
  }

  // How much of each surface each light reaches, where that is asked for one by one: of a pixel whose region was looked
  // at from the lights,
  void add_lit_shares_of_pixel(const LookTree& tree, const Rect& pixel) {
    if (shared_.shadows_.is_joint()) return;
    for (std::uint32_t light = 0; light < shared_.shadows_.light_count(); ++light) {
      const LitTree& lit = lit_regions_.tree_of(light, pixel);
      if (!lit.complete) {
        for (const Rect& part : quarters_of(pixel)) add_lit_share(tree, part, light);
        continue;
      }
      const std::vector<EndArea> ends = areas_of(lit.tree, pixel, {.with_samples = false});
      // Signs of a large region may be many that cross.
      if (open_area(ends) > shared_.options_.tolerance && lit.rect.width() > 1) {
        add_lit_share(tree, pixel, light);
      } else {
        add_lit_ends(lit.tree, ends, light);
      }
    }
  }
  // and of a part of a pixel.
  void add_lit_shares(const LookTree& tree, const Rect& rect) {
    if (shared_.shadows_.is_joint()) return;
    for (std::uint32_t light = 0; light < shared_.shadows_.light_count(); ++light) {
      add_lit_share(tree, rect, light);
    }
  }
  void add_lit_share(const LookTree& tree, const Rect& rect, std::uint32_t light) {
    LookTree lit = tree;
    const bool complete =
        shared_.shadows_.add_shadow(lit, rect, light, lists_, stats_.regions,
                                    [&](const LookNode& node) { return is_unlit(node); });
    if (!complete && rect.width() > shared_.options_.least_shadow_region) {
      for (const Rect& part : quarters_of(rect)) add_lit_share(tree, part, light);
      return;
    }
    add_lit_ends(lit, areas_of(lit, rect, {.with_samples = false}), light);
  }
  void add_lit_ends(const LookTree& lit, const std::vector<EndArea>& ends, std::uint32_t light) {
    for (const EndArea& end : ends) {
      const LookNode& node = lit.nodes[end.node];
      if (node.kind != LookNode::Kind::surface || (node.lit_known == 0 && !node.light_open)) {
        continue;
      }
      PixelSurface surface;
      surface.seen = node.seen;
      surface.mirror_number = node.mirrors;
      surface.mirror_open = node.mirror_open;
      PixelSurface& entry = entry_of(surface);
      entry.lit_shares.resize(shared_.shadows_.light_count());
      LitShare& share = entry.lit_shares[light];
      if (node.light_open) {
        share.doubtful += end.hi;
        continue;
      }
      share.open -= end.estimate;
      if (node.lit == 0) continue;
      share.lo += end.lo;
      share.hi += end.hi;
      share.estimate += end.estimate;
    }
  }

  // Anything in the window may be seen, or nothing; a ray says what to take for it, until others are aimed.
  void add_unknown(const LookTree& tree, const LookNode& node, const EndArea& end, const Rect& rect,
                   const std::vector<BeamPart>& parts) {
    PixelSurface open;
    open.hi = end.hi;
    open.sample = end.sample;
    open.sample_weight = 0;
    add(open);
    for (std::uint32_t i = 0; i < node.count; ++i) {
      add_candidate(tree.candidates[node.first + i], end, rect);
    }
    if (node.count == 0) {
      for (const BeamPart& part : parts) add_all_faces(part, end, rect);
    }
    const std::optional<SeenSurface> seen = seen_by_ray(parts, end.sample);
    add_estimate(seen, end.sample, end.estimate);
    Unresolved& region = unresolved_.emplace_back();
    region = {rect, seen, end.estimate, {}};
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const SeenSurface& candidate = tree.candidates[node.first + i];
      region.leaves.push_back({candidate.solid, candidate.leaf});
    }
    std::ranges::sort(region.leaves);
    region.leaves.erase(std::ranges::unique(region.leaves).begin(), region.leaves.end());
  }

  // It is seen nowhere but in its leaf's window.
  void add_candidate(const SeenSurface& seen, const EndArea& end, const Rect& rect) {
    PixelSurface open;
    open.seen = seen;
    open.hi = std::min(end.hi, part_in_window(shared_.view_, {seen.solid, seen.leaf}, rect).area());
    open.sample = end.sample;
    open.sample_weight = 0;
    add(open);
  }

  void add_all_faces(const BeamPart& part, const EndArea& end, const Rect& rect) {
    for (const std::uint32_t leaf : part.expression.leaves()) {
      const BeamShape& shape = *shared_.solids_[part.solid].shape;
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

  void add_estimate(const std::optional<SeenSurface>& seen, Vec2d sample, double estimate) {
    PixelSurface surface;
    surface.seen = seen;
    surface.sample = sample;
    surface.estimate = surface.sample_weight = estimate;
    add(surface);
  }

  // What was found shows: rays are aimed at the leaves that may be seen in regions that stayed unknown and that no
  // ray has met. Those they meet take a part of what the region's own ray stood for.
  void add_forced_samples(const std::vector<BeamPart>& parts) {
    if (unresolved_.empty()) return;
    std::set<LeafName> done;  // met, or tried
    for (const PixelSurface& s : surfaces_) {
      if (s.seen && s.estimate > 0) done.insert({s.seen->solid, s.seen->leaf});
    }
    int left = kAimedRays;
    for (std::size_t i = 0; i < surfaces_.size() && left > 0; ++i) {  // it grows
      const PixelSurface& s = surfaces_[i];
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

  struct Aim {
    std::size_t region = 0;  // of unresolved_
    Vec2d at;
  };
  static bool holds(const Rect& rect, Vec2d p) {
    return p.x >= rect.x0 && p.x <= rect.x1 && p.y >= rect.y0 && p.y <= rect.y1;
  }
  [[nodiscard]] std::vector<Aim> aims_at(const LeafPlace& place) const {
    std::vector<Aim> aims;
    const std::vector<Vec2d> points =
        aimed_points(shared_.eye_, shared_.solids_[place.solid], place.leaf);
    std::vector<std::pair<double, Aim>> widest;  // by minus the area
    for (std::size_t i = 0; i < unresolved_.size(); ++i) {
      const Rect part = part_in_window(shared_.view_, place, unresolved_[i].rect);
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
  [[nodiscard]] std::vector<Aim> aims_at_contacts(const LeafPlace& place, int& left) const {
    std::map<LeafName, std::vector<std::size_t>> regions;  // by the other leaf
    for (std::size_t i = 0; i < unresolved_.size(); ++i) {
      const std::vector<LeafName>& leaves = unresolved_[i].leaves;
      if (!std::ranges::binary_search(leaves, LeafName{place.solid, place.leaf})) continue;
      for (const LeafName& leaf : leaves) regions[leaf].push_back(i);
    }
    std::vector<Aim> aims;
    for (const auto& [leaf, of_leaf] : regions) {
      const LeafPlace other{leaf.first, leaf.second};
      if (leaf == LeafName{place.solid, place.leaf} || left-- <= 0) continue;
      const Rect& start = unresolved_[of_leaf[of_leaf.size() / 2]].rect;
      for (const Vec2d& p :
           points_of_contact(shared_.solids_, shared_.eye_, {place, other}, start)) {
        const auto at = std::ranges::find_if(
            of_leaf, [&](std::size_t i) { return holds(unresolved_[i].rect, p); });
        if (at != of_leaf.end()) aims.push_back({*at, p});
      }
    }
    return aims;
  }

  // A surface that had no share has half of what its leaf may fill of the region from now on, if the ray meets it.
  std::optional<SeenSurface> force(const Aim& aim, const std::vector<BeamPart>& parts) {
    Unresolved& region = unresolved_[aim.region];
    const std::optional<SeenSurface> seen = seen_by_ray(parts, aim.at);
    if (!seen) return seen;
    PixelSurface surface;
    surface.seen = seen;
    if (entry_of(surface).estimate > 0) return seen;
    const Rect part = part_in_window(shared_.view_, {seen->solid, seen->leaf}, region.rect);
    const double share = std::min(part.area(), region.left) / 2;
    region.left -= share;
    add_estimate(seen, aim.at, share);
    surface.seen = region.seen;
    surface.estimate = -share;
    add(surface);
    return seen;
  }

  std::optional<SeenSurface> seen_by_ray(const std::vector<BeamPart>& parts, Vec2d at) {
    ++stats_.rays;
    ++pixel_rays_;
    const std::optional<RaySight> sight =
        see(shared_.solids_, parts, ray_through(shared_.eye_, at));
    return sight ? std::optional(sight->seen) : std::nullopt;
  }

  // Surfaces are the same by it; ~0 three times: nothing is seen.
  using Key = std::array<std::uint32_t, 6>;
  static Key key_of(const PixelSurface& s) {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    const std::uint32_t mirrors =
        s.mirror_number * 4 + (s.mirror_open ? 2 : 0) + (s.light_open ? 1 : 0);
    if (!s.seen) return {kNone, kNone, kNone, s.lit, s.lit_known, mirrors};
    const std::uint32_t face = s.seen->face * 2 + (s.seen->entering ? 1 : 0);
    return {s.seen->solid, s.seen->leaf, face, s.lit, s.lit_known, mirrors};
  }
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      std::uint32_t hash = 0;
      for (const std::uint32_t part : key) hash = hash_combine(hash, part);
      return hash;
    }
  };

  // The entry of the surface; a new one has nothing in it.
  PixelSurface& entry_of(const PixelSurface& surface) {
    constexpr std::size_t kFewSurfaces = 16;  // of more, an index is faster
    const Key key = key_of(surface);
    if (surfaces_.size() <= kFewSurfaces) {
      index_.clear();
      for (PixelSurface& known : surfaces_) {
        if (key_of(known) == key) return known;
      }
    } else {
      if (index_.empty()) {
        for (std::uint32_t i = 0; i < surfaces_.size(); ++i) index_[key_of(surfaces_[i])] = i;
      }
      const auto [at, is_new] = index_.try_emplace(key, std::uint32_t(surfaces_.size()));
      if (!is_new) return surfaces_[at->second];
    }
    PixelSurface& added = surfaces_.emplace_back();
    added.seen = surface.seen;
    added.lit = surface.lit;
    added.lit_known = surface.lit_known;
    added.mirror_open = surface.mirror_open;
    added.light_open = surface.light_open;
    added.mirror_number = surface.mirror_number;
    if (surface.mirror_number != 0) added.mirrors = mirror_lists_.chain(surface.mirror_number);
    return added;
  }

  void add(const PixelSurface& surface) {
    PixelSurface& known = entry_of(surface);
    known.lo += surface.lo;
    known.hi += surface.hi;
    known.estimate += surface.estimate;
    if (!shared_.shadows_.is_joint()) {
      known.lit_shares.resize(shared_.shadows_.light_count());
      for (LitShare& share : known.lit_shares) share.open += surface.estimate;
    }
    known.samples.insert(known.samples.end(), surface.samples.begin(), surface.samples.end());
    if (surface.sample_weight > known.sample_weight) {
      known.seen = surface.seen;  // with the root that is seen there
      known.sample = surface.sample;
      known.sample_weight = surface.sample_weight;
    }
  }

  void finish_pixel(const Rect& pixel, const Rect& region) {
    BeamPixel out;
    out.x = int(pixel.x0);
    out.y = int(pixel.y0);
    double nothing_lo = 0, nothing_hi = 0, certain = 0;
    for (PixelSurface& s : surfaces_) {
      s.lo = std::clamp(s.lo, 0.0, 1.0);
      s.hi = std::clamp(s.hi, 0.0, 1.0);
      certain += s.lo;
      if (s.seen || s.mirror_number != 0) continue;
      nothing_lo += s.lo;
      nothing_hi += s.hi;
    }
    out.coverage_lo = std::clamp(1 - nothing_hi, 0.0, 1.0);
    out.coverage_hi = std::clamp(1 - nothing_lo, 0.0, 1.0);
    out.certified = is_certified();
    out.region_side = region.width();
    out.begins_region = pixel.x0 == region.x0 || pixel.y0 == region.y0;
    out.surfaces = surfaces_;
    ++stats_.pixels;
    stats_.uncertified_pixels += out.certified ? 0 : 1;
    stats_.certified_area += std::min(certain, 1.0);
    sink_(out);
  }

  using LeafName = std::pair<std::uint32_t, std::uint32_t>;
  // A region in which something stayed unknown.
  struct Unresolved {
    Rect rect;
    std::optional<SeenSurface> seen;  // by the ray that stands in
    double left = 0;                  // of what that stands for
    std::vector<LeafName> leaves;     // that are put in order there, ascending; none: too many
  };

  const BeamTracer& shared_;
  const std::function<void(const BeamPixel&)>& sink_;
  ShadowLists lists_;
  MirrorLists mirror_lists_;
  LitRegions lit_regions_;  // of the region under way
  double smallest_part_ = 1;
  std::uint32_t pixel_rays_ = 0;   // that the pixel has taken so far
  std::uint64_t pixel_looks_ = 0;  // into mirrors
  std::vector<PixelSurface> surfaces_;
  std::vector<Unresolved> unresolved_;                     // of the pixel
  std::unordered_map<Key, std::uint32_t, KeyHash> index_;  // of surfaces_, where they are many
  BeamStats stats_;
};

BeamTracer::BeamTracer(std::span<const BeamSolid> solids, const EyeRays& eye, int width_px,
                       int height_px, const BeamOptions& options,
                       std::span<const LightPlace> lights)
    : solids_(solids),
      eye_(eye),
      width_px_(width_px),
      height_px_(height_px),
      options_(options),
      view_(solids, eye),
      shadows_(solids, eye, lights),
      mirrors_(solids, eye, options.optics) {}

std::vector<BeamTile> BeamTracer::make_tiles() const {
  BeamTile whole;
  double side = options_.tile_px;
  while (side < std::max(width_px_, height_px_)) side *= 2;
  whole.rect = {0, 0, side, side};
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const CsgExpression& root = solids_[i].shape->root();
    if (!root.is_decided()) whole.parts.push_back({i, root});
  }
  std::vector<BeamTile> level{std::move(whole)};
  for (; side > options_.tile_px; side /= 2) {
    std::vector<BeamTile> next;
    for (const BeamTile& tile : level) {
      for (const Rect& rect : quarters_of(tile.rect)) {
        if (rect.x0 < width_px_ && rect.y0 < height_px_) next.push_back({rect, {}});
      }
    }
    parallel_for(next.size(), {.threads = options_.threads}, [&](std::size_t i) {
      const Rect& r = next[i].rect;
      const auto parent = std::ranges::find_if(level, [&](const BeamTile& t) {
        return t.rect.x0 <= r.x0 && t.rect.x1 >= r.x1 && t.rect.y0 <= r.y0 && t.rect.y1 >= r.y1;
      });
      next[i].parts = prune_parts(view_, parent->parts, r, kInfinity).parts;
    });
    level = std::move(next);
  }
  return level;
}

BeamStats BeamTracer::trace_tile(const BeamTile& tile,
                                 const std::function<void(const BeamPixel&)>& sink) const {
  Tracer tracer(*this, tile.rect, sink);
  tracer.visit(tile.rect, tile.parts, kInfinity);
  return tracer.stats();
}

}  // namespace arris
