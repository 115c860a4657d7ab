#include "beam/corner_tracer.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"
#include "beam/corner_lights.h"
#include "beam/ray_sight.h"

namespace arris {
namespace {

std::array<Vec2d, 4> corners_of(const Rect& r) {
  return {Vec2d{r.x0, r.y0}, Vec2d{r.x1, r.y0}, Vec2d{r.x1, r.y1}, Vec2d{r.x0, r.y1}};
}

// A part of the picture under way.
struct BeamRegion {
  Rect rect;
  std::shared_ptr<const std::vector<BeamPart>> parts;
  bool is_uniform = false;          // for the eye
  std::optional<SeenSurface> seen;  // of a uniform one
  RegionLights lights;              // likewise

  [[nodiscard]] bool is_settled() const { return is_uniform && lights.open.empty(); }
};

}  // namespace

class CornerTracer::Tracer {
 public:
  Tracer(const CornerTracer& shared, const Rect& tile,
         const std::function<void(const BeamPixel&)>& sink)
      : shared_(shared),
        sink_(sink),
        lights_(shared.solids_, shared.lights_, shared.beam_of(tile).edges),
        rule_(shared.solids_) {}

  // Of at least a pixel.
  void visit(const BeamRegion& above, const Rect& rect) {
    if (rect.x0 >= shared_.width_px_ || rect.y0 >= shared_.height_px_) return;
    const BeamRegion region = look(above, rect);
    if (region.is_settled()) {
      for (double y = rect.y0; y < rect.y1; ++y) {
        for (double x = rect.x0; x < rect.x1; ++x) {
          const Rect pixel{x, y, x + 1, y + 1};
          surfaces_.clear();
          add_corners(region, pixel);
          finish_pixel(pixel);
        }
      }
    } else if (rect.width() > 1) {
      for (const Rect& part : quarters_of(rect)) visit(region, part);
    } else {
      surfaces_.clear();
      for (const Rect& part : quarters_of(rect)) visit_part(region, part);
      finish_pixel(rect);
    }
  }

  [[nodiscard]] BeamStats stats() const {
    BeamStats all = stats_;
    all.regions += lights_.beams();
    all.rays += lights_.rays();
    return all;
  }

 private:
  void visit_part(const BeamRegion& above, const Rect& rect) {
    const BeamRegion region = look(above, rect);
    if (region.is_settled() || rect.width() <= shared_.options_.least_region) {
      add_corners(region, rect);
      return;
    }
    for (const Rect& part : quarters_of(rect)) visit_part(region, part);
  }

  // In the parts of a uniform region only its lights are tested again.
  BeamRegion look(const BeamRegion& above, const Rect& rect) {
    BeamRegion region = above;
    region.rect = rect;
    if (!above.is_uniform) {
      ++stats_.regions;
      region.parts = std::make_shared<const std::vector<BeamPart>>(
          parts_near(shared_.solids_, *above.parts, shared_.beam_of(rect)));
      region.is_uniform = is_uniform(*region.parts, rect);
      if (!region.is_uniform) return region;
      if (!region.parts->empty()) region.seen = seen_at(*region.parts, {rect.x0, rect.y0});
    }
    const std::optional<HitPatch> patch = find_patch(region);
    if (!above.is_uniform && patch) region.lights = lights_.start(*patch);
    if (patch) {
      region.lights = lights_.settle(region.lights, *patch);
    } else {
      for (RegionLights::Open& open : region.lights.open) open.reaches.reset();
    }
    return region;
  }

  // Nothing: no surface, or not at all corners, or one of a leaf that is not convex.
  std::optional<HitPatch> find_patch(const BeamRegion& region) {
    if (!region.seen || region.seen->face == kAnyFace) return std::nullopt;
    std::array<Vec3d, 4> points;
    const std::array<Vec2d, 4> corners = corners_of(region.rect);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::optional<RaySight>& sight = see(*region.parts, corners[i]);
      if (!sight || sight->seen != *region.seen) return std::nullopt;
      const Ray ray = ray_through(shared_.eye_, corners[i]);
      points[i] = ray.origin + ray.direction * sight->depth;
    }
    return make_patch(shared_.solids_[region.seen->solid], *region.seen, points,
                      shared_.eye_.position);
  }

  // Corners are common to up to four regions.
  const std::optional<RaySight>& see(const std::vector<BeamPart>& parts, Vec2d at) {
    const auto [known, is_new] = seen_.try_emplace({at.x, at.y});
    if (!is_new) return known->second;
    ++stats_.rays;
    known->second = arris::see(shared_.solids_, parts, ray_through(shared_.eye_, at));
    return known->second;
  }
  std::optional<SeenSurface> seen_at(const std::vector<BeamPart>& parts, Vec2d at) {
    const std::optional<RaySight>& sight = see(parts, at);
    return sight ? std::optional(sight->seen) : std::nullopt;
  }

