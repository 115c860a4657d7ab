#include "beam/beam_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel_for.h"
#include "beam/lit_regions.h"
#include "beam/unresolved_regions.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How often a pixel's outlines are followed again, each time four times as closely.
constexpr int kCloserLooks = 4;
// As long as that leaves at most this part of what was open.
constexpr double kGain = 0.7;

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
      : shared_(shared),
        sink_(sink),
        lists_(tile),
        mirror_lists_(tile),
        surfaces_(mirror_lists_, shared.shadows_.is_joint() ? 0 : shared.shadows_.light_count()),
        unresolved_(shared.solids_, shared.eye_, shared.view_, surfaces_) {}
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

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

  [[nodiscard]] BeamStats stats() const {
    BeamStats stats = stats_;
    stats.rays = unresolved_.ray_count();
    return stats;
  }

 private:
  [[nodiscard]] bool is_stopped() const {
    return shared_.options_.stop != nullptr && shared_.options_.stop->load();
  }
  void visit_parts_of(const Rect& pixel, const std::vector<BeamPart>& parts, double depth_end) {
    clear_pixel();
    smallest_part_ = 1;
    rays_before_pixel_ = unresolved_.ray_count();
    looks_before_pixel_ = stats_.regions;
    for (const Rect& part : quarters_of(pixel)) visit_part(part, parts, depth_end);
    unresolved_.add_forced_samples(parts);
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
    const std::uint64_t looks = stats_.regions - looks_before_pixel_;
    const std::uint64_t rays = unresolved_.ray_count() - rays_before_pixel_;
    if (rays > options.many_rays || looks > options.many_looks) {
      least = std::max(least, options.least_crowded_region);
    }
    if (looks > 4 * options.many_looks) least = std::max(least, options.least_open_region);
    return least;
  }

  // Shadows, and what is seen in mirrors.
  bool add_light(LookTree& tree, const Rect& rect) {
    const bool shadows = shared_.shadows_.add_shadows(
        tree, rect, lists_, stats_.regions, [&](const LookNode& node) { return is_unlit(node); });
    const bool mirrored = shared_.mirrors_.add_mirrors(tree, rect, mirror_lists_, stats_.regions);
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
      const double open = surfaces_.open_area();
      if (tree.hopeless || is_certified() || open > kGain * before) break;
      before = open;
      options.tolerance /= 4;
      options.least_side /= 4;
    }
    if (tree.refines && !is_certified()) {
      visit_parts_of(pixel, parts, depth_end);
      return;
    }
    unresolved_.add_forced_samples(parts);
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
  [[nodiscard]] bool is_certified() const {
    return surfaces_.is_certified(shared_.options_.tolerance);
  }

  void add_ends(const LookTree& tree, const std::vector<EndArea>& ends, const Rect& rect,
                const std::vector<BeamPart>& parts) {
    for (const EndArea& end : ends) {
      const LookNode& node = tree.nodes[end.node];
      if (node.kind == LookNode::Kind::unknown) {
        unresolved_.add(tree, end, rect, parts);
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
      surfaces_.add(surface);
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
      PixelSurface& entry = surfaces_.entry_of(surface);
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

  void finish_pixel(const Rect& pixel, const Rect& region) {
    BeamPixel out;
    out.x = int(pixel.x0);
    out.y = int(pixel.y0);
    double nothing_lo = 0, nothing_hi = 0, certain = 0;
    surfaces_.clamp_bounds();
    for (const PixelSurface& s : surfaces_.entries()) {
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
    out.surfaces = surfaces_.entries();
    ++stats_.pixels;
    stats_.uncertified_pixels += out.certified ? 0 : 1;
    stats_.certified_area += std::min(certain, 1.0);
    sink_(out);
  }

  const BeamTracer& shared_;
  const std::function<void(const BeamPixel&)>& sink_;
  ShadowLists lists_;
  MirrorLists mirror_lists_;
  LitRegions lit_regions_;  // of the region under way
  double smallest_part_ = 1;
  std::uint64_t rays_before_pixel_ = 0;   // of unresolved_
  std::uint64_t looks_before_pixel_ = 0;  // of stats_.regions
  PixelSurfaces surfaces_;                // of the pixel
  UnresolvedRegions unresolved_;
  BeamStats stats_;  // without rays
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
