#include "beam/corner_tracer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/parallel_for.h"
#include "beam/ray_sight.h"
#include "beam/separation.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<Vec2d, 4> corners_of(const Rect& r) {
  return {Vec2d{r.x0, r.y0}, Vec2d{r.x1, r.y0}, Vec2d{r.x1, r.y1}, Vec2d{r.x0, r.y1}};
}
std::array<Rect, 4> quarters_of(const Rect& r) {
  const double x = r.middle_x(), y = r.middle_y();
  return {Rect{r.x0, r.y0, x, y}, Rect{x, r.y0, r.x1, y}, Rect{r.x0, y, x, r.y1},
          Rect{x, y, r.x1, r.y1}};
}

// A crossing of a ray with a primitive, whatever the operations make of it.
struct BareCrossing {
  double t;
  std::uint32_t solid, leaf, face;
};

}  // namespace

class CornerTracer::Tracer {
 public:
  Tracer(const CornerTracer& shared, const std::function<void(const BeamPixel&)>& sink)
      : shared_(shared), sink_(sink) {}

  // Of at least a pixel.
  void visit(const Rect& rect, const std::vector<BeamPart>& above) {
    if (rect.x0 >= shared_.width_px_ || rect.y0 >= shared_.height_px_) return;
    const std::vector<BeamPart> parts = shared_.parts_in(above, rect);
    ++stats_.regions;
    if (is_uniform(parts, rect)) {
      for (double y = rect.y0; y < rect.y1; ++y) {
        for (double x = rect.x0; x < rect.x1; ++x) {
          const Rect pixel{x, y, x + 1, y + 1};
          surfaces_.clear();
          add_corners(parts, pixel, true);
          finish_pixel(pixel);
        }
      }
    } else if (rect.width() > 1) {
      for (const Rect& part : quarters_of(rect)) visit(part, parts);
    } else {
      surfaces_.clear();
      for (const Rect& part : quarters_of(rect)) visit_part(part, parts);
      finish_pixel(rect);
    }
  }

  [[nodiscard]] const BeamStats& stats() const { return stats_; }

 private:
  void visit_part(const Rect& rect, const std::vector<BeamPart>& above) {
    const std::vector<BeamPart> parts = shared_.parts_in(above, rect);
    ++stats_.regions;
    const bool uniform = is_uniform(parts, rect);
    if (uniform || rect.width() <= shared_.options_.least_region) {
      add_corners(parts, rect, uniform);
      return;
    }
    for (const Rect& part : quarters_of(rect)) visit_part(part, parts);
  }

  [[nodiscard]] Ray ray_at(std::uint32_t solid, Vec2d at) const {
    const Affine3d& m = shared_.solids_[solid].object_from_world;
    const Ray world = ray_through(shared_.eye_, at);
    return {transform_point(m, world.origin), transform_vector(m, world.direction)};
  }

  // Corners are common to up to four regions.
  const std::optional<SeenSurface>& see(const std::vector<BeamPart>& parts, Vec2d at) {
    const auto [known, is_new] = seen_.try_emplace({at.x, at.y});
    if (!is_new) return known->second;
    ++stats_.rays;
    const std::optional<RaySight> sight =
        arris::see(shared_.solids_, parts, ray_through(shared_.eye_, at));
    if (sight) known->second = sight->seen;
    return known->second;
  }

  // What the ray meets of all primitives of the list, in order.
  std::vector<BareCrossing> cross_all(const std::vector<BeamPart>& parts, Vec2d at) {
    std::vector<BareCrossing> all;
    for (const BeamPart& part : parts) {
      const BeamShape& shape = *shared_.solids_[part.solid].shape;
      const Ray ray = ray_at(part.solid, at);
      for (const std::uint32_t leaf : part.expression.leaves()) {
        if (const Facet* facet = shape.facet(leaf)) {
          if (const auto t = shape.meet(*facet, ray)) all.push_back({*t, part.solid, leaf, 0});
          continue;
        }
        if (shape.volume(leaf) != nullptr) continue;
        for (const Crossing& c :
             crossings_.find(shape.csg().leaf(leaf), shape.csg().surfaces(), ray)) {
          if (c.t > 0 && c.t < kInfinity) all.push_back({c.t, part.solid, leaf, c.face});
        }
      }
    }
    std::ranges::stable_sort(all, {}, &BareCrossing::t);
    return all;
  }