  bool is_uniform(const std::vector<BeamPart>& parts, const Rect& rect) {
    if (parts.empty()) return true;
    const std::array<Vec2d, 4> corners = corners_of(rect);
    const std::optional<SeenSurface> first = seen_at(parts, corners[0]);
    return std::ranges::all_of(corners, [&](Vec2d at) { return seen_at(parts, at) == first; }) &&
           rule_.are_alike(parts, shared_.beam_of(rect).edges, {});
  }

  void add_corners(const BeamRegion& region, const Rect& rect) {
    const std::array<Vec2d, 4> corners = corners_of(rect);
    for (std::size_t i = 0; i < 4; ++i) {
      PixelSurface surface;
      surface.seen = seen_at(*region.parts, corners[i]);
      surface.estimate = surface.hi = rect.area() / 4;
      surface.lo = region.is_settled() ? surface.hi : 0;
      surface.sample = corners[i];
      if (region.is_uniform && surface.seen && surface.seen == region.seen) {
        add_lights(region.lights, i, surface);
      }
      surfaces_.push_back(surface);
    }
  }

  // Where a light stayed open, each corner has an answer of its own.
  static void add_lights(RegionLights lights, std::size_t corner, PixelSurface& surface) {
    for (const RegionLights::Open& open : lights.open) {
      if (open.reaches) lights.decide(open.light, (*open.reaches)[corner]);
    }
    surface.lit = lights.lit;
    surface.lit_known = lights.known;
  }

  // A corner of several regions is shaded once.
  void merge_corners() {
    const auto key = [](const PixelSurface& s) {
      return std::tuple(s.sample.y, s.sample.x, s.lit_known, s.lit);
    };
    std::ranges::stable_sort(surfaces_, {}, key);
    std::size_t last = 0;
    for (std::size_t i = 1; i < surfaces_.size(); ++i) {
      if (key(surfaces_[i]) != key(surfaces_[last])) {
        surfaces_[++last] = surfaces_[i];
        continue;
      }
      surfaces_[last].lo += surfaces_[i].lo;
      surfaces_[last].hi += surfaces_[i].hi;
      surfaces_[last].estimate += surfaces_[i].estimate;
    }
    surfaces_.resize(last + 1);
  }

  void finish_pixel(const Rect& pixel) {
    if (pixel.x0 >= shared_.width_px_ || pixel.y0 >= shared_.height_px_) return;
    merge_corners();
    BeamPixel out;
    out.x = int(pixel.x0);
    out.y = int(pixel.y0);
    double nothing_lo = 0, nothing_hi = 0;
    for (const PixelSurface& s : surfaces_) {
      if (s.seen) continue;
      nothing_lo += s.lo;
      nothing_hi += s.hi;
    }
    out.coverage_lo = 1 - nothing_hi;
    out.coverage_hi = 1 - nothing_lo;
    out.certified = false;  // the rule proves nothing
    out.surfaces = surfaces_;
    ++stats_.pixels;
    ++stats_.uncertified_pixels;
    sink_(out);
  }

  const CornerTracer& shared_;
  const std::function<void(const BeamPixel&)>& sink_;
  CornerLights lights_;
  UniformRule rule_;
  std::map<std::pair<double, double>, std::optional<RaySight>> seen_;
  std::vector<PixelSurface> surfaces_;
  BeamStats stats_;
};

CornerTracer::CornerTracer(std::span<const BeamSolid> solids, const EyeRays& eye, int width_px,
                           int height_px, const BeamOptions& options,
                           std::span<const LightPlace> lights)
    : solids_(solids),
      eye_(eye),
      width_px_(width_px),
      height_px_(height_px),
      options_(options),
      lights_(lights) {}

Pyramid CornerTracer::beam_of(const Rect& rect) const {
  Pyramid beam;
  const std::array<Vec2d, 4> corners = corners_of(rect);
  for (std::size_t i = 0; i < 4; ++i) beam.edges[i] = ray_through(eye_, corners[i]);
  return beam;
}

std::vector<BeamTile> CornerTracer::make_tiles() const {
  std::vector<BeamTile> tiles;
  const double side = options_.tile_px;
  for (double y = 0; y < height_px_; y += side) {
    for (double x = 0; x < width_px_; x += side) tiles.push_back({{x, y, x + side, y + side}, {}});
  }
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const CsgExpression& root = solids_[i].shape->root();
    if (!root.is_decided()) roots.push_back({i, root});
  }
  parallel_for(tiles.size(), {.threads = options_.threads}, [&](std::size_t i) {
    tiles[i].parts = parts_near(solids_, roots, beam_of(tiles[i].rect));
  });
  return tiles;
}

BeamStats CornerTracer::trace_tile(const BeamTile& tile,
                                   const std::function<void(const BeamPixel&)>& sink) const {
  Tracer tracer(*this, tile.rect, sink);
  const auto parts = std::make_shared<const std::vector<BeamPart>>(tile.parts);
  tracer.visit({tile.rect, parts, false, {}, {}}, tile.rect);
  return tracer.stats();
}

}  // namespace arris
