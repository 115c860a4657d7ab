// frame_maker.h — one frame of the edge-and-point renderer, from edges and points to a picture
// What       projects points, culls and rasterises edges, classifies pixels, finds reachability, reconstructs. What
//            the frames of one size share is kept.
// Guarantee  the same picture at any number of threads
// Cost       every stage runs in bands of rows on all cores
// Source     Bala, Walter, Greenberg (2003), Fig. 2, §4, §5
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "arris/image.h"
#include "base/parallel_for.h"
#include "edgepoint/classify.h"
#include "edgepoint/depth_cells.h"
#include "edgepoint/edge_point_image.h"
#include "edgepoint/edge_raster.h"
#include "edgepoint/hole_filler.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"
#include "edgepoint/tint_image.h"

namespace arris {

// Milliseconds. Interpolation, antialiasing and complex pixels go on in one pass: its time is shared out by what each
// has taken of all threads'.
struct FrameTimes {
  double points = 0, raster = 0, classify = 0, reachability = 0, textures = 0, interpolation = 0,
         antialias = 0, complex = 0;
};

struct FrameReport {
  FrameTimes times;
  PixelClasses classes;
  std::size_t hidden = 0;      // points behind others that were left out
  std::size_t unresolved = 0;  // pixels that no sample reaches: filled from around
};

struct FrameSettings {
  std::uint32_t frame = 0;
  bool complex_filter = true;
  int threads = 0;  // 0: all
  // Asked once edges and points are known; empty, or null: nothing is tinted.
  std::function<const TintImage*(const EdgePointImage&)> find_tints;
  // What no edge parts may still be two objects: points are hidden by those of their own object only.
  bool edges_are_missing = false;
  // Something has changed not long ago: of points within reach those that are not stale count (fresh_samples.h).
  bool points_may_be_stale = false;
  const std::atomic<bool>* stop = nullptr;  // set: Error{failed}, and no picture
};

struct FrameEdges {
  std::span<const std::span<const WorldEdge>> surfaces;
  std::span<const SoftEdge> shadows;
};

class FrameMaker {
 public:
  FrameMaker(int width_px, int height_px);

  // The view's size must be the maker's. Tells the cache what was seen of it.
  FrameReport make(const PixelView& view, const FrameEdges& edges, PointCache& cache,
                   const FrameSettings& settings, Image& picture);

  // As if no frame had been made: every pixel wants a point, and none is seen.
  void forget();
  [[nodiscard]] const EdgePointImage& image() const { return image_; }
  // How much each pixel wants a new sample (reconstruct.h).
  [[nodiscard]] std::span<const std::uint8_t> wanted() const { return wanted_; }

 private:
  void find_points(const PixelView& view, const PointCache& cache, const ParallelOptions& parallel);
  void rasterize(const PixelView& view, const FrameEdges& edges, const ParallelOptions& parallel);

  EdgePointImage image_;
  DepthCells depth_;
  std::vector<std::vector<ScreenEdge>> screen_edges_;  // by chunk and band
  std::vector<std::uint8_t> wanted_;
  std::vector<std::uint32_t> seen_;  // of the points of each block
  std::vector<RowBand> bands_;
  HoleFiller holes_;
};

// Length in the world of a pixel's side at depth 1.
float pixel_size(const PixelView& view);

}  // namespace arris
