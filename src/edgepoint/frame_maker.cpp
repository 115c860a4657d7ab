#include "edgepoint/frame_maker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "base/check.h"
#include "base/parallel_for.h"
#include "edgepoint/edge_projection.h"
#include "edgepoint/fresh_samples.h"
#include "edgepoint/hidden_points.h"
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

// Edges that are projected at a time.
constexpr std::size_t kChunkEdges = 2048;

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

using EdgeChunk = std::variant<std::span<const WorldEdge>, std::span<const SoftEdge>>;

template <class Edge>
void add_chunks(std::span<const Edge> list, std::vector<EdgeChunk>& chunks) {
  for (std::size_t at = 0; at < list.size(); at += kChunkEdges) {
    chunks.emplace_back(list.subspan(at, std::min(kChunkEdges, list.size() - at)));
  }
}

}  // namespace

float pixel_size(const PixelView& view) {
  return float(length(inverse(view.pixel_from_world).x));
}

FrameMaker::FrameMaker(int width_px, int height_px)
    : image_(width_px, height_px),
      depth_(width_px, height_px),
      wanted_(image_.codes.size(), 255),
      bands_(make_bands(height_px)),
      holes_(width_px, height_px) {}

void FrameMaker::forget() {
  std::fill(wanted_.begin(), wanted_.end(), std::uint8_t{255});
  std::fill(image_.points.begin(), image_.points.end(), PointKey());
}

void FrameMaker::find_points(const PixelView& view, const PointCache& cache,
                             const ParallelOptions& parallel) {
  static_assert(kBandRows % DepthCells::kSide == 0, "bands are of whole cells");
  const std::vector<RowBand> block_rows = find_block_rows(view, cache, parallel.threads);
  std::vector<std::vector<std::uint32_t>> seen(bands_.size());
  parallel_for(bands_.size(), parallel, [&](std::size_t i) {
    const RowBand band = bands_[i];
    seen[i].resize(block_rows.size() + 1);
    project_points(view, cache, block_rows, band, image_.points, seen[i]);
    // While the band's points are in the processor's cache.
    const int last = (band.last + DepthCells::kSide - 1) / DepthCells::kSide;
    for (int row = band.first / DepthCells::kSide; row < last; ++row) {
      depth_.fill_cells(image_.points, row);
    }
  });
  seen_.assign(block_rows.size(), 0);
  for (const std::vector<std::uint32_t>& of_band : seen) {
    for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i] += of_band[i];
  }
  const float size = pixel_size(view);
  parallel_for(std::size_t(depth_.limit_rows()),
               {.grain = 16, .threads = parallel.threads, .stop = parallel.stop},
               [&](std::size_t i) { depth_.fill_limits(int(i), size); });
}

// Chunks of edges are projected and handed to the bands that they cross; those that are not in the picture to none.
void FrameMaker::rasterize(const PixelView& view, const FrameEdges& edges,
                           const ParallelOptions& parallel) {
  std::vector<EdgeChunk> chunks;
  for (const std::span<const WorldEdge> list : edges.surfaces) add_chunks(list, chunks);
  add_chunks(edges.shadows, chunks);
  const std::size_t bands = bands_.size();
  if (screen_edges_.size() < chunks.size() * bands) screen_edges_.resize(chunks.size() * bands);
  parallel_for(chunks.size(), parallel, [&](std::size_t c) {
    const std::span of_bands = std::span(screen_edges_).subspan(c * bands, bands);
    for (std::vector<ScreenEdge>& list : of_bands) list.clear();
    const auto hand_out = [&](const ScreenEdge& edge) {
      const auto [upper, lower] = std::minmax(edge.y0, edge.y1);
      // Each band has the line between it and the next.
      const int first = std::max(int(std::floor(upper)) - 1, 0) / kBandRows;
      const int last = std::min(int(std::floor(lower)) + 1, image_.height_px - 1) / kBandRows;
      for (int b = first; b <= last; ++b) of_bands[std::size_t(b)].push_back(edge);
    };
    std::vector<ScreenEdge> seen;
    std::visit([&](const auto& chunk) { project_seen(view, chunk, depth_, seen); }, chunks[c]);
    std::ranges::for_each(seen, hand_out);
  });
  parallel_for(bands, parallel, [&](std::size_t b) {
    clear_crossings(bands_[b], image_.height_px, image_.crossings);
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      rasterize_edges(screen_edges_[c * bands + b], depth_, bands_[b], image_.width_px,
                      image_.height_px, image_.crossings);
    }
  });
}

FrameReport FrameMaker::make(const PixelView& view, const FrameEdges& edges, PointCache& cache,
                             const FrameSettings& settings, Image& picture) {
  ARRIS_CHECK(view.width_px == image_.width_px && view.height_px == image_.height_px,
              double(view.width_px), double(view.height_px));
  FrameReport report;
  const ParallelOptions parallel{.grain = 1, .threads = settings.threads, .stop = settings.stop};
  Stopwatch watch;
  find_points(view, cache, parallel);
  report.times.points = watch.lap();
  rasterize(view, edges, parallel);
  report.times.raster = watch.lap();

  std::vector<PixelClasses> classes(bands_.size());
  parallel_for(bands_.size(), parallel,
               [&](std::size_t i) { classes[i] = classify_pixels(bands_[i], image_); });
  for (const PixelClasses& c : classes) report.classes += c;
  report.times.classify = watch.lap();
  parallel_for(bands_.size(), parallel,
               [&](std::size_t i) { find_reach(image_.corners, bands_[i], image_.reach); });
  report.times.reachability = watch.lap();

  PointObjects objects;
  if (!settings.edges_are_missing) objects = cache.objects();
  std::vector<std::vector<std::uint32_t>> hidden(bands_.size());
  parallel_for(bands_.size(), parallel, [&](std::size_t i) {
    hidden[i] = find_hidden_points(image_, objects, depth_, bands_[i], pixel_size(view));
  });
  for (const std::vector<std::uint32_t>& pixels : hidden) {
    for (const std::uint32_t pixel : pixels) --seen_[image_.points[pixel].point() / kPointBlock];
    remove_points(pixels, image_);
    report.hidden += pixels.size();
  }
  report.times.points += watch.lap();

  image_.some_are_stale = settings.points_may_be_stale;
  if (image_.some_are_stale) {
    parallel_for(bands_.size(), parallel,
                 [&](std::size_t i) { find_fresh_samples(cache, bands_[i], image_); });
    report.times.points += watch.lap();
  }

  std::vector<BandReport> reports(bands_.size());
  const TintImage* const tints = settings.find_tints ? settings.find_tints(image_) : nullptr;
  report.times.textures = watch.lap();
  const ReconstructionSettings reconstruction{settings.complex_filter, settings.frame, tints};
  parallel_for(bands_.size(), parallel, [&](std::size_t i) {
    reports[i] = reconstruct_band(image_, cache, reconstruction, bands_[i], picture, wanted_);
  });
  std::vector<std::uint32_t> unresolved;
  ReconstructionTimes spent;
  for (const BandReport& band : reports) {
    std::copy(band.unresolved.begin(), band.unresolved.end(), std::back_inserter(unresolved));
    spent += band.times;
  }
  cache.set_seen(seen_);
  report.unresolved = unresolved.size();
  holes_.fill(image_, unresolved, parallel, picture);
  const double took = watch.lap();
  const double part = spent.total() > 0 ? took / spent.total() : 0;
  report.times.interpolation = part * spent.interpolation;
  report.times.antialias = part * spent.antialias;
  report.times.complex = part * spent.complex;
  return report;
}

}  // namespace arris
