// beam_tracer.h — which surfaces each pixel of a picture shows, and how much of each
// What       The picture is split in four until a region's beam sees a tree of few signs (region_look.h); the tree's
//            ends are measured in each pixel (tree_area.h) and added up (pixel_surfaces.h). Regions hand the leaves
//            that their beams may meet, and the depth beyond which nothing is seen, to their parts. What is still
//            unknown in the smallest regions is sampled by rays and left open between its bounds
//            (unresolved_regions.h).
// Guarantee  the area of every surface in every pixel lies within its [lo, hi]; a surface that is not listed is not
//            there. Both but for rounding in the sums of areas (tests/beam/beam_tracer_test.cpp: dense sampling)
// Limits     the outlines of leaves that are not convex (see convex_solid.h for those that can be cut) stay open
// Cost       parallel over tiles; the same pixels at any number of threads
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996: regions,
//            beams and lists handed down; where corners decide there, bounds decide here (docs/beam.md)
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "beam/beam_mirror.h"
#include "beam/beam_shadow.h"
#include "beam/beam_view.h"
#include "beam/pixel_surfaces.h"
#include "beam/region_look.h"

namespace arris {

struct BeamPixel {
  int x = 0, y = 0;
  std::span<const PixelSurface> surfaces;
  double coverage_lo = 0, coverage_hi = 1;  // of all surfaces together
  double region_side =
      1;  // of the smallest region that it was cut into, or of the one that it is part of
  bool begins_region = true;  // it is at the left or upper border of its region
  bool certified =
      true;  // no surface's bounds are wider than the tolerance, no mirror or light open
};

struct BeamStats {
  std::uint64_t regions = 0;  // beams that were looked at
  std::uint64_t rays = 0;     // that sampled what stayed unknown
  std::uint64_t pixels = 0, uncertified_pixels = 0;
  double certified_area = 0;  // in pixels

  void add(const BeamStats& other);
};

struct BeamOptions {
  double tolerance = 1.0 / 512;            // of hi - lo
  double least_region = 1.0 / 64;          // of a pixel's side
  double least_crowded_region = 1.0 / 16;  // in a pixel that has taken
  std::uint32_t many_rays = 256;           // so many rays already: one edge takes fewer
  std::uint32_t many_looks = 1024;  // or so many looks; after four times as many, least_open_region
  double least_shadow_region = 1.0 / 8;  // where lights are not looked at jointly
  double least_open_region = 1.0 / 8;  // where a leaf that is not convex is among what may be seen
  int tile_px = 16;                    // a power of two
  int threads = 0;                     // 0: all
  const std::atomic<bool>* stop = nullptr;  // set: pixels may be left out
  OpticsOf optics = {};                     // none: no mirrors are looked into
};

struct BeamTile {
  Rect rect;
  std::vector<BeamPart> parts;
};

class BeamTracer {
 public:
  // `solids` and `lights` must outlive the tracer.
  // The lights whose shadows are looked for.
  BeamTracer(std::span<const BeamSolid> solids, const EyeRays& eye, int width_px, int height_px,
             const BeamOptions& options = {}, std::span<const LightPlace> lights = {});

  // Together they are the picture.
  [[nodiscard]] std::vector<BeamTile> make_tiles() const;
  // Calls sink for every pixel of the tile.
  BeamStats trace_tile(const BeamTile& tile,
                       const std::function<void(const BeamPixel&)>& sink) const;

  [[nodiscard]] const BeamView& view() const { return view_; }
  [[nodiscard]] const EyeRays& eye() const { return eye_; }

 private:
  class Tracer;

  std::span<const BeamSolid> solids_;
  EyeRays eye_;
  int width_px_, height_px_;
  BeamOptions options_;
  BeamView view_;
  ShadowLooker shadows_;
  MirrorLooker mirrors_;
};

}  // namespace arris
