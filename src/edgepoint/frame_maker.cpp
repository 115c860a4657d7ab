#include "edgepoint/frame_maker.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "base/parallel_for.h"
#include "edgepoint/hidden_points.h"
#include "edgepoint/hole_filler.h"
#include "edgepoint/point_raster.h"
#include "edgepoint/reach_planes.h"
#include "edgepoint/reconstruct.h"

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

// Enough for any number of cores to share them evenly, and few enough that their borders cost little.
constexpr int kBandRows = 64;

std::vector<RowBand> make_bands(int height) {
  std::vector<RowBand> bands;
  for (int y = 0; y < height; y += kBandRows) bands.push_back({y, std::min(y + kBandRows, height)});
  return bands;
}

class Stopwatch {
 public:
  // Milliseconds since the last call.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

}  // namespace

float pixel_size(const PixelView& view) {
  return float(length(inverse(view.pixel_from_world).x));
}

FrameMaker::FrameMaker(int width_px, int height_px)
    : image_(width_px, height_px),
      depth_(width_px, height_px),
      wanted_(image_.codes.size(), 255),
      bands_(make_bands(height_px)) {}

void FrameMaker::forget() {
  std::fill(wanted_.begin(), wanted_.end(), std::uint8_t{255});
  std::fill(image_.points.begin(), image_.points.end(), PointKey());
}

void FrameMaker::find_depth(const PixelView& view, int threads) {
  parallel_for(std::size_t(depth_.cell_rows()), {.grain = 8, .threads = threads},
               [&](std::size_t i) { depth_.fill_cells(image_.points, int(i)); });
  const float size = pixel_size(view);
  parallel_for(std::size_t(depth_.limit_rows()), {.grain = 16, .threads = threads},
               [&](std::size_t i) { depth_.fill_limits(int(i), size); });
}

void FrameMaker::rasterize(const PixelView& view, std::span<const WorldEdge> edges, int threads) {
  screen_edges_.resize(edges.size());
  parallel_for(edges.size(), {.grain = 1024, .threads = threads},
               [&](std::size_t i) { screen_edges_[i] = project_edge(view, edges[i]); });
  std::erase_if(screen_edges_, [](const ScreenEdge& e) { return e.x0 == e.x1 && e.y0 == e.y1; });
  parallel_for(bands_.size(), {.grain = 1, .threads = threads}, [&](std::size_t i) {
    rasterize_edges(screen_edges_, depth_, bands_[i], image_.width_px, image_.height_px,
                    image_.crossings);
  });
}

FrameReport FrameMaker::make(const PixelView& view, std::span<const WorldEdge> edges,
                             PointCache& cache, const FrameSettings& settings, Image& picture) {
  ARRIS_CHECK(view.width_px == image_.width_px && view.height_px == image_.height_px,
              double(view.width_px), double(view.height_px));
  FrameReport report;
  const ParallelOptions parallel{.grain = 1, .threads = settings.threads};
  Stopwatch watch;
  parallel_for(bands_.size(), parallel,
               [&](std::size_t i) { project_points(view, cache, bands_[i], image_.points); });
  find_depth(view, settings.threads);
  report.times.points = watch.lap();
  rasterize(view, edges, settings.threads);
  report.times.raster = watch.lap();

  std::vector<PixelClasses> classes(bands_.size());
  parallel_for(bands_.size(), parallel,
               [&](std::size_t i) { classes[i] = classify_pixels(bands_[i], image_); });
  for (const PixelClasses& c : classes) report.classes += c;
  parallel_for(bands_.size(), parallel,
               [&](std::size_t i) { find_reach(image_.corners, bands_[i], image_.reach); });
  report.times.reachability = watch.lap();

  std::vector<std::vector<std::uint32_t>> hidden(bands_.size());
  parallel_for(bands_.size(), parallel, [&](std::size_t i) {
    hidden[i] = find_hidden_points(image_, depth_, bands_[i], pixel_size(view));
  });
  for (const std::vector<std::uint32_t>& pixels : hidden) {
    remove_points(pixels, image_);
    report.hidden += pixels.size();
  }
  report.times.points += watch.lap();

  std::vector<BandReport> reports(bands_.size());
  const TintImage* const tints = settings.find_tints ? settings.find_tints(image_) : nullptr;
  report.times.textures = watch.lap();
  const ReconstructionSettings reconstruction{settings.complex_filter, settings.frame, tints};
  parallel_for(bands_.size(), parallel, [&](std::size_t i) {
    reports[i] = reconstruct_band(image_, cache, reconstruction, bands_[i], picture, wanted_);
  });
  std::vector<std::uint32_t> unresolved, seen(cache.blocks().size());
  ReconstructionTimes spent;
  for (const BandReport& band : reports) {
    std::copy(band.unresolved.begin(), band.unresolved.end(), std::back_inserter(unresolved));
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += band.seen[i];
    spent += band.times;
  }
  cache.set_seen(seen);
  report.unresolved = unresolved.size();
  fill_holes(image_, std::move(unresolved), picture);
  const double took = watch.lap();
  const double part = spent.total() > 0 ? took / spent.total() : 0;
  report.times.interpolation = part * spent.interpolation;
  report.times.antialias = part * spent.antialias;
  report.times.complex = part * spent.complex;
  return report;
}

}  // namespace arris