  static bool same(const BareCrossing& a, const BareCrossing& b) {
    return a.solid == b.solid && a.leaf == b.leaf && a.face == b.face;
  }

  bool is_uniform(const std::vector<BeamPart>& parts, const Rect& rect) {
    if (parts.empty()) return true;
    const std::array<Vec2d, 4> corners = corners_of(rect);
    const std::optional<SeenSurface> first = see(parts, corners[0]);
    for (const Vec2d& at : corners) {
      if (see(parts, at) != first) return false;
    }
    const std::vector<BareCrossing> bare = cross_all(parts, corners[0]);
    for (const Vec2d& at : corners) {
      if (!std::ranges::equal(cross_all(parts, at), bare, same)) return false;
    }
    for (const BeamPart& part : parts) {
      for (const std::uint32_t leaf : part.expression.leaves()) {
        if (shared_.solids_[part.solid].shape->volume(leaf) != nullptr) continue;
        if (std::ranges::none_of(bare, [&](const BareCrossing& c) {
              return c.solid == part.solid && c.leaf == leaf;
            })) {
          return false;
        }
      }
    }
    return true;
  }

  void add_corners(const std::vector<BeamPart>& parts, const Rect& rect, bool uniform) {
    for (const Vec2d& at : corners_of(rect)) {
      PixelSurface surface;
      surface.seen = see(parts, at);
      surface.estimate = surface.hi = rect.area() / 4;
      surface.lo = uniform ? surface.hi : 0;
      surface.sample = at;
      surfaces_.push_back(surface);
    }
  }

  void finish_pixel(const Rect& pixel) {
    if (pixel.x0 >= shared_.width_px_ || pixel.y0 >= shared_.height_px_) return;
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
  std::map<std::pair<double, double>, std::optional<SeenSurface>> seen_;
  std::vector<PixelSurface> surfaces_;
  LeafCrossings crossings_;
  BeamStats stats_;
};

CornerTracer::CornerTracer(std::span<const BeamSolid> solids, const EyeRays& eye, int width_px,
                           int height_px, const BeamOptions& options)
    : solids_(solids), eye_(eye), width_px_(width_px), height_px_(height_px), options_(options) {}

std::vector<BeamPart> CornerTracer::parts_in(const std::vector<BeamPart>& parts,
                                             const Rect& rect) const {
  std::vector<BeamPart> kept;
  for (const BeamPart& part : parts) {
    const Affine3d& m = solids_[part.solid].object_from_world;
    Pyramid beam;
    beam.apex = transform_point(m, eye_.position);
    const std::array<Vec2d, 4> corners = corners_of(rect);
    for (std::size_t i = 0; i < 4; ++i) {
      beam.edges[i] = transform_vector(
          m, eye_.corner + eye_.step_x * corners[i].x + eye_.step_y * corners[i].y);
    }
    std::vector<Cover> covers;
    for (const std::uint32_t leaf : part.expression.leaves()) {
      covers.push_back(is_separated(beam, *solids_[part.solid].shape, leaf) ? Cover::out
                                                                            : Cover::on);
    }
    BeamPart pruned{part.solid, part.expression.prune(covers)};
    if (!pruned.expression.is_decided()) kept.push_back(std::move(pruned));
  }
  return kept;
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
  parallel_for(tiles.size(), {.threads = options_.threads},
               [&](std::size_t i) { tiles[i].parts = parts_in(roots, tiles[i].rect); });
  return tiles;
}

BeamStats CornerTracer::trace_tile(const BeamTile& tile,
                                   const std::function<void(const BeamPixel&)>& sink) const {
  Tracer tracer(*this, sink);
  tracer.visit(tile.rect, tile.parts);
  return tracer.stats();
}

}  // namespace arris
